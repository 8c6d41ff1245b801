module;
#include <functional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric detect_cpu_ms_metric() {
    return {"detect_cpu_ms",    "ms",         "processor time a frame to find intersecting triangles",
            metric_group::time, better::less, a_frame(&row::detect_cpu_ms)};
}

}  // namespace aabblab
