module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric missing_metric() {
    return {"missing",
            "",
            "pairs of the exact answer that are not found, over all frames",
            metric_group::error,
            better::less,
            [](const row& r) -> std::optional<double> {
                return r.missing ? std::optional(static_cast<double>(*r.missing)) : std::nullopt;
            }};
}

}  // namespace aabblab
