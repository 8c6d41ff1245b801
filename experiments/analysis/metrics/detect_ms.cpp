module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric detect_ms_metric() {
    return {"detect_ms",
            "ms",
            "time a frame to find intersecting triangles",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                return r.detect_ms && r.frames > 1 ? std::optional(*r.detect_ms / frames_after_first(r)) : std::nullopt;
            }};
}

}  // namespace aabblab
