module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric global_share_metric() {
    return {"global_share",
            "%",
            "share of global search in the processor time of the frames after frame 0",
            metric_group::time,
            better::neither,
            [](const row& r) -> std::optional<double> {
                if (!r.update_cpu_ms || !r.detect_cpu_ms || r.frames == 1) return std::nullopt;
                const double global = *r.update_cpu_ms + *r.search_cpu_ms;
                return 100 * global / (global + *r.detect_cpu_ms);
            }};
}

}  // namespace aabblab
