module;
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:child_overlaps;

import aabb.geometry;
import aabb.simd;
import :triangle_block;
import :wide_node;

export namespace aabb {

/// Which children of two nodes may meet, all sixty-four pairs at once: the boxes of B's children are taken into A's
/// frame, onto the grid of A's node, and grown to whole steps of it.
///
/// Bit 8 j + i stands for child i of A's node and child j of B's. A pair of children whose triangles meet is always
/// among them.
class child_overlaps {
public:
    explicit child_overlaps(const relative_pose& to_a) noexcept
        : turn_{to_a.turn(0), to_a.turn(1), to_a.turn(2)}, shift_(to_a.shift()), error_(to_a.image_error()) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < 3; ++j) rises_[k][j] = turn_[j][k] > 0;
    }

    /// In steps of A's grid, a plane of B's stands at base + Σ step_j * code_j. What rounding to float in the sums may
    /// cost is 6 times 2^-24 of their terms' magnitudes; 2^-20 of them covers that, and 2^-10 what is denormal.
    [[nodiscard]] inline std::uint64_t operator()(const wide_node& a, const wide_node& b) const noexcept {
#pragma clang fp contract(fast)
        const lanes steps_a = powers_of_two(-exponents(a));
        const lanes steps_b = powers_of_two(exponents(b));
        const lanes origin_b = origin(b) * steps_b;
        lanes base = shift_;
        lanes reach{};
        std::array<quarter, 3> step;
        for (int j = 0; j < 3; ++j) {
            base += turn_[j] * origin_b[j];
            const lanes one = turn_[j] * steps_b[j] * steps_a;
            reach += one < 0 ? -one : one;
            step[j] = __builtin_convertvector(one, quarter);
        }
        base = base * steps_a - origin(a);
        constexpr double most = 1e30;
        base = base > most ? lanes{} + most : base < -most ? lanes{} - most : base;
        const lanes grown =
            error_ * steps_a + 0x1p-20 * ((base < 0 ? -base : base) + double{wide_node::last_code} * reach) + 0x1p-10;
        // Codes times steps must not overflow.
        if (reach[0] > 1e18 || reach[1] > 1e18 || reach[2] > 1e18) return all_children(a, b);
        const quarter high = __builtin_convertvector(base + grown, quarter);
        const quarter low = __builtin_convertvector(wide_node::last_code - (base - grown), quarter);

        std::array<std::array<simd::eight_floats, 3>, 2> planes;
        for (std::size_t j = 0; j < 3; ++j) {
            planes[0][j] = floats_of(b.lower[j]);
            planes[1][j] = static_cast<float>(wide_node::last_code) - floats_of(b.upper[j]);
        }
        std::uint64_t met = all_children(a, b);
        for (std::size_t k = 0; k < 3; ++k) {
            simd::eight_floats up = simd::eight_floats{} + high[k];
            simd::eight_floats down = simd::eight_floats{} + low[k];
            for (std::size_t j = 0; j < 3; ++j) {
                up += step[j][k] * planes[rises_[k][j]][j];
                down -= step[j][k] * planes[1U - rises_[k][j]][j];
            }
            met &= simd::no_greater(a.lower[k].data(), simd::whole_bytes(up)) &
                   simd::no_greater(a.upper[k].data(), simd::whole_bytes(down));
        }
        return met;
    }

    /// By the boxes of B's triangles themselves, which are in A's frame: smaller than those of a node that is turned.
    [[nodiscard]] static inline std::uint64_t leaves(const wide_node& a, const triangle_block& of_b) noexcept {
        const lanes steps_a = powers_of_two(-exponents(a));
        const lanes origin_a = origin(a);
        std::uint64_t met = (~std::uint64_t{0} >> (64U - 8U * of_b.triangles)) & children_mask(a);
        // A product is exact, or beyond all codes, and rounding is monotone: no plane is rounded past a whole step.
        for (std::size_t k = 0; k < 3; ++k) {
            const auto steps = static_cast<float>(steps_a[k]);
            const auto first = static_cast<float>(origin_a[k]);
            const simd::eight_floats up = simd::load_eight<simd::eight_floats>(of_b.upper[k].data()) * steps - first;
            const simd::eight_floats down =
                wide_node::last_code - (simd::load_eight<simd::eight_floats>(of_b.lower[k].data()) * steps - first);
            met &= simd::no_greater(a.lower[k].data(), simd::whole_bytes(up)) &
                   simd::no_greater(a.upper[k].data(), simd::whole_bytes(down));
        }
        return met;
    }

private:
    using lanes = relative_pose::lanes;
    using quarter = float __attribute__((vector_size(16)));
    using longs = std::int64_t __attribute__((vector_size(32)));

    [[nodiscard]] static inline longs exponents(const wide_node& n) noexcept {
        using four_bytes = std::int8_t __attribute__((vector_size(4)));
        return __builtin_convertvector((four_bytes{n.exponent[0], n.exponent[1], n.exponent[2]}), longs);
    }
    [[nodiscard]] static inline lanes origin(const wide_node& n) noexcept {
        using four_words = std::int32_t __attribute__((vector_size(16)));
        return __builtin_convertvector((four_words{n.origin[0], n.origin[1], n.origin[2]}), lanes);
    }
    [[nodiscard]] static inline lanes powers_of_two(longs exponents) noexcept {
        return reinterpret_cast<lanes>((exponents + 1023) << 52);
    }
    [[nodiscard]] static inline simd::eight_floats floats_of(const wide_node::codes& codes) noexcept {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_floats);
    }
    [[nodiscard]] static inline std::uint64_t children_mask(const wide_node& a) noexcept {
        return (0xffU >> (8U - a.children)) * std::uint64_t{0x0101010101010101};
    }
    [[nodiscard]] static inline std::uint64_t all_children(const wide_node& a, const wide_node& b) noexcept {
        return (~std::uint64_t{0} >> (64U - 8U * b.children)) & children_mask(a);
    }

    std::array<lanes, 3> turn_;
    lanes shift_;
    lanes error_;
    std::array<std::array<std::uint8_t, 3>, 3> rises_{};
};

}  // namespace aabb
