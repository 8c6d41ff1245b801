export module aabb.prepare.grown_boxes;

import aabb.geometry;
import aabb.simd;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// Valid boxes grown on every side by at least a margin, in float: what is added to it, 2^-22 of it and of the
/// coordinate, is more than its rounding, the product's and the two sums' take together, 2^-23 of the one and 2^-24 of
/// the other. What would lie beyond the greatest float stays at it.
/// @param margin at least 0
/// @param grown as many
inline void grow(std::span<const box> boxes, double margin, std::span<box> grown) {
    constexpr float greatest = std::numeric_limits<float>::max();
    const double with_rounding = margin * (1 + 0x1p-22) + double{std::numeric_limits<float>::min()};
    const auto wide = static_cast<float>(std::min(with_rounding, double{greatest}));
    // Boxes lie in memory as rows of six numbers; three vectors hold whole rows, whatever their width.
    constexpr std::size_t block = simd::width / 2;
    constexpr std::size_t numbers = 3 * simd::width;
    simd::floats sign[3];
    for (std::size_t i = 0; i < numbers; ++i) sign[i / simd::width][i % simd::width] = i % 6 < 3 ? -1.0F : 1.0F;
    for (std::size_t begin = 0; begin < boxes.size(); begin += block) {
        const std::size_t bytes = std::min(block, boxes.size() - begin) * sizeof(box);
        simd::floats rows[3]{};
        std::memcpy(rows, &boxes[begin], bytes);
        for (std::size_t v = 0; v < 3; ++v) {
            const simd::floats x = rows[v];
            const simd::floats size = x < 0.0F ? -x : x;
            simd::floats moved = x + sign[v] * (wide + 0x1p-22F * size);
            moved = moved < greatest ? moved : simd::all(greatest);
            rows[v] = moved > -greatest ? moved : simd::all(-greatest);
        }
        std::memcpy(&grown[begin], rows, bytes);
    }
}

}  // namespace aabb
