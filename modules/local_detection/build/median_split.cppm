module;
#include <span>

export module aabb.local_detection:median_split;

import aabb.geometry;
import :build_node;

export namespace aabb {

/// The paper's balanced split (section 3.1): at the median of the centroids along the longest axis of the box. n
/// triangles give a depth of ⌈log₂ n⌉.
[[nodiscard]] inline split_choice median_split(std::span<const build_element> range, const box& bounds) noexcept {
    return {longest_axis(bounds), range.size() / 2};
}

}  // namespace aabb
