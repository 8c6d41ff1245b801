module;
#include <cstdint>

export module aabb.local_detection:leaf_test;

export namespace aabb {

/// What is tested in place of the box of a leaf that has none.
enum class leaf_test_choice : std::uint8_t {
    none,                ///< nothing: the triangles are tested at once
    triangle_box,        ///< the leaf's triangle against the other node's box, `triangle_meets_box`
    triangle_aabb,       ///< the triangle's own box, made on the fly
    moller_triangle_box  ///< as `triangle_box`, but Möller's original, which loses pairs that touch
};

}  // namespace aabb
