module;
#include <functional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric update_cpu_ms_metric() {
    return {"update_cpu_ms",    "ms",         "processor time a frame to take the boxes: to sort and to partition them",
            metric_group::time, better::less, a_frame(&row::update_cpu_ms)};
}

}  // namespace aabblab
