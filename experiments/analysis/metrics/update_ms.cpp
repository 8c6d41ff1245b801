module;
#include <functional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric update_ms_metric() {
    return {"update_ms",        "ms",         "time a frame to take the boxes: to sort and to partition them",
            metric_group::time, better::less, a_frame(&row::update_ms)};
}

}  // namespace aabblab
