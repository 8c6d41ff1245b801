module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

module aabblab.stepping;

import aabb.geometry;
import aabb.triangle.intersection;

namespace aabblab {

namespace {

using aabb::vec3d;

vec3d scaled(const vec3d& v, double by) {
    return {v[0] * by, v[1] * by, v[2] * by};
}

double length_of(const vec3d& v) {
    return std::sqrt(dot(v, v));
}

vec3d normal_of(const aabb::triangle3d& t) {
    return cross(t[1] - t[0], t[2] - t[0]);
}

/// A vertex below a plane.
struct depth_of_vertex {
    std::uint32_t vertex;
    double depth;
    vec3d normal;  // of length 1
};

/// Every vertex of a reported triangle of the second body below the plane of the triangle of the first, at it, or no
/// further above it than springs reach; a vertex that several pairs report as often.
std::vector<depth_of_vertex> depths_of(std::span<const aabb::contact> contacts, const placed_mesh& first,
                                       const placed_mesh& second, double rest) {
    std::vector<depth_of_vertex> all;
    for (const aabb::contact& c : contacts) {
        const aabb::triangle3d plane = first.triangle(c.triangle_a);
        const vec3d normal = normal_of(plane);
        const double length = length_of(normal);
        if (length == 0) continue;
        const aabb::triangle3d t = second.triangle(c.triangle_b);
        for (int i = 0; i < 3; ++i)
            if (const double depth = -dot(normal, t[i] - plane[0]) / length; depth >= -rest)
                all.push_back({second.mesh->triangles[c.triangle_b][static_cast<std::size_t>(i)], depth,
                               scaled(normal, 1 / length)});
    }
    return all;
}

void add_spring(contact_force& sum, const contact_law& law, const depth_of_vertex& at, const vec3d& approach) {
    const double compressed = at.depth + law.rest;
    const double push = law.stiffness * compressed - law.damping * dot(at.normal, approach);
    for (int k = 0; k < 3; ++k) sum.force[k] += push * at.normal[k];
    sum.energy += law.stiffness * compressed * compressed / 2;
}

contact_force spring_at_deepest(const contact_law& law, std::span<const depth_of_vertex> all, const vec3d& approach) {
    contact_force sum;
    const auto deepest = std::ranges::max_element(all, {}, &depth_of_vertex::depth);
    if (deepest != all.end()) add_spring(sum, law, *deepest, approach);
    return sum;
}

contact_force springs_at_each(const contact_law& law, std::vector<depth_of_vertex> all, const vec3d& approach) {
    contact_force sum;
    // Of what several pairs say of a vertex the deepest counts.
    std::ranges::sort(all, [](const depth_of_vertex& a, const depth_of_vertex& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.depth > b.depth;
    });
    const auto repeated = std::ranges::unique(all, {}, &depth_of_vertex::vertex);
    all.erase(repeated.begin(), repeated.end());
    for (const depth_of_vertex& at : all) add_spring(sum, law, at, approach);
    return sum;
}

contact_force pressure(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                       const placed_mesh& second, const vec3d& approach) {
    vec3d area{0, 0, 0};  // of the second body's surface inside the first, along its outward normal
    vec3d origin{0, 0, 0};
    bool begun = false;
    for (const aabb::contact& c : contacts) {
        const aabb::triangle3d s = first.triangle(c.triangle_a);
        const aabb::triangle3d t = second.triangle(c.triangle_b);
        const aabb::triangle_intersection common = aabb::intersection_of(s, t);
        if (common.size != 2) continue;
        if (!std::exchange(begun, true)) origin = common.corners[0];
        const vec3d p = common.corners[0] - origin;
        const vec3d q = common.corners[1] - origin;
        // The part inside the first body lies to the left of the curve, seen from outside the second.
        const double way = dot(q - p, cross(normal_of(t), normal_of(s))) < 0 ? -0.5 : 0.5;
        const vec3d swept = cross(p, q);
        for (int k = 0; k < 3; ++k) area[k] += way * swept[k];
    }
    contact_force sum;
    const double size = length_of(area);
    if (size == 0) return sum;
    const double push = law.stiffness + law.damping * dot(area, approach) / size;
    for (int k = 0; k < 3; ++k) sum.force[k] = -push * area[k];
    return sum;
}

}  // namespace

aabb::triangle3d placed_mesh::triangle(std::uint32_t index) const {
    const aabb::triangle3f local = mesh->triangle(index);
    aabb::triangle3d world{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const auto row = static_cast<std::size_t>(3 * k);
            world[i][k] = pose.rotation[row] * local[i][0] + pose.rotation[row + 1] * local[i][1] +
                          pose.rotation[row + 2] * local[i][2] + pose.translation[k];
        }
    return world;
}

contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                       const placed_mesh& second, const vec3d& approach) {
    if (law.geometry == contact_geometry::shared_volume) return pressure(law, contacts, first, second, approach);
    std::vector<depth_of_vertex> depths = depths_of(contacts, first, second, law.rest);
    return law.geometry == contact_geometry::deepest_vertex ? spring_at_deepest(law, depths, approach)
                                                            : springs_at_each(law, std::move(depths), approach);
}

}  // namespace aabblab
