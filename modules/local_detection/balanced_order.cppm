module;
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:balanced_order;

import aabb.base;
import aabb.geometry;

export namespace aabb {

/// The triangles of a mesh in the order of the leaves of a balanced tree, eight a leaf: of more than eight, as many go
/// to the left as the greatest power of two below their number. For layouts in which places follow from numbers.
struct balanced_order {
    static constexpr std::size_t leaf_triangles = 8;

    large_vector<std::uint32_t> triangles;  ///< by place
    large_vector<box> bounds;               ///< of the triangles of each leaf
    std::uint32_t threads = 1;              ///< how many may pack it
};

}  // namespace aabb
