export module aabb.build.mean;

import aabb.build.top_down;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Splits at the mean of the centroids along the longest axis, or at the median if that leaves a side empty.
/// @returns the axis, and the number of elements on the left
[[nodiscard]] split_choice mean_split(std::span<const build_element> range, const box& bounds) {
    const int axis = longest_axis(bounds);
    double sum = 0;
    for (const build_element& e : range) sum += e.centroid[axis];
    const double mean = sum / static_cast<double>(range.size());
    const auto is_below = [&](const build_element& e) { return e.centroid[axis] < mean; };
    const auto left = static_cast<std::size_t>(std::ranges::count_if(range, is_below));
    return left == 0 || left == range.size() ? median_split(range, bounds) : split_choice{axis, left};
}

/// The unbalanced build that the balanced one is compared with (claim C8): splits a node at the mean of the centroids
/// along the longest axis of its box, or at the median if none or all lie below the rounded mean (equal centroids).
/// When to use: for trees that are queried faster than balanced ones and built as fast.
struct mean_build : top_down_build<mean_split, axis_rule::longest> {
    using top_down_build::top_down_build;

    static constexpr std::string_view name = "mean";
    static constexpr std::string_view summary = "splits at the mean of the triangles' centroids along the longest axis";
};

static_assert(BuildPolicy<mean_build>);

}  // namespace aabb
