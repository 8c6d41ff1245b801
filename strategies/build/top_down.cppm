module;
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

/// Builds from the root down, node by node, whatever says where a node is split.
export module aabb.build.top_down;

import aabb.geometry;
import aabb.local_detection;

export namespace aabb {

/// Takes the elements of a node and their box. Nodes come depth first, the left child before the right one. Asked by a
/// call, so that the rest is compiled once, whatever the rule.
using split_rule = std::function<split_choice(std::span<const build_element> range, const box& bounds)>;

[[nodiscard]] std::vector<build_node> build_top_down(const mesh& m, leaf_pairing pairing, const split_rule& split);

/// In the middle of the centroids along the longest axis of the box: what every split falls back to where its own rule
/// leaves a side empty.
[[nodiscard]] inline split_choice median_split(std::span<const build_element> range, const box& bounds) {
    return {longest_axis(bounds), range.size() / 2};
}

}  // namespace aabb
