module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric tree_bytes_metric() {
    return {"tree_bytes",
            "bytes",
            "memory of the trees, a triangle",
            metric_group::bytes,
            better::less,
            [trees = bytes_of({"nodes", "indices"})](const row& r) -> std::optional<double> {
                const std::optional<double> bytes = trees(r);
                if (!bytes || r.triangles.value_or(0) == 0) return std::nullopt;
                return *bytes / static_cast<double>(*r.triangles);
            }};
}

}  // namespace aabblab
