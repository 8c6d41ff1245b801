module;
#include <string_view>
#include <vector>

export module aabb.build.sah;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.threaded;

export namespace aabb {

/// The surface-area heuristic in bins (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007): of
/// 15 planes on each axis the one with the least sum of area times triangles on both sides; at the median where all
/// centroids are equal. When to use: for trees that are searched often.
struct sah_build : threaded_build {
    using threaded_build::threaded_build;

    static constexpr std::string_view name = "sah";
    static constexpr std::string_view summary = "by the surface-area heuristic, in 16 bins on each axis";

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const;
    [[nodiscard]] balanced_order order(const mesh& m) const;
};

static_assert(BuildPolicy<sah_build>);

}  // namespace aabb
