module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric frame_cpu_ms_metric() {
    return {"frame_cpu_ms",
            "ms",
            "processor time a frame after frame 0, all of it; of frame 0 where there is no other",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                if (!r.update_cpu_ms || r.frames == 1) return r.first_cpu_ms;
                return (*r.update_cpu_ms + *r.search_cpu_ms + *r.detect_cpu_ms) / frames_after_first(r);
            }};
}

}  // namespace aabblab
