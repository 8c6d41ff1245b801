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

/// Of triangles on the left: as many as the rule finds best.
inline constexpr std::size_t any_number = 0;

/// Takes the elements of a node, their box, and how many will be on the left, or `any_number`. Nodes come depth first,
/// the left child before the right one. Asked by a call, so that the rest is compiled once, whatever the rule.
using split_rule =
    std::function<split_choice(std::span<const build_element> range, const box& bounds, std::size_t left)>;

/// Along an axis; ties go by index, so that the tree does not depend on the library.
struct centroid_order {
    int axis;

    [[nodiscard]] bool operator()(const build_element& p, const build_element& q) const noexcept {
        return p.centroid[axis] != q.centroid[axis] ? p.centroid[axis] < q.centroid[axis] : p.triangle < q.triangle;
    }
};

[[nodiscard]] std::vector<build_node> build_top_down(const mesh& m, leaf_arrangement arrangement,
                                                     const split_rule& split);

/// In the middle of the centroids along the longest axis of the box: what every split falls back to where its own rule
/// leaves a side empty.
[[nodiscard]] inline split_choice median_split(std::span<const build_element> range, const box& bounds,
                                               std::size_t /*left*/ = any_number) {
    return {longest_axis(bounds), range.size() / 2};
}

}  // namespace aabb
