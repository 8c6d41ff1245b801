export module aabb.geometry:mesh;

import aabb.std;
import :box;

export namespace aabb {

/// A triangle mesh: float vertices, and triangles of three vertex indices, both in file order.
struct mesh {
    std::vector<vec3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    [[nodiscard]] inline std::uint32_t triangle_count() const noexcept {
        return static_cast<std::uint32_t>(triangles.size());
    }

    [[nodiscard]] inline triangle3f triangle(std::uint32_t index) const noexcept {
        const auto& t = triangles[index];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
};

/// The box of the vertices that triangles use.
[[nodiscard]] inline box bounds_of(const mesh& m) noexcept {
    box bounds = empty_box();
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) bounds = merged(bounds, bounds_of(m.triangle(t)));
    return bounds;
}

/// Trees mark leaves with the top bit of an index, so a mesh has fewer than 2^31 triangles.
inline constexpr std::size_t most_triangles = 0x7fffffff;

/// Rejects a mesh with no triangles or too many, an index out of range, or a coordinate that is not finite.
/// @throws input_error with the first faulty triangle or vertex
inline void require_valid(const mesh& m) {
    if (m.triangles.empty()) throw input_error("the mesh has no triangles");
    if (m.triangles.size() > most_triangles) throw input_error("the mesh has more than 2^31 - 1 triangles");
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
        for (const std::uint32_t v : m.triangles[t])
            if (v >= m.vertices.size())
                throw input_error("triangle " + std::to_string(t) + " uses vertex " + std::to_string(v) +
                                  ", but there are only " + std::to_string(m.vertices.size()) + " vertices");
    for (std::size_t v = 0; v < m.vertices.size(); ++v)
        if (!is_finite(m.vertices[v]))
            throw input_error("vertex " + std::to_string(v) + " has a coordinate that is not finite");
}

/// Rejects a deformed mesh that is invalid or whose number of triangles has changed.
/// @throws input_error as `require_valid`, or with both numbers
inline void require_still_valid(const mesh& m, std::size_t triangles) {
    require_valid(m);
    if (m.triangles.size() != triangles)
        throw input_error("a deforming mesh must keep its triangles: there were " + std::to_string(triangles) +
                          ", now there are " + std::to_string(m.triangles.size()));
}

}  // namespace aabb
