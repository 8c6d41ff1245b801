module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>

export module aabb:spread;

import :geometry;
import :projection;

// How boxes lie along the axes: what strategies choose axes by.
export namespace aabb {

/// Variance of the boxes' centres and mean of their extents, by axis.
struct spread {
    vec3d variance;  ///< of the doubled centres, times the number of boxes
    vec3d extent;    ///< mean
};

/// Of the boxes with these projections. Sums are taken from the first centre, so that far from the origin no digits are
/// lost.
[[nodiscard]] inline spread spread_of(std::span<const box> boxes, std::span<const projection> present) {
    spread result{};
    if (present.empty()) return result;
    const auto centre = [&](const projection& p, int k) {
        return double{boxes[p.id].min[k]} + double{boxes[p.id].max[k]};
    };
    vec3d first{};
    for (int k = 0; k < 3; ++k) first[k] = centre(present[0], k);
    vec3d sum{};
    vec3d squares{};
    for (const projection& p : present)
        for (int k = 0; k < 3; ++k) {
            const double from_first = centre(p, k) - first[k];
            sum[k] += from_first;
            squares[k] += from_first * from_first;
            result.extent[k] += double{boxes[p.id].max[k]} - double{boxes[p.id].min[k]};
        }
    const auto n = static_cast<double>(present.size());
    for (int k = 0; k < 3; ++k) {
        result.variance[k] = std::max(0.0, squares[k] - sum[k] / n * sum[k]);
        result.extent[k] /= n;
    }
    return result;
}

/// How far the last lower end lies above the first upper end, by axis. Where that is not above 0 all boxes overlap, and
/// the axis tells nothing.
/// @param ids of boxes: a range
template <std::ranges::input_range Ids>
[[nodiscard]] vec3d separation_of(std::span<const box> boxes, Ids&& ids) {
    vec3f last_lower = empty_box().max;
    vec3f first_upper = empty_box().min;
    for (const std::uint32_t id : ids)
        for (int k = 0; k < 3; ++k) {
            last_lower[k] = std::max(last_lower[k], boxes[id].min[k]);
            first_upper[k] = std::min(first_upper[k], boxes[id].max[k]);
        }
    vec3d separation{};
    for (int k = 0; k < 3; ++k) separation[k] = double{last_lower[k]} - double{first_upper[k]};
    return separation;
}

/// The axes on which some two boxes are apart; at least one axis.
[[nodiscard]] constexpr axis_set separating_axes(const vec3d& separation) noexcept {
    axis_set axes = 0;
    for (int k = 0; k < 3; ++k) axes |= static_cast<axis_set>(separation[k] > 0) << k;
    return axes ? axes : axis_set{1};
}

}  // namespace aabb
