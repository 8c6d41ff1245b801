module;
#include <concepts>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:wide_tree_policy;

import :tree_policy;
import :wide_node;

export namespace aabb {

/// A tree with eight children a node that stand side by side, level by level, for `batched_walk`. The nodes of level 0
/// hold triangles, up to eight each: child i of node n there is the triangle at place 8 n + i. Above, it is node 8 n +
/// i of the level below. The highest level has one node.
template <class T>
concept WideTreePolicy = TreePolicy<T> && requires(const T built, std::size_t level, std::uint32_t index) {
    { built.levels() } -> std::same_as<std::size_t>;
    { built.level(level) } -> std::same_as<const wide_node*>;
    { built.triangle_at(index) } -> std::same_as<std::uint32_t>;
};

}  // namespace aabb
