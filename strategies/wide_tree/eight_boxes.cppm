export module aabb.wide_tree.eight_boxes;

export import aabb.geometry;
import aabb.std;
export import aabb.wide_tree.kernels;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

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

/// The space of a query, in which coordinates are numbers of 16 bits: 65,000 steps where the boxes of both meshes
/// overlap, the first or the last number beyond. The number of x is the whole part of x * scale - offset, as float
/// computes it. It never falls when x grows, however it is rounded: if only it is rounded alike wherever numbers are
/// made, so the pragma matters.
class leaf_grid {
public:
    /// @param a,b boxes of the meshes, in A's frame
    void begin(const box& a, const box& b) noexcept {
        rows scale{};
        rows offset{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(k);
            const float low = std::max(a.min[axis], b.min[axis]);
            const float high = std::min(a.max[axis], b.max[axis]);
            const float steps = 2 * reach / (high - low);
            edges_[k] = std::max(a.max[axis], b.max[axis]) - std::min(a.min[axis], b.min[axis]);
            // Where this is not so, all numbers of the axis are 0.
            if (!(steps > 0) || !(steps * (edges_[k] + std::abs(low) + std::abs(high)) < most_number)) continue;
            scale[k] = scale[3 + k] = simd::eight_floats{} + steps;
            offset[k] = offset[3 + k] = simd::eight_floats{} + (low * steps + reach);
        }
        for (std::size_t two = 0; two < 3; ++two) {
            scale_[two] = simd::joined(scale[2 * two], scale[2 * two + 1]);
            offset_[two] = simd::joined(offset[2 * two], offset[2 * two + 1]);
        }
    }

    /// Of a box around all vertices of both meshes.
    [[nodiscard]] const std::array<float, 3>& edges() const noexcept { return edges_; }

    /// Of rows 2 i and 2 i + 1 of boxes.
    [[nodiscard]] inline simd::sixteen_halves numbers(std::size_t i, simd::sixteen_floats two_rows) const noexcept {
        return simd::whole_halves(two_rows * scale_[i] - offset_[i]);
    }

private:
    using rows = std::array<simd::eight_floats, 6>;  // as those of boxes
    static constexpr float reach = 32500;            // a little less than numbers, for what is rounded
    static constexpr float most_number = 1e37F;      // before it is cut off; below, nothing overflows

    std::array<float, 3> edges_{};
    std::array<simd::sixteen_floats, 3> scale_{};
    std::array<simd::sixteen_floats, 3> offset_{};
};

/// The boxes of a leaf's triangles in 16 bits a plane. They overlap wherever the triangles' boxes do, and elsewhere
/// only where these are less than some two steps apart, or where 16 bits will not do (`are_coarse`).
class leaf_boxes {
public:
    /// @param rows lower bounds along each axis, then upper ones
    /// @param count how many boxes there are; the others overlap none
    inline void take(const leaf_grid& grid, const std::array<simd::eight_floats, 6>& rows, std::size_t count) noexcept {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto numbers = grid.numbers(i, simd::joined(rows[2 * i], rows[2 * i + 1]));
            std::memcpy(&at_[2 * i], &numbers, sizeof numbers);
        }
        for (; count < eight_boxes::most; ++count)
            for (std::size_t k = 0; k < 3; ++k) {
                at_[k][count] = std::numeric_limits<std::int16_t>::max();
                at_[3 + k][count] = std::numeric_limits<std::int16_t>::min();
            }
    }

    /// Sixty-four pairs at once: bit 8 j + i for box i of these and box j of `others`, where they overlap.
    [[nodiscard]] inline std::uint64_t overlaps(const leaf_boxes& others) const noexcept {
        return simd::pairs_of_eight_that_overlap(at_[0].data(), others.at_[0].data());
    }

    /// Whether a box, the first one, has so few steps that a grid for the leaf would be better.
    [[nodiscard]] inline bool are_coarse() const noexcept {
        bool few = true;
        for (std::size_t k = 0; k < 3; ++k) few &= at_[3 + k][0] - at_[k][0] < least_steps;
        return few;
    }

private:
    static constexpr int least_steps = 4;

    alignas(32) std::array<std::array<std::int16_t, eight_boxes::most>, 6> at_;
};

}  // namespace aabb
