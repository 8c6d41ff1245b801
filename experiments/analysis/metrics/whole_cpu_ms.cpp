module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric whole_cpu_ms_metric() {
    return {"whole_cpu_ms",
            "ms",
            "processor time of all frames, frame 0 and the making of the stages with them",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                if (!r.update_cpu_ms) return std::nullopt;
                return *r.build_cpu_ms + *r.first_cpu_ms + *r.update_cpu_ms + *r.search_cpu_ms + *r.detect_cpu_ms;
            }};
}

}  // namespace aabblab
