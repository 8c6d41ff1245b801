module;
#include <functional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric search_ms_metric() {
    return {"search_ms",        "ms",         "time a frame to find overlapping boxes",
            metric_group::time, better::less, a_frame(&row::search_ms)};
}

}  // namespace aabblab
