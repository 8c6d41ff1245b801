module;
#include <cstddef>
#include <span>
#include <vector>

/// Builds from the root down, node by node, whatever says where a node is split.
export module aabb.build.top_down;

import aabb.geometry;
import aabb.local_detection;

export namespace aabb {

/// Takes the elements of a node and their box.
using split_rule = split_choice(std::span<const build_element> range, const box& bounds);

[[nodiscard]] std::vector<build_node> build_top_down(const mesh& m, leaf_pairing pairing, split_rule& split);

/// In the middle of the centroids along the longest axis of the box: what every split falls back to where its own rule
/// leaves a side empty.
[[nodiscard]] inline split_choice median_split(std::span<const build_element> range, const box& bounds) {
    return {longest_axis(bounds), range.size() / 2};
}

}  // namespace aabb
