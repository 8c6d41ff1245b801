#include "cgal_side.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <optional>
#include <stdexcept>

namespace aabblab {

namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface_mesh = CGAL::Surface_mesh<kernel::Point_3>;

}  // namespace

struct cgal_side::construction {
    surface_mesh surface;
    std::optional<CGAL::Side_of_triangle_mesh<surface_mesh, kernel>> side_of;
};

cgal_side::cgal_side(const std::vector<point>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
    : construction_(std::make_unique<construction>()) {
    surface_mesh& surface = construction_->surface;
    std::vector<surface_mesh::Vertex_index> added;
    for (const auto& [x, y, z] : vertices) added.push_back(surface.add_vertex(kernel::Point_3(x, y, z)));
    for (const auto& [p, q, r] : triangles)
        if (surface.add_face(added[p], added[q], added[r]) == surface_mesh::null_face())
            throw std::logic_error("CGAL rejects a triangle of the surface");
    if (!CGAL::is_closed(surface)) throw std::logic_error("the surface is not closed");
    construction_->side_of.emplace(surface);
}

cgal_side::~cgal_side() = default;

bool cgal_side::is_inside(const point& p) const {
    return (*construction_->side_of)(kernel::Point_3(p[0], p[1], p[2])) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace aabblab
