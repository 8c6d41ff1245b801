module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric update_ms_metric() {
    return {"update_ms",
            "ms",
            "time a frame to take the boxes: to sort and to partition them",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                return r.update_ms && r.frames > 1 ? std::optional(*r.update_ms / frames_after_first(r)) : std::nullopt;
            }};
}

}  // namespace aabblab
