module;
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

/// What a balanced build moves about.
export module aabb.build.balanced_item;

import aabb.geometry;
import aabb.simd;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// A triangle on its way, as a vector.
struct alignas(32) balanced_item {
    std::array<float, 3> lower;
    std::uint32_t triangle;
    std::array<float, 3> negated_upper;  // so that both grow downward
    std::uint32_t unused;

    /// Never beyond the range of float.
    [[nodiscard]] inline float centre(std::size_t axis) const noexcept {
        return 0.5F * lower[axis] - 0.5F * negated_upper[axis];
    }
    /// Along each axis; then numbers of no account. The triangle's is no float: products with one may be slow.
    [[nodiscard]] inline simd::eight_floats centres() const noexcept {
        const auto bounds = std::bit_cast<simd::eight_floats>(*this);
        const auto half = 0.5F * __builtin_shufflevector(bounds, bounds, 0, 1, 2, 2, 4, 5, 6, 6);
        return half - __builtin_shufflevector(half, half, 4, 5, 6, 7, 0, 1, 2, 3);
    }
};

/// In the order of centres along an axis; ties go by triangle, so that it is clear who goes to which side.
struct centre_order {
    std::size_t axis;

    [[nodiscard]] inline bool operator()(const balanced_item& p, const balanced_item& q) const noexcept {
        const float at_p = p.centre(axis);
        const float at_q = q.centre(axis);
        return at_p != at_q ? at_p < at_q : p.triangle < q.triangle;
    }
};

/// The box of several items. What stands in the places of their numbers is nobody's.
class item_bounds {
public:
    inline void take(const balanced_item& one) noexcept { at_ = lesser(one); }
    inline void take(const item_bounds& other) noexcept { at_ = other.at_ < at_ ? other.at_ : at_; }
    /// Two in turn, of which neither waits for the one before.
    inline void take(std::span<const balanced_item> items) noexcept {
        item_bounds odd;
        std::size_t i = 0;
        for (; i + 1 < items.size(); i += 2) {
            take(items[i]);
            odd.take(items[i + 1]);
        }
        if (i < items.size()) take(items[i]);
        take(odd);
    }
    /// Without a branch.
    inline void take_if(bool wanted, const balanced_item& one) noexcept {
        const simd::eight_words every = simd::eight_words{} - std::uint32_t{wanted};
        at_ = every ? lesser(one) : at_;
    }
    [[nodiscard]] box as_box() const noexcept { return {{at_[0], at_[1], at_[2]}, {-at_[4], -at_[5], -at_[6]}}; }

private:
    [[nodiscard]] inline simd::eight_floats lesser(const balanced_item& one) const noexcept {
        const auto other = std::bit_cast<simd::eight_floats>(one);
        return other < at_ ? other : at_;
    }

    simd::eight_floats at_ = simd::eight_floats{} + std::numeric_limits<float>::infinity();
};

}  // namespace aabb
