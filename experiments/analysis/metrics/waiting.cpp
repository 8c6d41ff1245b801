module;
#include <algorithm>
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric waiting_metric() {
    return {"waiting",
            "%",
            "share of the wall time of all frames in which the thread had no processor",
            metric_group::time,
            better::less,
            [](const row& r) -> std::optional<double> {
                if (!r.update_cpu_ms || !r.update_ms) return std::nullopt;
                const double wall = *r.first_ms + *r.update_ms + *r.search_ms + *r.detect_ms;
                const double cpu = *r.first_cpu_ms + *r.update_cpu_ms + *r.search_cpu_ms + *r.detect_cpu_ms;
                return wall > 0 ? std::optional(100 * std::max(0.0, 1 - cpu / wall)) : std::nullopt;
            }};
}

}  // namespace aabblab
