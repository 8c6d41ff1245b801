module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric build_cpu_ms_metric() {
    return {"build_cpu_ms",     "ms",         "processor time to make the stages and build the trees",
            metric_group::time, better::less, [](const row& r) -> std::optional<double> {
                return r.build_cpu_ms; }};
}

}  // namespace aabblab
