module;
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:build_node;

import aabb.geometry;

export namespace aabb {

/// Node of a binary tree before a layout packs it. Nodes stand in depth-first order: the left child of an internal node
/// is the next node.
struct build_node {
    box bounds;
    std::uint32_t right;     ///< index of the right child; 0 in a leaf
    std::uint32_t triangle;  ///< index of the triangle in a leaf

    [[nodiscard]] bool is_leaf() const noexcept { return right == 0; }
};

/// A triangle on its way into a tree.
struct build_element {
    box bounds;
    vec3f centroid;
    std::uint32_t triangle;
};

/// Where a layout wants leaves to be. `pairs`: a node of an even number of triangles has two children of even numbers;
/// the split moves by one triangle where it must. For layouts in which a leaf beside an internal node wastes memory.
enum class leaf_arrangement : std::uint8_t { any, pairs };

/// How a node's triangles are split: in the order of their centroids along an axis (and of their indices where those
/// are equal), or as they stand, the first `left` go to the left.
struct split_choice {
    static constexpr int as_they_stand = -1;

    int axis;
    std::size_t left;
};

}  // namespace aabb
