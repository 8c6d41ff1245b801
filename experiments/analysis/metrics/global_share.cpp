module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric global_share_metric() {
    return {"global_share",
            "%",
            "share of global search in the time of the frames after frame 0",
            metric_group::time,
            better::neither,
            [](const row& r) -> std::optional<double> {
                const double global = r.update_ms.value_or(0) + r.search_ms.value_or(0);
                return r.detect_ms && r.frames > 1 ? std::optional(100 * global / (global + *r.detect_ms))
                                                   : std::nullopt;
            }};
}

}  // namespace aabblab
