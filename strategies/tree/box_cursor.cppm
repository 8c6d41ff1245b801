export module aabb.tree.box_cursor;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// Place in a tree that does not store its nodes' boxes as they are: the box goes along.
struct box_cursor {
    static constexpr std::uint32_t leaf_bit = 0x80000000;

    box bounds;
    std::uint32_t index;  ///< of an internal node, or with the top bit set of a leaf or its triangle

    [[nodiscard]] constexpr bool is_leaf() const noexcept { return index & leaf_bit; }
    [[nodiscard]] constexpr std::uint32_t leaf() const noexcept { return index & ~leaf_bit; }
};

}  // namespace aabb
