export module aabb.build.mean;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.balanced;
import aabb.build.top_down;
import aabb.std;

export namespace aabb {

[[nodiscard]] split_choice mean_split(std::span<const build_element> range, const box& bounds);

/// The unbalanced build that the balanced one is held against (claim C8): a node is split at the mean of the centroids
/// along the longest axis of its box; at the median where none or all lie below the mean as rounded (equal ones). When
/// to use: for trees that are searched faster than balanced ones and built as fast.
struct mean_build : top_down_build<mean_split, axis_rule::longest> {
    using top_down_build::top_down_build;

    static constexpr std::string_view name = "mean";
    static constexpr std::string_view summary = "at the mean of the triangles' centroids along the longest axis";
};

static_assert(BuildPolicy<mean_build>);

}  // namespace aabb
