#pragma once

#include "../boxes.hpp"
#include "../meshes.hpp"

namespace aabb {

/// Uniform in [low, high), the same with every standard library.
inline float uniform(std::mt19937& random, float low, float high) {
    return low + (high - low) * (static_cast<float>(random() >> 8) * 0x1p-24F);
}

/// The pairs that a local stage finds for two meshes.
inline std::vector<index_pair> pairs_of(local_stage& stage, const mesh& a, const pose& pose_a, const mesh& b,
                                        const pose& pose_b) {
    const std::uint32_t model_a = stage.add_model(a);
    const std::uint32_t model_b = stage.add_model(b);
    std::vector<index_pair> pairs;
    stage.all_pairs(model_a, pose_a, model_b, pose_b, pairs);
    return sorted(pairs);
}

/// Boxes of sizes up to `size` in a cube of side 10.
inline std::vector<box> random_boxes(std::mt19937& random, std::size_t count, float size) {
    std::vector<box> boxes(count);
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            b.min[k] = uniform(random, 0, 10);
            b.max[k] = b.min[k] + uniform(random, 0, size);
        }
    return boxes;
}

/// A rotation about an axis through the origin (Rodrigues), then a translation.
inline pose turned(vec3d axis, double angle, vec3d shift) {
    const double length = std::sqrt(dot(axis, axis));
    const double x = axis[0] / length;
    const double y = axis[1] / length;
    const double z = axis[2] / length;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double d = 1 - c;
    return {{c + x * x * d, x * y * d - z * s, x * z * d + y * s, y * x * d + z * s, c + y * y * d, y * z * d - x * s,
             z * x * d - y * s, z * y * d + x * s, c + z * z * d},
            shift};
}

inline mesh one_triangle(const triangle3f& t) {
    return {{t[0], t[1], t[2]}, {{0, 1, 2}}};
}

/// n × n squares of side 1 in the plane z = 0, each cut into two triangles.
inline mesh grid(std::uint32_t n) {
    return sheet_of(
        n, [](std::uint32_t y, std::uint32_t x) -> vec3f { return {static_cast<float>(x), static_cast<float>(y), 0}; });
}

/// A unit sphere of `rings` rings of squares; those at the poles are cut into a triangle with and one without area.
inline mesh sphere(std::uint32_t rings) {
    mesh m;
    const std::uint32_t around = 2 * rings;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double down = std::numbers::pi * i / rings;
            const double turn = 2 * std::numbers::pi * j / around;
            const double radius = i == 0 || i == rings ? 0 : std::sin(down);
            m.vertices.push_back({static_cast<float>(radius * std::cos(turn)),
                                  static_cast<float>(radius * std::sin(turn)), static_cast<float>(std::cos(down))});
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

/// The cube from 0 to 1.
inline mesh unit_cube() {
    mesh m{{},
           {{0, 1, 3},
            {0, 3, 2},
            {4, 6, 7},
            {4, 7, 5},
            {0, 4, 5},
            {0, 5, 1},
            {2, 3, 7},
            {2, 7, 6},
            {0, 2, 6},
            {0, 6, 4},
            {1, 5, 7},
            {1, 7, 3}}};
    for (int i = 0; i < 8; ++i)
        m.vertices.push_back({static_cast<float>(i >> 2), static_cast<float>(i >> 1 & 1), static_cast<float>(i & 1)});
    return m;
}

struct mesh_case {
    const char* name;
    mesh a;
    pose pose_a;
    mesh b;
    pose pose_b;
};

/// Pairs of meshes from general to awkward positions.
inline std::vector<mesh_case> mesh_cases() {
    const pose still;
    return {
        {"spheres", sphere(8), still, sphere(7), turned({1, 2, 3}, 0.7, {0.9, 0.3, -0.2})},
        {"spheres, both turned", sphere(7), turned({0, 1, 1}, 2.1, {5, 5, 5}), sphere(8),
         turned({3, -1, 1}, 1.2, {5.5, 5.9, 5.2})},
        {"spheres, far out", sphere(6), turned({0, 1, 0}, 0.4, {1e6, 0, -1e6}), sphere(7),
         turned({0, 1, 3}, 1.4, {1e6 + 0.7, 0.1, -1e6})},
        {"a sphere on itself", sphere(6), still, sphere(6), still},
        {"tetrahedra, corner in corner", tetrahedron(1), still, tetrahedron(1),
         turned({1, 1, 1}, 0.5, {0.2, 0.2, 0.2})},
        {"tetrahedra that share a face", tetrahedron(1), still, tetrahedron(1), turned({0, 1, 0}, 0, {0, 0, 0})},
        {"tetrahedra that share a corner", tetrahedron(1), still, tetrahedron(1), turned({0, 0, 1}, 0, {1, 0, 0})},
        {"grids that cross", grid(5), still, grid(5), turned({1, 0, 0}, std::numbers::pi / 3, {0.25, 1.5, -1.3})},
        {"grids that cross on a line of vertices", grid(4), still, grid(4), {{1, 0, 0, 0, 0, -1, 0, 1, 0}, {0, 2, -2}}},
        {"grids in one plane", grid(3), still, grid(3), turned({0, 0, 1}, 0, {0.5, 0.5, 0})},
        {"a grid through a sphere", grid(4), {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {-2, -2, 0}}, sphere(8), still},
        {"apart", sphere(4), still, sphere(4), turned({1, 0, 0}, 1, {5, 0, 0})},
    };
}

}  // namespace aabb
