module;
#include <array>
#include <cstdint>

module aabblab.stiff;

import :shapes;
import aabb.geometry;

namespace aabblab {

aabb::mesh octahedron(float radius) {
    const float r = radius;
    return {{{r, 0, r}, {0, r, r}, {-r, 0, r}, {0, -r, r}, {0, 0, 2 * r}, {0, 0, 0}},
            {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
}

aabb::mesh floor_of(float side, std::uint32_t n) {
    aabb::mesh m;
    const auto at = [&](std::uint32_t i) { return side * (static_cast<float>(i) / static_cast<float>(n) - 0.5F); };
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) m.vertices.push_back({at(x), at(y), 0});
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t corner = y * (n + 1) + x;
            m.triangles.push_back({corner, corner + 1, corner + n + 2});
            m.triangles.push_back({corner, corner + n + 2, corner + n + 1});
        }
    return m;
}

aabb::mesh hanging_pyramid(float height, float side) {
    const float s = side / 2;
    return {{{0, 0, 0}, {-s, -s, height}, {s, -s, height}, {s, s, height}, {-s, s, height}},
            {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}}};
}

aabb::mesh slab(float side, float thickness) {
    aabb::mesh m;
    for (const float z : {-thickness / 2, thickness / 2})
        for (const auto& [x, y] : std::array<std::array<float, 2>, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}})
            m.vertices.push_back({x * side / 2, y * side / 2, z});
    m.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                   {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    return m;
}

}  // namespace aabblab
