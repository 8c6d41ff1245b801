/// The items of a balanced build, and the choice of a split: the axis for many items, the exact split for a few.
export module aabb.build.balanced_items;

import aabb.geometry;
import aabb.simd;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// A triangle as a build moves it: its box as one SIMD vector.
struct alignas(32) boxed_triangle {
    std::array<float, 3> lower;
    std::uint32_t triangle;
    std::array<float, 3> negated_upper;  // so that one minimum merges both
    std::uint32_t unused;

    /// Cannot overflow.
    [[nodiscard]] inline float centre(std::size_t axis) const noexcept {
        return 0.5F * lower[axis] - 0.5F * negated_upper[axis];
    }
    /// The centre in lanes 0 to 2, then padding; not the triangle's index, which as a float may be a slow denormal.
    [[nodiscard]] inline simd::eight_floats centre() const noexcept {
        const auto bounds = std::bit_cast<simd::eight_floats>(*this);
        const auto half = 0.5F * __builtin_shufflevector(bounds, bounds, 0, 1, 2, 2, 4, 5, 6, 6);
        return half - __builtin_shufflevector(half, half, 4, 5, 6, 7, 0, 1, 2, 3);
    }
};

/// Orders items by centre along an axis; ties are broken by triangle, so that the order is unique.
struct centre_order {
    std::size_t axis;

    [[nodiscard]] inline bool operator()(const boxed_triangle& p, const boxed_triangle& q) const noexcept {
        const float at_p = p.centre(axis);
        const float at_q = q.centre(axis);
        return at_p != at_q ? at_p < at_q : p.triangle < q.triangle;
    }
};

/// The box of several items. The lanes of their indices have no meaning.
class item_bounds {
public:
    inline void take(const boxed_triangle& item) noexcept { at_ = lesser(item); }
    inline void take(const item_bounds& other) noexcept { at_ = other.at_ < at_ ? other.at_ : at_; }
    /// Grows this box by all items, in two chains (even and odd indices), whose minima do not wait for each other.
    inline void take(std::span<const boxed_triangle> items) noexcept {
        item_bounds odd;
        std::size_t i = 0;
        for (; i + 1 < items.size(); i += 2) {
            take(items[i]);
            odd.take(items[i + 1]);
        }
        if (i < items.size()) take(items[i]);
        take(odd);
    }
    /// Merges the item if `wanted`, without a branch.
    inline void take_if(bool wanted, const boxed_triangle& item) noexcept {
        const simd::eight_words every = simd::eight_words{} - std::uint32_t{wanted};
        at_ = every ? lesser(item) : at_;
    }
    [[nodiscard]] box as_box() const noexcept { return {{at_[0], at_[1], at_[2]}, {-at_[4], -at_[5], -at_[6]}}; }

private:
    [[nodiscard]] inline simd::eight_floats lesser(const boxed_triangle& item) const noexcept {
        const auto other = std::bit_cast<simd::eight_floats>(item);
        return other < at_ ? other : at_;
    }

    simd::eight_floats at_ = simd::eight_floats{} + std::numeric_limits<float>::infinity();
};

/// A sample of items, binned along each axis by centre: estimates the cost of a split to the precision of a bin.
class binned_items {
public:
    /// The sample size; trees built from larger samples are not faster to query.
    static constexpr std::size_t most = 256;

    /// Puts the centre of every `step`-th item on each axis into the bin floor((centre - low) * bins / edge) of
    /// `bounds`, the box of all items.
    /// @param items must outlive the sample
    binned_items(std::span<const boxed_triangle> items, std::size_t step, const box& bounds) noexcept
        : items_(items), step_(step) {
        // Lanes 0 to 2 are the axes; the others are padding.
        eight_floats low{};
        eight_floats bins_per_length{};
        for (int k = 0; k < 3; ++k) {
            low[k] = bounds.min[k];
            const float edge = bounds.max[k] - bounds.min[k];
            bins_per_length[k] = edge > 0 ? bins / edge : 0;
        }
        for (std::size_t i = 0; i < items.size(); i += step, ++count_) {
            // Truncates, and clamps a centre on the upper end of the box to the last bin.
            const simd::eight_bytes bin = simd::whole_bytes((items[i].centre() - low) * bins_per_length);
            for (std::size_t k = 0; k < 3; ++k) {
                bin_of_item_[k][count_] = bin[k];
                ++count_in_bin_[k][bin[k]];
            }
        }
    }

