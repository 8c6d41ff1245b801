#include "side_of_mesh.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <map>

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using surface_mesh = CGAL::Surface_mesh<kernel::Point_3>;

/// R v + t without rounding.
kernel::Point_3 world_point(const cgal_surface::point& v, const cgal_surface::pose& at) {
    std::array<kernel::FT, 3> x;
    for (std::size_t i = 0; i < 3; ++i) {
        x[i] = kernel::FT(at.translation[i]);
        for (std::size_t j = 0; j < 3; ++j) x[i] += kernel::FT(at.rotation[3 * i + j]) * kernel::FT(v[j]);
    }
    return {x[0], x[1], x[2]};
}

}  // namespace

struct cgal_surface::construction {
    surface_mesh surface;
    bool is_accepted = true;
    std::unique_ptr<CGAL::Side_of_triangle_mesh<surface_mesh, kernel>> side_of;
};

cgal_surface::cgal_surface(const std::vector<std::array<point, 3>>& triangles, const pose& at)
    : construction_(std::make_unique<construction>()) {
    surface_mesh& surface = construction_->surface;
    std::map<point, surface_mesh::Vertex_index> vertices;  // by position
    for (const auto& corners : triangles) {
        std::array<surface_mesh::Vertex_index, 3> face;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& [x, y, z] = corners[i];
            const auto [entry, is_new] = vertices.try_emplace(point{x + 0.0, y + 0.0, z + 0.0});  // −0 is 0
            if (is_new) entry->second = surface.add_vertex(world_point(corners[i], at));
            face[i] = entry->second;
        }
        if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
        if (surface.add_face(face[0], face[1], face[2]) == surface_mesh::null_face())
            construction_->is_accepted = false;
    }
    construction_->is_accepted = construction_->is_accepted && surface.number_of_faces() > 0 &&
                                 CGAL::is_closed(surface) && CGAL::is_valid_polygon_mesh(surface);
    if (construction_->is_accepted)
        construction_->side_of = std::make_unique<CGAL::Side_of_triangle_mesh<surface_mesh, kernel>>(surface);
}

cgal_surface::cgal_surface(cgal_surface&&) noexcept = default;
cgal_surface::~cgal_surface() = default;

bool cgal_surface::is_accepted() const {
    return construction_->is_accepted;
}

cgal_surface::side cgal_surface::side_of(const point& vertex, const pose& at) const {
    switch ((*construction_->side_of)(world_point(vertex, at))) {
        case CGAL::ON_BOUNDED_SIDE: return side::inside;
        case CGAL::ON_UNBOUNDED_SIDE: return side::outside;
        default: return side::on_surface;
    }
}
