module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric first_ms_metric() {
    return {"first_ms",         "ms",         "time of frame 0",
            metric_group::time, better::less, [](const row& r) -> std::optional<double> {
        return r.first_ms; }};
}

}  // namespace aabblab
