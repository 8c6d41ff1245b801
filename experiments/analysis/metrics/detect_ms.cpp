module;
#include <functional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric detect_ms_metric() {
    return {"detect_ms",        "ms",         "time a frame to find intersecting triangles",
            metric_group::time, better::less, a_frame(&row::detect_ms)};
}

}  // namespace aabblab
