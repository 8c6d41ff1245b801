module;
#include <Eigen/Geometry>

module aabblab.stepping;

import aabb.triangle.intersection;
import aabblab.vectors;

namespace aabblab {

namespace {

using Eigen::Vector3d;
using corners = std::array<Vector3d, 3>;

/// The corners of a triangle in world coordinates.
corners corners_of(const placed_mesh& m, std::uint32_t triangle) {
    const auto t = m.triangle(triangle);
    return {in_eigen(t[0]), in_eigen(t[1]), in_eigen(t[2])};
}

Vector3d normal_of(const corners& t) {
    return (t[1] - t[0]).cross(t[2] - t[0]);
}

struct depth_of_vertex {
    std::uint32_t vertex;
    double depth;
    Vector3d normal;  // of length 1
};

/// The vertices that springs push: of each contact's triangle of the second body, those below the plane of the first
/// one's triangle, or at most `rest` above it. Vertices of several contacts are repeated.
std::vector<depth_of_vertex> depths_of(std::span<const aabb::contact> contacts, const placed_mesh& first,
                                       const placed_mesh& second, double rest) {
    std::vector<depth_of_vertex> depths;
    for (const aabb::contact& c : contacts) {
        const corners plane = corners_of(first, c.triangle_a);
        const Vector3d normal = normal_of(plane);
        const double length = length_of(normal);
        if (length == 0) continue;  // a triangle of zero area spans no plane
        const corners t = corners_of(second, c.triangle_b);
        for (std::size_t i = 0; i < 3; ++i)
            if (const double depth = -dot(normal, t[i] - plane[0]) / length; depth >= -rest)
                depths.push_back({second.mesh->triangles[c.triangle_b][i], depth, normal * (1 / length)});
    }
    return depths;
}

void keep_deepest_of_each(std::vector<depth_of_vertex>& depths) {
    std::ranges::sort(depths, {}, [](const depth_of_vertex& d) { return std::pair(d.vertex, -d.depth); });
    const auto repeated = std::ranges::unique(depths, {}, &depth_of_vertex::vertex);
    depths.erase(repeated.begin(), repeated.end());
}

void keep_deepest(std::vector<depth_of_vertex>& depths) {
    const auto deepest = std::ranges::max_element(depths, {}, &depth_of_vertex::depth);
    if (deepest != depths.end()) depths = {*deepest};
}

/// Sums springs with dashpots: force (k d - c n·v) n and energy k d²/2 for a compression d along the normal n.
contact_force spring_force(const contact_law& law, std::span<const depth_of_vertex> depths, const Vector3d& approach) {
    Vector3d force = Vector3d::Zero();
    double energy = 0;
    for (const depth_of_vertex& vertex : depths) {
        const double compressed = vertex.depth + law.rest;
        force += vertex.normal * (law.stiffness * compressed - law.damping * dot(vertex.normal, approach));
        energy += law.stiffness * compressed * compressed / 2;
    }
    return {from_eigen(force), energy};
}

/// The force -(k + c A·v/|A|) A of a pressure on the second body's surface inside the first. By Stokes' theorem, the
/// integral A of that surface's normal is ½ Σ p × q over the segments pq in which pairs of triangles intersect.
contact_force pressure_force(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                             const placed_mesh& second, const Vector3d& approach) {
    Vector3d area = Vector3d::Zero();  // of the second body's surface inside the first, along its outward normal
    std::optional<Vector3d> origin;
    for (const aabb::contact& c : contacts) {
        const aabb::triangle_intersection common =
            aabb::intersection_of(first.triangle(c.triangle_a), second.triangle(c.triangle_b));
        if (common.size != 2) continue;  // only a segment has an integral
        // The sum over a closed curve is the same for every origin; one on the curve rounds least.
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

/// n·x <= offset is inside.
struct half_space {
    Vector3d normal;
    double offset;
};

using polygon = std::vector<Vector3d>;

/// The half-spaces below the first triangles of a mesh. Those of all triangles intersect in the mesh if it is convex.
std::vector<half_space> half_spaces_of(const placed_mesh& m, std::uint32_t most_triangles) {
    std::vector<half_space> half_spaces;
    for (std::uint32_t i = 0; i < std::min(most_triangles, m.mesh->triangle_count()); ++i) {
        const corners t = corners_of(m, i);
        const Vector3d normal = normal_of(t);
        half_spaces.push_back({normal, dot(normal, t[0])});
    }
    return half_spaces;
}

/// The part of a convex polygon inside a half-space (Sutherland and Hodgman 1974), with the boundary.
polygon clipped(const polygon& p, const half_space& h) {
    polygon kept;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vector3d& from = p[i];
        const Vector3d& to = p[(i + 1) % p.size()];
        const double d_from = dot(h.normal, from) - h.offset;  // at most 0 inside
        const double d_to = dot(h.normal, to) - h.offset;
        if (d_from <= 0) kept.push_back(from);
        if ((d_from < 0 && d_to > 0) || (d_from > 0 && d_to < 0)) {
            kept.emplace_back(from + (to - from) * (d_from / (d_from - d_to)));
        }
    }
    return kept;
}

/// Clips all triangles of a mesh by the half-spaces. @returns six times the signed volume of the cones from the apex
/// over the clipped parts. Over a closed surface these volumes add up to the enclosed one (the divergence theorem).
double cones_over(const placed_mesh& m, std::span<const half_space> half_spaces, const Vector3d& apex) {
    double sum = 0;
    for (std::uint32_t t = 0; t < m.mesh->triangle_count(); ++t) {
        polygon part;
        for (const Vector3d& corner : corners_of(m, t)) part.emplace_back(corner - apex);
        for (const half_space& h : half_spaces) {
            part = clipped(part, {h.normal, h.offset - dot(h.normal, apex)});
            if (part.size() < 3) break;
        }
        // The part is a fan of triangles; the triple product is six times the volume of the cone over one.
        for (std::size_t i = 2; i < part.size(); ++i) sum += dot(part[0], part[i - 1].cross(part[i]));
    }
    return sum;
}

/// The three components of a body.
auto vector_at(std::span<const double> values, std::size_t body) {
    return Eigen::Map<const Eigen::Vector3d>(values.subspan(3 * body, 3).data());
}
auto vector_at(std::span<double> values, std::size_t body) {
    return Eigen::Map<Eigen::Vector3d>(values.subspan(3 * body, 3).data());
}

}  // namespace

/// The triangle of this index in world coordinates, computed in double.
aabb::triangle3d placed_mesh::triangle(std::uint32_t index) const {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(pose.rotation.data());
    const aabb::triangle3f local = mesh->triangle(index);
    const auto corner = [&](int i) {
        return from_eigen(product(rotation, in_eigen(local[i])) + in_eigen(pose.translation));
    };
    return {{corner(0), corner(1), corner(2)}};
}

/// The force on the second body from all contacts, by law: a pressure, a spring at the deepest vertex, or at each.
contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                       const placed_mesh& second, const aabb::vec3d& approach) {
    if (law.geometry == contact_geometry::shared_volume)
        return pressure_force(law, contacts, first, second, in_eigen(approach));
    std::vector<depth_of_vertex> depths = depths_of(contacts, first, second, law.rest);
    if (law.geometry == contact_geometry::deepest_vertex)
        keep_deepest(depths);
    else
        keep_deepest_of_each(depths);
    return spring_force(law, depths, in_eigen(approach));
}

double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second) {
    // With the apex on the floor, cones over its plane have no volume.
    const Vector3d apex = corners_of(first, 0)[0];
    double sum = cones_over(second, half_spaces_of(first, is_floor ? 1 : first.mesh->triangle_count()), apex);
    if (!is_floor) sum += cones_over(first, half_spaces_of(second, second.mesh->triangle_count()), apex);
    return sum / 6;
}

