module;
#include <string>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric tree_bytes_metric() {
    return {"tree_bytes",        "bytes a triangle", "memory of the trees",
            metric_group::bytes, better::less,       a_triangle(bytes_of({"nodes", "indices"}))};
}

}  // namespace aabblab
