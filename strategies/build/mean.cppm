module;
#include <string_view>
#include <vector>

export module aabb.build.mean;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.threaded;

export namespace aabb {

/// The unbalanced build that the balanced one is held against (claim C8): a node is split at the mean of the centroids
/// along the longest axis of its box; at the median where none or all lie below the mean as rounded (equal ones). When
/// to use: for trees that are searched faster than balanced ones and built as fast.
struct mean_build : threaded_build {
    using threaded_build::threaded_build;

    static constexpr std::string_view name = "mean";
    static constexpr std::string_view summary = "at the mean of the triangles' centroids along the longest axis";

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const;
    [[nodiscard]] balanced_order order(const mesh& m) const;
};

static_assert(BuildPolicy<mean_build>);

}  // namespace aabb
