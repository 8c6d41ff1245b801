module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

export module aabb.local_detection:nearest_pair;

import aabb.simd;
import :box_codes;
import :eight_boxes;
import :wide_node;

export namespace aabb {

/// Which of these pairs, 8 j + i for child i of the node and box j, has the nearest centres: the one to open first
/// where any pair of triangles will do.
[[nodiscard]] inline std::size_t nearest_pair(std::span<const std::uint8_t> pairs, const wide_node& node,
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
    std::size_t nearest = 0;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        float distance = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float way = of_node[k][pairs[p] & 7U] - of_boxes[k][pairs[p] >> 3U];
            distance += way * way;
        }
        if (distance < least) {
            least = distance;
            nearest = p;
        }
    }
    return nearest;
}

}  // namespace aabb