    /// The surface-area cost by axis of a split at the border between bins that leaves about `left_count` of the
    /// `count_` sampled items on the left: the sum over both sides of area times number of items.
    [[nodiscard]] std::array<double, 3> costs(std::size_t left_count) const noexcept {
        std::array<std::size_t, 3> end{};      // on each axis the first bin of the right side
        std::array<std::size_t, 3> in_left{};  // and the number of sampled items in the bins before it
        // Adds bins to the left while more than half of the items of the next bin are wanted there.
        for (std::size_t k = 0; k < 3; ++k)
            while (end[k] < bins && in_left[k] + count_in_bin_[k][end[k]] / 2U < left_count)
                in_left[k] += count_in_bin_[k][end[k]++];
        std::array<item_bounds, 3> left_sides;
        std::array<item_bounds, 3> right_sides;
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const bool is_left = bin_of_item_[k][i] < end[k];
                left_sides[k].take_if(is_left, items_[step_ * i]);
                right_sides[k].take_if(!is_left, items_[step_ * i]);
            }
        const auto cost = [](const item_bounds& side, std::size_t number) {
            return number == 0 ? 0 : surface_area(side.as_box()) * static_cast<double>(number);
        };
        std::array<double, 3> costs;
        for (std::size_t k = 0; k < 3; ++k)
            costs[k] = cost(left_sides[k], in_left[k]) + cost(right_sides[k], count_ - in_left[k]);
        return costs;
    }

private:
    using eight_floats = simd::eight_floats;
    static constexpr std::size_t bins = 255;  // the range of `whole_bytes`

    std::span<const boxed_triangle> items_;
    std::size_t step_;
    std::size_t count_ = 0;
    std::array<std::array<std::uint8_t, most>, 3> bin_of_item_;
    std::array<std::array<std::uint16_t, bins>, 3> count_in_bin_{};
};

/// Up to 64 items as a structure of arrays.
class few_items {
public:
    static constexpr std::size_t most = 64;

    /// Copies each bound of the items to an array of its own, for SIMD loads, and rounds their centres to 16 bits. The
    /// arrays are padded with the last item, which changes no box of a side that contains it.
    /// @param items 1 to 64
    explicit few_items(std::span<const boxed_triangle> items) noexcept : count_(items.size()) {
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                lower_[k][i] = items[i].lower[k];
                negated_upper_[k][i] = items[i].negated_upper[k];
            }
        // 1, 2 or 4 vectors, as `mask_by_vectors` reads them.
        const std::size_t filled = std::max(std::bit_ceil(count_), lanes);
        for (std::size_t i = count_; i < filled; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                lower_[k][i] = lower_[k][count_ - 1];
                negated_upper_[k][i] = negated_upper_[k][count_ - 1];
            }
        for (std::size_t k = 0; k < 3; ++k) quantize_centres(k, filled / lanes);
    }

    /// Sets bit i for each item i with fewer than `number` items before it along the axis, to a precision of 16 bits:
    /// the first `number` items, and possibly more whose centres are equal at that precision.
    [[nodiscard]] inline std::uint64_t mask_of_first(std::size_t number, std::size_t axis) const noexcept {
        return mask_by_vectors<1>(static_cast<std::int16_t>(number), axis);
    }

    /// The surface-area cost of a split by a mask: the sum over both sides of half the area times the number of items.
    [[nodiscard]] inline double cost_of(std::uint64_t mask) const noexcept {
        // The padding repeats the last item, so it belongs to that item's side, whose box it does not enlarge.
        const std::uint64_t fill = count_ < most && (mask >> (count_ - 1) & 1) != 0 ? ~std::uint64_t{0} << count_ : 0;
        // By side and bound (three lower ends, three negated upper ends): in each lane the least value so far.
        std::array<std::array<eight_floats, 6>, 2> sides;
        for (auto& side : sides) side.fill(eight_floats{} + std::numeric_limits<float>::infinity());
        for (std::size_t v = 0; v < vectors(); ++v) {
            const auto bits_of_vector = static_cast<std::uint8_t>((mask | fill) >> v * width);
            const auto in_first = simd::flags_of_eight(bits_of_vector);
            for (std::size_t row = 0; row < 6; ++row) {
                const eight_floats x = row < 3 ? load(lower_[row], v) : load(negated_upper_[row - 3], v);
                sides[0][row] = in_first ? lesser(x, sides[0][row]) : sides[0][row];
                sides[1][row] = in_first ? sides[1][row] : lesser(x, sides[1][row]);
            }
        }
        const auto first_count = static_cast<std::size_t>(std::popcount(mask));
        const auto cost = [](const auto& side, std::size_t count) {
            return count == 0 ? 0 : half_area(side) * static_cast<double>(count);
        };
        return cost(sides[0], first_count) + cost(sides[1], count_ - first_count);
    }

