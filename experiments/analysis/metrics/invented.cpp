module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric invented_metric() {
    return {"invented",
            "",
            "pairs that are found and not in the exact answer, over all frames",
            metric_group::error,
            better::less,
            [](const row& r) -> std::optional<double> {
                return r.invented ? std::optional(static_cast<double>(*r.invented)) : std::nullopt;
            }};
}

}  // namespace aabblab
