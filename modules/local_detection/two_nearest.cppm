module;
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:two_nearest;

import aabb.simd;
import :box_codes;
import :eight_boxes;
import :wide_node;

export namespace aabb {

/// Pairs, 8 j + i for child i of a node and box j, whose centres are the least distance apart.
struct nearest_places {
    std::uint32_t first;
    std::uint32_t second;  ///< the first again where there is no other
};

/// Of the pairs in `met`, bit 8 j + i for child i and box j; not all may be 0. All sixty-four distances are taken, so
/// that they need not wait for what met.
[[nodiscard]] inline nearest_places two_nearest(std::uint64_t met, const wide_node& node,
                                                const eight_boxes& boxes) noexcept {
    // Which of two as near comes first may hang on how distances are rounded; no answer does.
#pragma clang fp contract(fast)
    std::array<simd::eight_floats, 3> of_node;
    std::array<eight_boxes::row, 3> of_boxes;
    const auto floats_of = [](const box_codes::row& codes) {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_floats);
    };
    for (std::size_t k = 0; k < 3; ++k) {
        // Twice the coordinates of the centres.
        const auto step = static_cast<float>(node.step(k));
        const float twice_origin = 2 * static_cast<float>(node.origin[k]) + 255;
        of_node[k] = (floats_of(node.planes.lower[k]) - floats_of(node.planes.upper[k]) + twice_origin) * step;
        simd::store_eight(of_boxes[k].data(), simd::load_eight<simd::eight_floats>(boxes.lower[k].data()) +
                                                  simd::load_eight<simd::eight_floats>(boxes.upper[k].data()));
    }
    // Floats that are not negative are in the order of their bits; the last six make room for the pair. What is not a
    // number comes after all that are.
    constexpr simd::eight_words places{0, 1, 2, 3, 4, 5, 6, 7};
    constexpr simd::eight_words none = ~simd::eight_words{};
    simd::eight_words least = none;  // of each column
    simd::eight_words next = none;
    for (std::uint32_t j = 0; j < eight_boxes::most; ++j) {
        simd::eight_floats distance{};
        for (std::size_t k = 0; k < 3; ++k) {
            const simd::eight_floats way = of_node[k] - of_boxes[k][j];
            distance += way * way;
        }
        const simd::eight_words key = (__builtin_bit_cast(simd::eight_words, distance) & ~63U) | places | 8 * j;
        const simd::eight_words asked = key | ~simd::flags_of_eight(static_cast<std::uint8_t>(met >> (8 * j)));
        next = __builtin_elementwise_min(next, __builtin_elementwise_max(least, asked));
        least = __builtin_elementwise_min(least, asked);
    }
    const std::uint32_t nearest = __builtin_reduce_min(least);
    const std::uint32_t second = __builtin_reduce_min(least == nearest ? next : least);
    return {nearest & 63U, (second == none[0] ? nearest : second) & 63U};
}

}  // namespace aabb
