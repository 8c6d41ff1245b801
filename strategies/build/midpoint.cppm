export module aabb.build.midpoint;

import aabb.build.top_down;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Splits in the middle of the box along its longest axis, or at the median if that leaves a side empty.
/// @returns the axis, and the number of elements on the left
[[nodiscard]] split_choice midpoint_split(std::span<const build_element> range, const box& bounds) {
    const int axis = longest_axis(bounds);
    // In double, so that the sum cannot overflow.
    const double middle = (double{bounds.min[axis]} + double{bounds.max[axis]}) / 2;
    const auto is_below = [&](const build_element& e) { return e.centroid[axis] < middle; };
    const auto left = static_cast<std::size_t>(std::ranges::count_if(range, is_below));
    return left == 0 || left == range.size() ? median_split(range, bounds) : split_choice{axis, left};
}

/// The spatial midpoint (van den Bergen, "Efficient collision detection of complex deformable models using AABB trees",
/// 1997): splits a node in the middle of the longest axis of its box, each triangle to the side of its centroid, or at
/// the median if a side would be empty. When to use: as the usual build of AABB trees before the surface-area heuristic
/// (claim C8). Nested triangles may be split off one at a time, which takes quadratic time.
struct midpoint_build : top_down_build<midpoint_split, axis_rule::longest> {
    using top_down_build::top_down_build;

    static constexpr std::string_view name = "midpoint";
    static constexpr std::string_view summary = "splits in the middle of the longest axis of the node's box";
};

static_assert(BuildPolicy<midpoint_build>);

}  // namespace aabb
