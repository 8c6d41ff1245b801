module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

export module aabb.local_detection:nearest_last;

import aabb.simd;
import :box_codes;
import :eight_boxes;
import :wide_node;

export namespace aabb {

/// Puts these pairs, 8 j + i for child i of the node and box j, in order of the distance between the centres, the
/// nearest last: the order in which to open them where any pair of triangles will do.
/// @param pairs whole eights of them are read
inline void put_nearest_last(std::uint8_t* pairs, std::size_t count, const wide_node& node,
                             const eight_boxes& boxes) noexcept {
    std::array<eight_boxes::row, 3> of_node;
    std::array<eight_boxes::row, 3> of_boxes;
    const auto floats_of = [](const box_codes::row& codes) {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_floats);
    };
    for (std::size_t k = 0; k < 3; ++k) {
        // Twice the coordinates of the centres.
        const auto step = static_cast<float>(node.step(k));
        const float twice_origin = 2 * static_cast<float>(node.origin[k]) + 255;
        const simd::eight_floats codes = floats_of(node.planes.lower[k]) - floats_of(node.planes.upper[k]);
        simd::store_eight(of_node[k].data(), (codes + twice_origin) * step);
        simd::store_eight(of_boxes[k].data(), simd::load_eight<simd::eight_floats>(boxes.lower[k].data()) +
                                                  simd::load_eight<simd::eight_floats>(boxes.upper[k].data()));
    }
    // Floats that are not negative are in the order of their bits; the last six make room for the pair.
    std::array<std::uint32_t, 64> keys;
    for (std::size_t p = 0; p < count; p += 8) {
        const auto place = __builtin_convertvector(simd::load_eight<simd::eight_bytes>(&pairs[p]), simd::eight_words);
        simd::eight_floats distance{};
        for (std::size_t k = 0; k < 3; ++k) {
            const simd::eight_floats way =
                simd::taken(of_node[k].data(), place) - simd::taken(of_boxes[k].data(), place >> 3);
            distance += way * way;
        }
        simd::store_eight(&keys[p], (__builtin_bit_cast(simd::eight_words, distance) & ~63U) | place);
    }
    std::sort(keys.begin(), keys.begin() + count, std::greater{});
    for (std::size_t p = 0; p < count; ++p) pairs[p] = static_cast<std::uint8_t>(keys[p] & 63U);
}

}  // namespace aabb
