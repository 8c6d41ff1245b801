export module aabb.build.midpoint;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.balanced;
import aabb.build.top_down;
import aabb.std;

export namespace aabb {

[[nodiscard]] split_choice midpoint_split(std::span<const build_element> range, const box& bounds);

/// The spatial midpoint (van den Bergen, "Efficient collision detection of complex deformable models using AABB trees",
/// 1997): a node is split in the middle of the longest axis of its box, each triangle to the side of its centroid; at
/// the median where a side would be empty. When to use: as what AABB trees were usually built by before the
/// surface-area heuristic (claim C8). Triangles nested in one another may be peeled off one by one, which takes time
/// quadratic in their number.
struct midpoint_build : top_down_build<midpoint_split, axis_rule::longest> {
    using top_down_build::top_down_build;

    static constexpr std::string_view name = "midpoint";
    static constexpr std::string_view summary = "in the middle of the longest axis of the node's box";
};

static_assert(BuildPolicy<midpoint_build>);

}  // namespace aabb
