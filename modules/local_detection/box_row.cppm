module;
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:box_row;

import aabb.geometry;
import aabb.simd;
import :eight_boxes;

export namespace aabb {

/// A box in a row of numbers, so that one comparison tells whether two meet.
class box_row {
public:
    box_row() = default;
    /// The box of all eight; in the places from `count` on one of them must be repeated.
    explicit inline box_row(const eight_boxes& boxes) noexcept {
        simd::store_eight(least_.data(), simd::least_of_rows(boxes.lower[0].data(), boxes.upper[0].data()));
    }

    [[nodiscard]] inline bool meets(const box_row& other) const noexcept {
        const auto theirs = simd::load_eight<simd::eight_floats>(other.least_.data());
        const simd::eight_floats greatest = -__builtin_shufflevector(theirs, theirs, 3, 4, 5, 0, 1, 2, 6, 7);
        constexpr std::uint32_t six = 0x3f;
        return (simd::bits_of_eight(simd::load_eight<simd::eight_floats>(least_.data()) <= greatest) & six) == six;
    }

    [[nodiscard]] inline box bounds() const noexcept {
        box b;
        for (int k = 0; k < 3; ++k) {
            b.min[k] = least_[static_cast<std::size_t>(k)];
            b.max[k] = -least_[static_cast<std::size_t>(k) + 3];
        }
        return b;
    }

private:
    alignas(32) std::array<float, 8> least_{};  // the lower bounds, then the upper ones negated, then anything
};

}  // namespace aabb
