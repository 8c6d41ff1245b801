// CGAL's AABB trees. They have distances of points only, so that the distance of two meshes is the least of those of
// the vertices of either from the other: too great where two edges are nearest.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "peers.hpp"

import aabb.distance;

namespace aabblab {

namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using kernel_triangles = std::vector<kernel::Triangle_3>;
using primitive = CGAL::AABB_triangle_primitive<kernel, kernel_triangles::const_iterator>;

kernel::Point_3 in_kernel(const aabb::vec3d& p) {
    return {p[0], p[1], p[2]};
}

/// A mesh with a tree of its triangles.
class mesh_tree {
public:
    explicit mesh_tree(const aabb::mesh& m) : mesh_(m) {
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
            const aabb::triangle3d corners = m.given_triangle(t);
            triangles_.emplace_back(in_kernel(corners[0]), in_kernel(corners[1]), in_kernel(corners[2]));
        }
        tree_.rebuild(triangles_.cbegin(), triangles_.cend());
    }

    [[nodiscard]] const aabb::mesh& mesh() const { return mesh_; }
    void prepare_distances() { tree_.accelerate_distance_queries(); }

    /// The least squared distance of the vertices of another mesh at a pose.
    [[nodiscard]] double squared_distance(const aabb::mesh& other, const aabb::pose& at) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t v = 0; v < other.vertices.size(); ++v)
            least = std::min(least, tree_.squared_distance(in_kernel(moved(at, other.given_vertex(v)))));
        return least;
    }

    /// Passes the triangles that may be within d of a triangle to `visit`.
    template <class Visit>
    void each_near(const aabb::triangle3d& t, double d, const Visit& visit) const {
        const triangle_ball ball(t);
        const double radius = ball.radius + d;
        const auto& [x, y, z] = ball.centre.at;
        std::vector<kernel_triangles::const_iterator> near;
        tree_.all_intersected_primitives(
            CGAL::Bbox_3(x - radius, y - radius, z - radius, x + radius, y + radius, z + radius),
            std::back_inserter(near));
        for (const auto& triangle : near) visit(static_cast<std::uint32_t>(triangle - triangles_.begin()));
    }

private:
    const aabb::mesh& mesh_;
    kernel_triangles triangles_;
    CGAL::AABB_tree<CGAL::AABB_traits<kernel, primitive>> tree_;
};

}  // namespace

distance_peer cgal_distances() {
    const auto distance = [](const aabb::mesh& a, const aabb::mesh& b) -> distance_peer::measurement {
        const auto of_a = std::make_shared<mesh_tree>(a), of_b = std::make_shared<mesh_tree>(b);
        of_a->prepare_distances();
        of_b->prepare_distances();
        return [of_a, of_b](const aabb::pose& at) {
            return std::sqrt(std::min(of_a->squared_distance(of_b->mesh(), at),
                                      of_b->squared_distance(of_a->mesh(), inverse_of(at))));
        };
    };
    // Boxes around the triangles of B leave pairs that our test decides. (A Sphere_3 has no interior: triangles inside
    // do not intersect it.)
    const auto within = [](const aabb::mesh& a, const aabb::mesh& b) -> distance_peer::search {
        return [of_a = std::make_shared<mesh_tree>(a), &b](const aabb::pose& at, double d,
                                                           std::vector<aabb::index_pair>& pairs) {
            const aabb::pose_pair poses{{}, at};
            for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
                const aabb::triangle3d given = b.given_triangle(t);
                of_a->each_near({{moved(at, given[0]), moved(at, given[1]), moved(at, given[2])}}, d,
                                [&](std::uint32_t s) {
                                    if (aabb::are_within(poses, of_a->mesh().given_triangle(s), given, d))
                                        pairs.push_back({s, t});
                                });
            }
        };
    };
    return {.name = "cgal", .distance = distance, .within = within};
}

}  // namespace aabblab
