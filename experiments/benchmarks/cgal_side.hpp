#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace aabblab {

/// The side of points with respect to a closed surface, by CGAL's Side_of_triangle_mesh with the kernel that its manual
/// uses, of exact predicates. In plain types and without modules, since clang 19 cannot combine these with CGAL's
/// headers for meshes.
class cgal_side {
public:
    using point = std::array<double, 3>;

    /// @throws std::logic_error if the triangles are no closed oriented manifold
    cgal_side(const std::vector<point>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles);
    ~cgal_side();

    [[nodiscard]] bool is_inside(const point& p) const;

private:
    struct construction;
    std::unique_ptr<construction> construction_;
};

}  // namespace aabblab
