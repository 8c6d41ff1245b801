module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric search_ms_metric() {
    return {"search_ms",
            "ms",
            "time a frame to find overlapping boxes",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                return r.search_ms && r.frames > 1 ? std::optional(*r.search_ms / frames_after_first(r)) : std::nullopt;
            }};
}

}  // namespace aabblab
