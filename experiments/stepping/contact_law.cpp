module;
#include <Eigen/Geometry>

module aabblab.stepping;

import aabb.geometry;
import aabb.triangle.intersection;
import aabblab.vectors;
import :corners;

namespace aabblab {

namespace {

using Eigen::Vector3d;

Vector3d normal_of(const corners& t) {
    return (t[1] - t[0]).cross(t[2] - t[0]);
}

/// A vertex below a plane.
struct depth_of_vertex {
    std::uint32_t vertex;
    double depth;
    Vector3d normal;  // of length 1
};

/// Every vertex of a reported triangle of the second body below the plane of the triangle of the first, at it, or no
/// further above it than springs reach; a vertex that several pairs report as often.
std::vector<depth_of_vertex> depths_of(std::span<const aabb::contact> contacts, const placed_mesh& first,
                                       const placed_mesh& second, double rest) {
    std::vector<depth_of_vertex> all;
    for (const aabb::contact& c : contacts) {
        const corners plane = corners_of(first, c.triangle_a);
        const Vector3d normal = normal_of(plane);
        const double length = length_of(normal);
        if (length == 0) continue;
        const corners t = corners_of(second, c.triangle_b);
        for (std::size_t i = 0; i < 3; ++i)
            if (const double depth = -dot(normal, t[i] - plane[0]) / length; depth >= -rest)
                all.push_back({second.mesh->triangles[c.triangle_b][i], depth, normal * (1 / length)});
    }
    return all;
}

/// Leaves of what several pairs say of a vertex the deepest.
void keep_deepest_of_each(std::vector<depth_of_vertex>& all) {
    std::ranges::sort(all, [](const depth_of_vertex& a, const depth_of_vertex& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.depth > b.depth;
    });
    const auto repeated = std::ranges::unique(all, {}, &depth_of_vertex::vertex);
    all.erase(repeated.begin(), repeated.end());
}

void keep_deepest(std::vector<depth_of_vertex>& all) {
    const auto deepest = std::ranges::max_element(all, {}, &depth_of_vertex::depth);
    if (deepest != all.end()) all = {*deepest};
}

contact_force springs_at(const contact_law& law, std::span<const depth_of_vertex> all, const Vector3d& approach) {
    Vector3d force = Vector3d::Zero();
    double energy = 0;
    for (const depth_of_vertex& at : all) {
        const double compressed = at.depth + law.rest;
        force += at.normal * (law.stiffness * compressed - law.damping * dot(at.normal, approach));
        energy += law.stiffness * compressed * compressed / 2;
    }
    return {from_eigen(force), energy};
}

contact_force pressure(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                       const placed_mesh& second, const Vector3d& approach) {
    Vector3d area = Vector3d::Zero();  // of the second body's surface inside the first, along its outward normal
    std::optional<Vector3d> origin;
    for (const aabb::contact& c : contacts) {
        const aabb::triangle_intersection common =
            aabb::intersection_of(first.triangle(c.triangle_a), second.triangle(c.triangle_b));
        if (common.size != 2) continue;
        if (!origin) origin = in_eigen(common.corners[0]);
        const Vector3d p = in_eigen(common.corners[0]) - *origin;
        const Vector3d q = in_eigen(common.corners[1]) - *origin;
        // The part inside the first body lies to the left of the curve, seen from outside the second.
        const Vector3d along =
            normal_of(corners_of(second, c.triangle_b)).cross(normal_of(corners_of(first, c.triangle_a)));
        area += p.cross(q) * (dot(q - p, along) < 0 ? -0.5 : 0.5);
    }
    const double size = length_of(area);
    if (size == 0) return {};
    return {from_eigen(area * -(law.stiffness + law.damping * dot(area, approach) / size)), 0};
}

}  // namespace

aabb::triangle3d placed_mesh::triangle(std::uint32_t index) const {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(pose.rotation.data());
    const aabb::triangle3f local = mesh->triangle(index);
    const auto at = [&](int i) {
        return from_eigen(product(rotation, in_eigen(local[i])) + in_eigen(pose.translation));
    };
    return {{at(0), at(1), at(2)}};
}

contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                       const placed_mesh& second, const aabb::vec3d& approach) {
    if (law.geometry == contact_geometry::shared_volume)
        return pressure(law, contacts, first, second, in_eigen(approach));
    std::vector<depth_of_vertex> depths = depths_of(contacts, first, second, law.rest);
    if (law.geometry == contact_geometry::deepest_vertex)
        keep_deepest(depths);
    else
        keep_deepest_of_each(depths);
    return springs_at(law, depths, in_eigen(approach));
}

}  // namespace aabblab
