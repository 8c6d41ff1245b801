module;
#include <cstdint>

export module aabb.tree.box_cursor;

import aabb.geometry;
import aabb.local_detection;

export namespace aabb {

/// Place in a tree that does not store its nodes' boxes as they are: the box goes along.
struct box_cursor {
    static constexpr std::uint32_t leaf_bit = 0x80000000;

    box bounds;
    std::uint32_t index;  ///< of an internal node, or with the top bit set of a leaf or its triangle

    [[nodiscard]] constexpr bool is_leaf() const noexcept { return index & leaf_bit; }
    [[nodiscard]] constexpr std::uint32_t leaf() const noexcept { return index & ~leaf_bit; }
};

/// At a leaf that has no box: it goes along with the triangle's own where that is to be tested, else with its parent's.
[[nodiscard]] inline box_cursor leaf_cursor(std::uint32_t triangle, const box& parent, leaf_test_choice test,
                                            const mesh& m) noexcept {
    return {test == leaf_test_choice::triangle_aabb ? bounds_of(m.triangle(triangle)) : parent,
            triangle | box_cursor::leaf_bit};
}

}  // namespace aabb
