module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric global_cpu_ms_metric() {
    return {"global_cpu_ms",
            "ms",
            "processor time of global search a frame after frame 0",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                if (!r.update_cpu_ms || r.frames == 1) return std::nullopt;
                return (*r.update_cpu_ms + *r.search_cpu_ms) / frames_after_first(r);
            }};
}

}  // namespace aabblab