/// The initial positions and velocities of the bodies, at time 0.
motion_state stepped_world::start() const {
    motion_state state;
    for (const body& b : bodies) {
        state.position.insert(state.position.end(), std::begin(b.position.at), std::end(b.position.at));
        state.velocity.insert(state.velocity.end(), std::begin(b.velocity.at), std::end(b.velocity.at));
    }
    return state;
}

std::vector<std::uint32_t> stepped_world::mesh_of() const {
    std::vector<std::uint32_t> meshes_of_bodies;
    for (const body& b : bodies) meshes_of_bodies.push_back(b.mesh);
    return meshes_of_bodies;
}

void stepped_world::place(std::span<const double> position, std::vector<aabb::pose>& poses) const {
    poses.resize(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) poses[i] = {bodies[i].rotation, from_eigen(vector_at(position, i))};
}

/// Sets the acceleration of every body that is not fixed: gravity, and contact forces over its mass.
/// @param contacts sorted, so that those of two bodies follow each other
void dynamics::accelerate(std::span<const double> position, std::span<const double> velocity,
                          std::span<const aabb::contact> contacts, std::span<double> acceleration) {
    const std::vector<body>& bodies = world_.bodies;
    world_.place(position, poses_);
    std::ranges::fill(acceleration, 0.0);
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (std::isfinite(bodies[i].mass)) acceleration[3 * i + 2] = -world_.gravity;
    spring_energy_ = 0;
    for (auto from = contacts.begin(); from != contacts.end();) {
        const std::uint32_t a = from->a, b = from->b;
        const auto to = std::find_if(from, contacts.end(), [&](const auto& c) { return c.a != a || c.b != b; });
        const contact_force contact = force_of(world_.law, {from, to}, {&world_.meshes[bodies[a].mesh], poses_[a]},
                                               {&world_.meshes[bodies[b].mesh], poses_[b]},
                                               from_eigen(vector_at(velocity, b) - vector_at(velocity, a)));
        vector_at(acceleration, a) -= in_eigen(contact.force) / bodies[a].mass;
        vector_at(acceleration, b) += in_eigen(contact.force) / bodies[b].mass;
        spring_energy_ += contact.energy;
        from = to;
    }
}

/// Sums m (v²/2 + g z) over the bodies that are not fixed.
double dynamics::mechanical_energy(const motion_state& state) const {
    double sum = 0;
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
        const double mass = world_.bodies[i].mass;
        if (!std::isfinite(mass)) continue;
        const auto v = vector_at(state.velocity, i);
        sum += mass * (dot(v, v) / 2 + world_.gravity * state.position[3 * i + 2]);
    }
    return sum;
}

}  // namespace aabblab
