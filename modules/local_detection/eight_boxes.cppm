module;
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:eight_boxes;

import aabb.geometry;
import aabb.simd;

export namespace aabb {

/// Up to eight boxes, coordinate by coordinate: three rows of lower bounds, then three of upper
/// ones. What stands in the places from `count` on is nobody's.
struct eight_boxes {
    static constexpr std::size_t most = 8;
    using row = std::array<float, most>;

    alignas(32) std::array<row, 3> lower;
    alignas(32) std::array<row, 3> upper;
    std::uint32_t count;

    /// @param rows as they stand here
    inline void take(const std::array<simd::eight_floats, 6>& rows, std::size_t boxes) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            simd::store_eight(lower[k].data(), rows[k]);
            simd::store_eight(upper[k].data(), rows[3 + k]);
        }
        count = static_cast<std::uint32_t>(boxes);
    }

    /// Sixty-four pairs at once: bit 8 j + i for box i of these and box j of `others`, where they overlap.
    [[nodiscard]] inline std::uint64_t overlaps(const eight_boxes& others) const noexcept {
        const std::uint64_t columns = std::uint64_t{0x0101010101010101} * (0xffU >> (most - count));
        const std::uint64_t rows = ~std::uint64_t{0} >> (most * (most - others.count));
        return simd::pairs_of_eight_that_overlap(lower[0].data(), others.lower[0].data()) & columns & rows;
    }
};

}  // namespace aabb
