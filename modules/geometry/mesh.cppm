export module aabb.geometry:mesh;

import aabb.std;
import :box;
import :vertex_frame;

export namespace aabb {

/// A triangle mesh: vertices, and triangles of three vertex indices, both in file order. Trees, boxes and inexact tests
/// see floats. Exact tests decide on `given` if any vertex is not a float (`set_vertices`).
struct mesh {
    std::vector<vec3f> vertices;  ///< in `frame`
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<vec3d> given = {};  ///< the vertices as given, if any is not a float; else empty
    vertex_frame frame = {};

    [[nodiscard]] inline std::uint32_t triangle_count() const noexcept {
        return static_cast<std::uint32_t>(triangles.size());
    }

    [[nodiscard]] inline triangle3f triangle(std::uint32_t index) const noexcept {
        const auto& t = triangles[index];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }

    [[nodiscard]] inline vec3d given_vertex(std::size_t index) const noexcept {
        if (given.empty()) return in_double(vertices[index]);
        return given[index];
    }
    [[nodiscard]] inline triangle3d given_triangle(std::uint32_t index) const noexcept {
        if (given.empty()) return in_double(triangle(index));
        const auto& t = triangles[index];
        return {given[t[0]], given[t[1]], given[t[2]]};
    }
};

/// Sets the vertices of a mesh that has its triangles. If all vertices that these use are floats, only floats are
/// stored.
/// @param vertices finite where a triangle uses them
inline void set_vertices(mesh& m, std::vector<vec3d> vertices) {
    std::vector<bool> is_used(vertices.size());
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle)
            if (v < is_used.size()) is_used[v] = true;
    std::vector<vec3d> used;
    bool are_floats = true;
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (is_used[v]) {
            used.push_back(vertices[v]);
            for (const double x : vertices[v].at) are_floats &= x == static_cast<double>(static_cast<float>(x));
        }
    m.frame = are_floats ? vertex_frame{} : vertex_frame::around(used);
    m.vertices.resize(vertices.size());
    constexpr float greatest = std::numeric_limits<float>::max();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        m.vertices[v] = m.frame(vertices[v]);
        // A vertex that no triangle uses may lie anywhere.
        for (int k = 0; k < 3; ++k)
            if (std::isfinite(vertices[v][k])) m.vertices[v][k] = std::clamp(m.vertices[v][k], -greatest, greatest);
    }
    m.given = are_floats ? std::vector<vec3d>() : std::move(vertices);
}

/// The box of the floats of vertices that triangles use.
[[nodiscard]] inline box bounds_of(const mesh& m) noexcept {
    box bounds = empty_box();
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) bounds = merged(bounds, bounds_of(m.triangle(t)));
    return bounds;
}

/// Trees mark leaves with the top bit of an index, so a mesh has fewer than 2^31 triangles.
inline constexpr std::size_t most_triangles = 0x7fffffff;

/// Rejects a mesh with no triangles or too many, with an index out of range, with a coordinate that is not finite, or
/// with floats that are not those of its given vertices.
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
    if (m.given.empty() && m.frame == vertex_frame{}) return;
    if (m.given.size() != m.vertices.size())
        throw input_error("the mesh has " + std::to_string(m.given.size()) + " given vertices, but " +
                          std::to_string(m.vertices.size()) + " floats; set_vertices sets both");
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle)
            if (m.frame(m.given[v]) != m.vertices[v])
                throw input_error("vertex " + std::to_string(v) +
                                  " is not the float of its given vertex; set_vertices sets both");
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
