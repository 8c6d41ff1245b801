export module aabb.wide_tree.eight_boxes;

export import aabb.geometry;
import aabb.std;
export import aabb.wide_tree.kernels;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Up to eight boxes as a structure of arrays: three rows of lower bounds, then three of upper bounds.
struct eight_boxes {
    static constexpr std::size_t most = 8;
    using row = std::array<float, most>;

    alignas(32) std::array<row, 3> lower;
    alignas(32) std::array<row, 3> upper;
    std::uint32_t count;  ///< of boxes; further columns have no meaning

    /// @param rows in the order of the members
    inline void set(const std::array<simd::eight_floats, 6>& rows, std::size_t boxes) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            simd::store_eight(lower[k].data(), rows[k]);
            simd::store_eight(upper[k].data(), rows[3 + k]);
        }
        count = static_cast<std::uint32_t>(boxes);
    }

    /// Tests 64 pairs at once: sets bit 8 j + i where box i of these overlaps box j of `others`.
    [[nodiscard]] inline std::uint64_t overlaps(const eight_boxes& others) const noexcept {
        const std::uint64_t columns = std::uint64_t{0x0101010101010101} * (0xffU >> (most - count));
        const std::uint64_t rows = ~std::uint64_t{0} >> (most * (most - others.count));
        return simd::overlapping_pairs(lower[0].data(), others.lower[0].data()) & columns & rows;
    }
};

/// Maps coordinates to codes: along axis k, the code of x is the integer part of x * scale[k] - offset[k], computed in
/// float and clamped to 0 and 254. It is monotone in x, whatever the rounding, as long as codes are rounded in the same
/// way wherever they are computed. That is why the pragma matters.
struct code_grid {
    std::array<float, 3> scale;
    std::array<float, 3> offset;
};

/// Up to eight boxes in one byte per plane. Those that are missing have codes 255, which overlap nothing.
struct quantized_aabbs {
    static constexpr std::uint8_t no_box = 255;

    using row = std::array<std::uint8_t, eight_boxes::most>;
    std::array<row, 3> lower;
    std::array<row, 3> upper;  ///< 255 minus the plane's code, so that both need the same comparison

    /// Tests 64 pairs at once: sets bit 8 j + i where box i may overlap box j of `others`, whose floats are rounded to
    /// codes of the grid. On each axis, lower[i] <= upper[j] and 255 - upper[i] <= 255 - lower[j], in codes.
    [[nodiscard]] inline std::uint64_t overlaps(const code_grid& grid, const eight_boxes& others) const noexcept {
        const auto on_grid = [&](std::size_t k, const eight_boxes::row& x) {
            return simd::load_eight<simd::eight_floats>(x.data()) * grid.scale[k] - grid.offset[k];
        };
        std::uint64_t mask = ~std::uint64_t{0} >> (64U - 8U * others.count);  // the rows of boxes that exist
        for (std::size_t k = 0; k < 3; ++k)
            mask &= simd::pairs_no_greater(lower[k].data(), simd::whole_bytes(on_grid(k, others.upper[k]))) &
                    simd::pairs_no_greater(upper[k].data(), simd::whole_bytes(255 - on_grid(k, others.lower[k])));
        return mask;
    }

    /// The same for one box: sets bit i where box i may overlap it.
    [[nodiscard]] inline std::uint32_t overlaps(const code_grid& grid, const box& other) const noexcept {
        const auto [sx, sy, sz] = grid.scale;
        const auto [ox, oy, oz] = grid.offset;
        const simd::eight_floats bounds{
            other.max[0], other.max[1], other.max[2], other.min[0], other.min[1], other.min[2], 0, 0};
        const simd::eight_floats scale{sx, sy, sz, sx, sy, sz, 0, 0}, offset{ox, oy, oz, ox, oy, oz, 0, 0};
        const simd::eight_floats on_grid = bounds * scale - offset;
        return simd::columns_no_greater(lower[0].data(), simd::whole_bytes(__builtin_shufflevector(
                                                             on_grid, 255 - on_grid, 0, 1, 2, 11, 12, 13, 6, 7)));
    }

