module;
#include <functional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric search_cpu_ms_metric() {
    return {"search_cpu_ms",    "ms",         "processor time a frame to find overlapping boxes",
            metric_group::time, better::less, a_frame(&row::search_cpu_ms)};
}

}  // namespace aabblab
