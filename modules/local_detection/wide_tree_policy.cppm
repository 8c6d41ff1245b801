module;
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:wide_tree_policy;

import :eight_boxes;
import :tree_policy;
import :wide_node;

export namespace aabb {

/// A tree with eight children a node that stand side by side, level by level, for `batched_walk`. Child i of node n on
/// level l is node 8 n + i of level l - 1; on level 0 it is leaf 8 n + i, without a node of its own, which holds the
/// triangles at places 8 (8 n + i) to 8 (8 n + i) + 7, or as many as there are. The highest level has one node. All lie
/// in one array, level 0 first. `triangles_of` a leaf repeats the last triangle where it has less than eight.
template <class T>
concept WideTreePolicy = TreePolicy<T> && requires(const T built, std::size_t level, std::uint32_t index) {
    { built.levels() } -> std::same_as<std::size_t>;
    { built.level(level) } -> std::same_as<const wide_node*>;
    { built.triangle_at(index) } -> std::same_as<std::uint32_t>;
    { built.triangles_of(index) } -> std::same_as<std::array<std::uint32_t, eight_boxes::most>>;
};

}  // namespace aabb
