#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

/// A closed surface at a pose [R t] in exact world coordinates R v + t, for CGAL's Side_of_triangle_mesh. In plain
/// types and without modules, since clang 19 cannot combine these with CGAL's headers for meshes.
class cgal_surface {
public:
    using point = std::array<double, 3>;
    enum class side : std::uint8_t { outside, on_surface, inside };

    struct pose {
        std::array<double, 9> rotation;  ///< by rows
        point translation;
    };

    /// @param triangles those with two equal corners are left out, since they add nothing to the surface
    cgal_surface(const std::vector<std::array<point, 3>>& triangles, const pose& at);
    cgal_surface(cgal_surface&&) noexcept;
    ~cgal_surface();

    /// Whether CGAL accepts the surface: each edge joins two triangles in opposite directions, and each vertex belongs
    /// to one fan of triangles. Vertices at one position are one vertex.
    [[nodiscard]] bool is_accepted() const;
    /// The side on which a vertex of a mesh at a pose lies; the surface must be accepted.
    [[nodiscard]] side side_of(const point& vertex, const pose& at) const;

private:
    struct construction;
    std::unique_ptr<construction> construction_;
};
