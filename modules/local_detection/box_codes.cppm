module;
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:box_codes;

import aabb.simd;
import :eight_boxes;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// The planes that codes stand for: along axis k, the code of x is the whole part of x * scale[k] - offset[k], as float
/// computes it, but no more than 254, and 0 below 0. It never falls when x grows, however it is rounded: if only it is
/// rounded alike wherever codes are made and compared, so the pragma matters.
struct code_grid {
    std::array<float, 3> scale;
    std::array<float, 3> offset;
};

/// Up to eight boxes in a byte a plane. Where there is none, the codes are 255, which nothing meets.
struct box_codes {
    static constexpr std::uint8_t no_box = 255;

    using row = std::array<std::uint8_t, eight_boxes::most>;
    std::array<row, 3> lower;
    std::array<row, 3> upper;  ///< 255 less the plane's code, so that one comparison serves both

    /// Sixty-four pairs at once: bit 8 j + i for box i of these and box j of `others`, if they may overlap.
    [[nodiscard]] inline std::uint64_t overlaps(const code_grid& grid, const eight_boxes& others) const noexcept {
        std::uint64_t met = ~std::uint64_t{0} >> (64U - 8U * others.count);
        for (std::size_t k = 0; k < 3; ++k)
            met &= simd::no_greater(lower[k].data(), from_below(grid, k, others.upper[k])) &
                   simd::no_greater(upper[k].data(), from_above(grid, k, others.lower[k]));
        return met;
    }

    /// Empties the places from `count` on.
    inline void keep_first(std::size_t count) noexcept {
        for (std::size_t i = count; i < eight_boxes::most; ++i)
            for (std::size_t k = 0; k < 3; ++k) lower[k][i] = upper[k][i] = no_box;
    }

private:
    [[nodiscard]] static inline simd::eight_floats place(const code_grid& grid, std::size_t k,
                                                         const eight_boxes::row& x) noexcept {
        return simd::load_eight<simd::eight_floats>(x.data()) * grid.scale[k] - grid.offset[k];
    }
    [[nodiscard]] static inline simd::eight_bytes from_below(const code_grid& grid, std::size_t k,
                                                             const eight_boxes::row& x) noexcept {
        return simd::whole_bytes(place(grid, k, x));
    }
    [[nodiscard]] static inline simd::eight_bytes from_above(const code_grid& grid, std::size_t k,
                                                             const eight_boxes::row& x) noexcept {
        return simd::whole_bytes(255 - place(grid, k, x));
    }
};

}  // namespace aabb
