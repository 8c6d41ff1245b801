module;
#include <optional>
#include <string>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric tree_bytes_metric() {
    // What of an engine's bytes is its tree is not known.
    const auto value = [ours = a_triangle(bytes_of({"nodes", "indices"}))](const row& r) {
        return r.name.is_reference() ? std::nullopt : ours(r);
    };
    return {"tree_bytes", "bytes a triangle", "memory of the trees", metric_group::bytes, better::less, value};
}

}  // namespace aabblab
