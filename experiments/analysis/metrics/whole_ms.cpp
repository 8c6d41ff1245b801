module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric whole_ms_metric() {
    return {"whole_ms",
            "ms",
            "time of all frames, frame 0 and the making of the stages with them",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                if (!r.update_ms) return std::nullopt;
                return *r.build_ms + *r.first_ms + *r.update_ms + *r.search_ms + *r.detect_ms;
            }};
}

}  // namespace aabblab