private:
    using eight_floats = simd::eight_floats;
    static constexpr std::size_t width = 8;
    static constexpr std::size_t lanes = 16;    // of the longest vector
    static constexpr float half_range = 32500;  // of i16, less a margin for rounding
    using row = std::array<float, most>;

    /// Rounds the centres on an axis to 16 bits, since a vector then holds twice as many of them as of floats: the
    /// least becomes -half_range, the greatest half_range, the others lie proportionally between. If a float cannot
    /// hold the scale, as for equal centres, all become 0.
    /// @param vectors number of vectors of 16 lanes that hold the items and the padding
    inline void quantize_centres(std::size_t axis, std::size_t vectors) noexcept {
        std::array<simd::sixteen_floats, most / lanes> centre;
        simd::sixteen_floats least = simd::sixteen_floats{} + std::numeric_limits<float>::infinity();
        simd::sixteen_floats negated_greatest = least;
        for (std::size_t v = 0; v < vectors; ++v) {
            simd::sixteen_floats lower, negated_upper;
            std::memcpy(&lower, &lower_[axis][v * lanes], sizeof lower);
            std::memcpy(&negated_upper, &negated_upper_[axis][v * lanes], sizeof negated_upper);
            centre[v] = 0.5F * lower - 0.5F * negated_upper;
            least = centre[v] < least ? centre[v] : least;
            negated_greatest = -centre[v] < negated_greatest ? -centre[v] : negated_greatest;
        }
        const float low = simd::least(least);
        const float scale = 2 * half_range / (-simd::least(negated_greatest) - low);
        const bool is_finite = scale > 0 && scale < std::numeric_limits<float>::max();
        for (std::size_t v = 0; v < vectors; ++v) {
            const simd::sixteen_i16 codes =
                is_finite ? simd::whole_i16((centre[v] - low) * scale - half_range) : simd::sixteen_i16{};
            std::memcpy(&centre_[axis][v * lanes], &codes, sizeof codes);
        }
    }

    /// Sets bit i if fewer than `number` centres on the axis are less than that of item i. Each centre is compared with
    /// 16 others at once, which is faster than sorting so few. The `Vectors` of 16 lanes that hold all centres stay in
    /// registers, for which their number must be constant: beginning with 1, it is doubled until it suffices.
    template <std::size_t Vectors>
    [[nodiscard]] inline std::uint64_t mask_by_vectors(std::int16_t number, std::size_t axis) const noexcept {
        if constexpr (Vectors * lanes < most)
            if (count_ > Vectors * lanes) return mask_by_vectors<2 * Vectors>(number, axis);
        std::array<simd::sixteen_i16, Vectors> centre;
        std::array<simd::sixteen_i16, Vectors> before{};
        std::memcpy(centre.data(), centre_[axis].data(), sizeof centre);
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t v = 0; v < Vectors; ++v) before[v] -= centre_[axis][i] < centre[v];  // true is -1
        std::uint64_t mask = 0;
        for (std::size_t v = 0; v < Vectors; ++v)
            mask |= std::uint64_t{simd::bits_of_sixteen(before[v] < number)} << v * lanes;
        return mask & ~std::uint64_t{0} >> (most - count_);  // without the padding
    }

    [[nodiscard]] static inline eight_floats lesser(eight_floats p, eight_floats q) noexcept { return p < q ? p : q; }
    [[nodiscard]] inline std::size_t vectors() const noexcept { return (count_ + width - 1) / width; }
    [[nodiscard]] static inline eight_floats load(const row& of, std::size_t vector) noexcept {
        return simd::load_eight<eight_floats>(&of[vector * width]);
    }
    [[nodiscard]] static inline double half_area(const std::array<eight_floats, 6>& least) noexcept {
        std::array<double, 3> length;
        for (std::size_t k = 0; k < 3; ++k)
            length[k] = -double{simd::least(least[k])} - double{simd::least(least[k + 3])};
        return length[0] * length[1] + length[1] * length[2] + length[2] * length[0];
    }

    alignas(64) std::array<row, 3> lower_;
    alignas(64) std::array<row, 3> negated_upper_;
    alignas(64) std::array<std::array<std::int16_t, most>, 3> centre_;  // in 16 bits
    std::size_t count_;
};

}  // namespace aabb
