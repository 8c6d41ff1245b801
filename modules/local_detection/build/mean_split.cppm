module;
#include <algorithm>
#include <cstddef>
#include <span>

export module aabb.local_detection:mean_split;

import aabb.geometry;
import :build_node;
import :median_split;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// The unbalanced split that the balanced one is held against: at the mean of the centroids along the longest axis of
/// the box; at the median where none or all lie below the mean as rounded (equal ones).
[[nodiscard]] inline split_choice mean_split(std::span<const build_element> range, const box& bounds) noexcept {
    const int axis = longest_axis(bounds);
    double sum = 0;
    for (const build_element& e : range) sum += e.centroid[axis];
    const double mean = sum / static_cast<double>(range.size());
    const auto below = std::ranges::count_if(range, [&](const build_element& e) { return e.centroid[axis] < mean; });
    const auto left = static_cast<std::size_t>(below);
    return left == 0 || left == range.size() ? median_split(range, bounds) : split_choice{axis, left};
}

}  // namespace aabb
