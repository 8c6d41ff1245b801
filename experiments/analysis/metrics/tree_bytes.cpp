module;
#include <string>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric tree_bytes_metric() {
    return {"tree_bytes",        "bytes",      "memory of the trees, a triangle",
            metric_group::bytes, better::less, a_triangle(bytes_of({"nodes", "indices"}))};
}

}  // namespace aabblab
