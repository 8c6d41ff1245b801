module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric build_ms_metric() {
    return {"build_ms",         "ms",         "time to make the stages and build the trees",
            metric_group::time, better::less, [](const row& r) -> std::optional<double> {
        return r.build_ms; }};
}

}  // namespace aabblab
