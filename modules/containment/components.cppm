export module aabb.containment:components;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// A part of a surface that is connected by vertices. Vertices at one position are one vertex, as in `collide --self`,
/// so that a mesh need not be welded.
struct surface_component {
    std::uint32_t first_triangle = 0;
    std::uint32_t first_grouped = 0;  ///< its place in `surface_components::grouped`
    std::uint32_t triangles = 0;      ///< their number
    std::uint64_t open_edges = 0;     ///< edges of an odd number of triangles
    bool is_oriented = false;         ///< every edge is passed as often in either direction, so the component is closed
    int volume_sign = 0;              ///< the sign of the enclosed volume, exactly; 0 unless the component is oriented
    box bounds = empty_box();         ///< of the floats of its vertices

    /// Whether each line in general position crosses the surface an even number of times, so that an inside exists.
    [[nodiscard]] bool is_closed() const noexcept { return open_edges == 0; }
    /// Whether the normals of an oriented component point to its inside.
    [[nodiscard]] bool faces_inward() const noexcept { return volume_sign < 0; }
};

struct surface_components {
    std::vector<surface_component> parts;     ///< in the order of their first triangles
    std::vector<std::uint32_t> of_triangles;  ///< by triangle, the index of its component
    std::vector<std::uint32_t> grouped;       ///< the triangles by component
    std::vector<std::uint32_t> positions;     ///< by vertex that a triangle uses, the least vertex at its position

    /// The triangles of a component, ascending.
    [[nodiscard]] std::span<const std::uint32_t> triangles_of(std::uint32_t component) const noexcept {
        return std::span(grouped).subspan(parts[component].first_grouped, parts[component].triangles);
    }
};

/// The connected components of a mesh. An edge joins two positions; triangles without area have edges, too, so that
/// they can close a surface. Takes O(n log n) time.
/// @param m valid (`require_valid`)
[[nodiscard]] surface_components components_of(const mesh& m);

}  // namespace aabb
