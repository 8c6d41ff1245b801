export module aabb.build.mean;

import aabb.build.top_down;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

[[nodiscard]] split_choice mean_split(std::span<const build_element> range, const box& bounds) {
    const int axis = longest_axis(bounds);
    double sum = 0;
    for (const build_element& e : range) sum += e.centroid[axis];
    const double mean = sum / static_cast<double>(range.size());
    const auto below = std::ranges::count_if(range, [&](const build_element& e) { return e.centroid[axis] < mean; });
    const auto left = static_cast<std::size_t>(below);
    return left == 0 || left == range.size() ? median_split(range, bounds) : split_choice{axis, left};
}

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
