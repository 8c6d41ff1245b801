#pragma once

#include "testing.hpp"

#include "sheets.hpp"

/// A tetrahedron in the corner of a cube of that edge.
inline aabb::mesh tetrahedron(float edge) {
    return {{{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {0, 0, edge}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

[[nodiscard]] inline aabb::pose shifted(const aabb::vec3d& by) {
    aabb::pose p;
    p.translation = by;
    return p;
}

/// The test sets poses and vertices itself.
class manual_scene final : public aabb::mesh_scene {
public:
    manual_scene(std::vector<aabb::mesh> given_meshes, std::vector<std::uint32_t> objects) {
        meshes = std::move(given_meshes);
        mesh_of = std::move(objects);
    }
    [[nodiscard]] std::size_t frames() const override { return 0; }
    bool next(std::vector<aabb::pose>&) override { return false; }
    [[nodiscard]] bool deforms(std::uint32_t m) const override { return m == soft; }

    std::uint32_t soft = 0xffffffff;
};

/// Adds a triangle with vertices of its own.
inline void add_triangle(aabb::mesh& m, const aabb::vec3f& p, const aabb::vec3f& q, const aabb::vec3f& r) {
    const std::uint32_t first = static_cast<std::uint32_t>(m.vertices.size());
    m.vertices.insert(m.vertices.end(), {p, q, r});
    m.triangles.push_back({first, first + 1, first + 2});
}

/// The same triangles with renumbered vertices.
inline aabb::mesh numbered_backwards(aabb::mesh m) {
    std::ranges::reverse(m.vertices);
    for (auto& t : m.triangles)
        for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(m.vertices.size()) - 1 - v;
    return m;
}

inline aabb::mesh ripples(std::uint32_t n) {
    return sheet_of(n, [](std::uint32_t i, std::uint32_t j) -> aabb::vec3f {
        return {static_cast<float>(i), static_cast<float>(j), std::sin(static_cast<float>(i + 2 * j))};
    });
}
