module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.local_detection:nearest_few;

import aabb.simd;
import :box_codes;
import :eight_boxes;
import :wide_node;

export namespace aabb {

/// Of pairs, 8 j + i for child i of a node and box j, the two whose centres are the least distance apart, nearest
/// first: to be opened first where any pair of triangles will do. Others are hardly ever opened, so they are not
/// sorted.
class nearest_few {
public:
    static constexpr std::size_t most = 2;

    /// @param pairs the first `count` of them count, but whole eights are read
    nearest_few(std::span<const std::uint8_t> pairs, std::size_t count, const wide_node& node,
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
        // Floats that are not negative are in the order of their bits; the last six make room for the pair. What is not
        // a number comes after all that are.
        constexpr simd::eight_words lanes{0, 1, 2, 3, 4, 5, 6, 7};
        constexpr simd::eight_words none = ~simd::eight_words{};
        std::array<simd::eight_words, most> least;  // of each lane, the least first
        least.fill(none);
        for (std::size_t p = 0; p < count; p += 8) {
            const auto place =
                __builtin_convertvector(simd::load_eight<simd::eight_bytes>(&pairs[p]), simd::eight_words);
            simd::eight_floats distance{};
            for (std::size_t k = 0; k < 3; ++k) {
                const simd::eight_floats way =
                    simd::taken(of_node[k].data(), place) - simd::taken(of_boxes[k].data(), place >> 3);
                distance += way * way;
            }
            const simd::eight_words key = (__builtin_bit_cast(simd::eight_words, distance) & ~63U) | place;
            simd::eight_words greater = lanes < static_cast<std::uint32_t>(count - p) ? key : none;
            for (simd::eight_words& l : least) {
                const simd::eight_words lesser = __builtin_elementwise_min(l, greater);
                greater = __builtin_elementwise_max(l, greater);
                l = lesser;
            }
        }
        count_ = std::min(count, most);
        for (std::uint32_t& place : places_) {
            const std::uint32_t nearest = __builtin_reduce_min(least[0]);
            place = nearest & 63U;
            const auto taken = least[0] == nearest;
            for (std::size_t r = 0; r < most; ++r) least[r] = taken ? (r + 1 < most ? least[r + 1] : none) : least[r];
        }
    }

    [[nodiscard]] std::span<const std::uint32_t> places() const noexcept { return std::span(places_).first(count_); }

private:
    std::array<std::uint32_t, most> places_;
    std::size_t count_;
};

}  // namespace aabb