    /// Empties the boxes from `count` on.
    inline void keep_first(std::size_t count) noexcept {
        for (std::size_t i = count; i < eight_boxes::most; ++i)
            for (std::size_t k = 0; k < 3; ++k) lower[k][i] = upper[k][i] = no_box;
    }
};

/// The grid of a query, on which coordinates are 16-bit integers: 65,000 steps where the boxes of both meshes overlap,
/// clamped outside. The number of x is monotone in x, as on a `code_grid`.
class leaf_grid {
public:
    /// Spans the grid over the intersection of the meshes' boxes: triangles beyond it meet none of the other mesh. On
    /// each axis, the number of x is x * scale - offset: -half_range at the lower end and half_range at the upper one.
    /// @param a,b boxes of the meshes, in A's frame
    void begin(const box& a, const box& b) noexcept {
        rows scale{};
        rows offset{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(k);
            const float low = std::max(a.min[axis], b.min[axis]);
            const float high = std::min(a.max[axis], b.max[axis]);
            const float steps = 2 * half_range / (high - low);
            edges_[k] = std::max(a.max[axis], b.max[axis]) - std::min(a.min[axis], b.min[axis]);
            // Without an extent, or if numbers could overflow, all are 0: the axis separates nothing.
            if (!(steps > 0) || !(steps * (edges_[k] + std::abs(low) + std::abs(high)) < most_number)) continue;
            scale[k] = scale[3 + k] = simd::eight_floats{} + steps;
            offset[k] = offset[3 + k] = simd::eight_floats{} + (low * steps + half_range);
        }
        // `numbers` computes two rows at a time.
        for (std::size_t i = 0; i < 3; ++i) {
            scale_[i] = simd::joined(scale[2 * i], scale[2 * i + 1]);
            offset_[i] = simd::joined(offset[2 * i], offset[2 * i + 1]);
        }
    }

    /// The extents of a box around all vertices of both meshes.
    [[nodiscard]] const std::array<float, 3>& edges() const noexcept { return edges_; }
    /// Quantises rows 2 i and 2 i + 1 of boxes.
    [[nodiscard]] inline simd::sixteen_i16 numbers(std::size_t i, simd::sixteen_floats two_rows) const noexcept {
        return simd::whole_i16(two_rows * scale_[i] - offset_[i]);
    }

private:
    using rows = std::array<simd::eight_floats, 6>;  // in the order of boxes
    static constexpr float half_range = 32500;       // a little less than 2^15, for rounding
    static constexpr float most_number = 1e37F;      // before clamping; smaller numbers cannot overflow

    std::array<float, 3> edges_{};
    std::array<simd::sixteen_floats, 3> scale_{};
    std::array<simd::sixteen_floats, 3> offset_{};
};

/// The boxes of a leaf's triangles in 16 bits per plane. There are no false negatives; false positives have distances
/// below some two steps, or arise where 16 bits are too coarse (`are_coarse`).
class leaf_boxes {
public:
    /// Stores the boxes as 16-bit integers on the grid, so that a comparison takes half as many vectors as in float.
    /// @param rows lower bounds along each axis, then upper bounds
    /// @param count the number of boxes; those beyond are set to overlap nothing
    inline void quantize(const leaf_grid& grid, const std::array<simd::eight_floats, 6>& rows,
                         std::size_t count) noexcept {
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

    /// Tests 64 pairs at once: sets bit 8 j + i where box i of these overlaps box j of `others`.
    [[nodiscard]] inline std::uint64_t overlaps(const leaf_boxes& others) const noexcept {
        return simd::overlapping_pairs(at_[0].data(), others.at_[0].data());
    }

    /// Whether the first box spans so few steps that the grid is too coarse for the leaf.
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
