module;
#include <algorithm>
#include <cstddef>

export module aabb.local_detection:leaf_codes;

import aabb.geometry;
import :box_codes;
import :eight_boxes;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// The boxes of a leaf's triangles on a grid of their own, made when they are needed.
struct leaf_codes {
    code_grid grid;
    box_codes planes;

    /// @param boxes in the places from `count` on, one is repeated
    /// @param all the box of all
    void encode(const eight_boxes& boxes, const box& all) noexcept {
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            // Where the leaf is flat, its place alone has digits to tell apart.
            const float extent =
                std::max({all.max[k] - all.min[k], std::max(-all.min[k], all.max[k]) * 0x1p-22F, 0x1p-100F});
            grid.scale[axis] = 252 / extent;
            grid.offset[axis] = all.min[k] * grid.scale[axis] - 1;
        }
        planes.encode(grid, boxes);
    }
};

}  // namespace aabb
