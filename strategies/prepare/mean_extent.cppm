module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.prepare.mean_extent;

import aabb.geometry;
import aabb.global_search;

export namespace aabb {

/// The unit of lengths that are told in mean extents: `times` the mean, over the boxes of the objects that are present
/// and the three axes; 0 where nobody is.
[[nodiscard]] inline double mean_extents(double times, std::span<const box> boxes, const membership& objects) noexcept {
    double extents = 0;
    std::size_t present = 0;
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
        if (!objects.contains(id)) continue;
        for (int k = 0; k < 3; ++k) extents += double{boxes[id].max[k]} - double{boxes[id].min[k]};
        ++present;
    }
    return present == 0 ? 0 : times * extents / (3 * static_cast<double>(present));
}

/// The median over a few boxes of their extents, each a mean over the three axes: one huge box hardly changes it. 0
/// where there is none.
/// @param some at most 16
[[nodiscard]] inline double median_extent(std::span<const box> some) noexcept {
    std::array<double, 16> extents{};
    for (std::size_t i = 0; i < some.size(); ++i)
        for (int k = 0; k < 3; ++k) extents[i] += (double{some[i].max[k]} - double{some[i].min[k]}) / 3;
    const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::nth_element(extents.begin(), middle, extents.begin() + static_cast<std::ptrdiff_t>(some.size()));
    return some.empty() ? 0 : *middle;
}

}  // namespace aabb
