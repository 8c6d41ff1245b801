module;
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

/// Small meshes that scenes are made of.
module aabb.extreme:bodies;

import aabb.geometry;

namespace aabb {

/// Each triangle with corners of its own.
[[nodiscard]] inline mesh soup_of(const std::vector<triangle3f>& triangles) {
    mesh m;
    for (const triangle3f& t : triangles) {
        const auto first = static_cast<std::uint32_t>(m.vertices.size());
        for (const vec3f& corner : t.corner) m.vertices.push_back(corner);
        m.triangles.push_back({first, first + 1, first + 2});
    }
    return m;
}

/// The cube from 0 to 2, each face cut into 8 triangles; corners are whole numbers.
[[nodiscard]] inline mesh cube() {
    mesh m;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int u = 0; u < 2; ++u)
                for (int v = 0; v < 2; ++v) {
                    const auto first = static_cast<std::uint32_t>(m.vertices.size());
                    for (int corner = 0; corner < 4; ++corner) {
                        vec3f p{};
                        p[axis] = static_cast<float>(2 * side);
                        p[(axis + 1) % 3] = static_cast<float>(u + corner % 2);
                        p[(axis + 2) % 3] = static_cast<float>(v + (corner > 1 ? 1 : 0));
                        m.vertices.push_back(p);
                    }
                    m.triangles.push_back({first, first + 1, first + 2});
                    m.triangles.push_back({first + 1, first + 3, first + 2});
                }
    return m;
}

/// About the origin, of `rings` rings; of the squares at the poles one half has no area.
[[nodiscard]] inline mesh ball(std::uint32_t rings, double radius) {
    mesh m;
    const std::uint32_t around = 2 * rings;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double down = std::numbers::pi * i / rings;
            const double turn = 2 * std::numbers::pi * j / around;
            const double out = i == 0 || i == rings ? 0 : radius * std::sin(down);
            m.vertices.push_back({static_cast<float>(out * std::cos(turn)), static_cast<float>(out * std::sin(turn)),
                                  static_cast<float>(radius * std::cos(down))});
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const std::uint32_t p = i * around + j;
            const std::uint32_t q = i * around + (j + 1) % around;
            m.triangles.push_back({p, p + around, q});
            m.triangles.push_back({q, p + around, q + around});
        }
    return m;
}

/// A turn about z by an angle, in double, then a shift.
[[nodiscard]] inline pose turned(double angle, const vec3d& shift) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {{c, -s, 0, s, c, 0, 0, 0, 1}, shift};
}

}  // namespace aabb
