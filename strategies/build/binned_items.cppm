module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

/// Across which axis many triangles are best split.
export module aabb.build.binned_items;

import aabb.geometry;
import aabb.simd;
import aabb.build.balanced_item;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// Some items in bins along each axis, by their centres: how large both sides of a split are is known to a bin.
class binned_items {
public:
    /// So many are as good as all: trees of them are searched as fast.
    static constexpr std::size_t most = 256;

    /// Every so many of `items`, which must outlive these.
    /// @param bounds box of all
    binned_items(std::span<const balanced_item> items, std::size_t step, const box& bounds) noexcept
        : items_(items), step_(step) {
        eight_floats low{};
        eight_floats scale{};
        for (int k = 0; k < 3; ++k) {
            low[k] = bounds.min[k];
            const float edge = bounds.max[k] - bounds.min[k];
            scale[k] = edge > 0 ? bins / edge : 0;
        }
        for (std::size_t i = 0; i < items.size(); i += step, ++count_) {
            const simd::eight_bytes bin = simd::whole_bytes((items[i].centres() - low) * scale);
            for (std::size_t k = 0; k < 3; ++k) {
                bin_[k][count_] = bin[k];
                ++in_bin_[k][bin[k]];
            }
        }
    }

    /// Along each axis the sum over both sides of their box's area times their number, where about so many go to the
    /// left.
    [[nodiscard]] std::array<double, 3> costs(std::size_t left) const noexcept {
        std::array<std::size_t, 3> end{};
        std::array<std::size_t, 3> in_left{};
        for (std::size_t k = 0; k < 3; ++k)
            while (end[k] < bins && in_left[k] + in_bin_[k][end[k]] / 2U < left) in_left[k] += in_bin_[k][end[k]++];
        std::array<item_bounds, 3> left_sides;
        std::array<item_bounds, 3> right_sides;
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const bool is_left = bin_[k][i] < end[k];
                left_sides[k].take_if(is_left, items_[step_ * i]);
                right_sides[k].take_if(!is_left, items_[step_ * i]);
            }
        const auto cost = [](const item_bounds& side, std::size_t number) {
            return number == 0 ? 0 : surface_area(side.as_box()) * static_cast<double>(number);
        };
        std::array<double, 3> both;
        for (std::size_t k = 0; k < 3; ++k)
            both[k] = cost(left_sides[k], in_left[k]) + cost(right_sides[k], count_ - in_left[k]);
        return both;
    }

private:
    using eight_floats = simd::eight_floats;
    static constexpr std::size_t bins = 255;  // as whole bytes reach

    std::span<const balanced_item> items_;
    std::size_t step_;
    std::size_t count_ = 0;
    std::array<std::array<std::uint8_t, most>, 3> bin_;
    std::array<std::array<std::uint16_t, bins>, 3> in_bin_{};
};

}  // namespace aabb
