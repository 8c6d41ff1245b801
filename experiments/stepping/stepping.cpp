module;
#include <Eigen/Geometry>

module aabblab.stepping;

import aabb.base;
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

/// The velocity of the body's material point at this place.
Vector3d velocity_at(const placed_mesh& m, const Vector3d& point) {
    const Vector3d arm = point - in_eigen(m.pose.translation);
    return in_eigen(m.motion.velocity) + in_eigen(m.motion.angular_velocity).cross(arm);
}

/// A point of the second body below the first's surface.
struct depth_of_point {
    std::uint32_t vertex;  // 0 for that of a ball
    double depth;
    Vector3d normal;  // of length 1, from the first body
    Vector3d point;
};

/// The vertices that springs push: of each contact's triangle of the second body, those below the plane of the first
/// one's triangle, or at most `rest` above it. Vertices of several contacts are repeated. Of a ball, its deepest point.
std::vector<depth_of_point> depths_below_planes(std::span<const aabb::contact> contacts, const placed_mesh& first,
                                                const placed_mesh& second, double rest) {
    std::vector<depth_of_point> depths;
    for (const aabb::contact& c : contacts) {
        const corners plane = corners_of(first, c.triangle_a);
        const Vector3d normal = normal_of(plane);
        const double length = length_of(normal);
        if (length == 0) continue;  // a triangle of zero area spans no plane
        const auto add_if_deep = [&](std::uint32_t vertex, const Vector3d& point) {
            if (const double depth = -dot(normal, point - plane[0]) / length; depth >= -rest)
                depths.push_back({vertex, depth, normal * (1 / length), point});
        };
        if (second.radius > 0) {
            add_if_deep(0, in_eigen(second.pose.translation) - normal * (second.radius / length));
            continue;
        }
        const corners t = corners_of(second, c.triangle_b);
        for (std::size_t i = 0; i < 3; ++i) add_if_deep(second.mesh->triangles[c.triangle_b][i], t[i]);
    }
    return depths;
}

/// The depth of two balls along the line of their centres, if they overlap, or are at most `rest` apart. Their point of
/// contact divides the distance of the centres as their radii.
std::vector<depth_of_point> depth_of_balls(const placed_mesh& first, const placed_mesh& second, double rest) {
    const Vector3d centre = in_eigen(first.pose.translation);
    const Vector3d between = in_eigen(second.pose.translation) - centre;
    const double distance = length_of(between);
    const double radii = first.radius + second.radius;
    if (distance == 0 || distance > radii + rest) return {};
    return {{0, radii - distance, between * (1 / distance), centre + between * (first.radius / radii)}};
}

void keep_deepest_of_each(std::vector<depth_of_point>& depths) {
    std::ranges::sort(depths, {}, [](const depth_of_point& d) { return std::pair(d.vertex, -d.depth); });
    const auto repeated = std::ranges::unique(depths, {}, &depth_of_point::vertex);
    depths.erase(repeated.begin(), repeated.end());
}

void keep_deepest(std::vector<depth_of_point>& depths) {
    const auto deepest = std::ranges::max_element(depths, {}, &depth_of_point::depth);
    if (deepest != depths.end()) depths = {*deepest};
}

/// Coulomb's friction with a linear law below the slip speed.
/// @param slip tangential velocity of the second body relative to the first
Vector3d friction_of(const contact_law& law, double normal_force, const Vector3d& slip) {
    return slip * (-law.friction * normal_force / std::max(length_of(slip), law.slip_speed));
}

/// Sums springs with dashpots, force (k d - c n·v) n and energy k d²/2 for a compression d along the normal n, and
/// their friction.
contact_force spring_force(const contact_law& law, std::span<const depth_of_point> depths, const placed_mesh& first,
                           const placed_mesh& second) {
    Vector3d force = Vector3d::Zero();
    Vector3d moment = Vector3d::Zero();
    double energy = 0;
    for (const depth_of_point& deep : depths) {
        const Vector3d approach = velocity_at(second, deep.point) - velocity_at(first, deep.point);
        const double compressed = deep.depth + law.rest;
        const double rate = dot(deep.normal, approach);
        double pressing = law.stiffness * compressed - law.damping * rate;
        if (!law.may_pull) pressing = std::max(pressing, 0.0);
        Vector3d share = deep.normal * pressing;
        if (law.friction > 0) share += friction_of(law, std::max(pressing, 0.0), approach - deep.normal * rate);
        force += share;
        moment += Vector3d(deep.point - depths[0].point).cross(share);
        energy += law.stiffness * compressed * compressed / 2;
    }
    if (depths.empty()) return {};
    return {from_eigen(force), from_eigen(depths[0].point), from_eigen(moment), energy};
}

/// Integrals over the part of the second body's surface inside the first.
struct surface_inside {
    Vector3d origin = Vector3d::Zero();  // a point of its boundary
    Vector3d area = Vector3d::Zero();    // ∫ n dA, with the outward normal n
    Vector3d moment = Vector3d::Zero();  // ∫ (r - origin) × n dA
};

/// By Stokes' theorem, ∫ n dA = ½ ∮ r × dr and ∫ r × n dA = -½ ∮ |r|² dr: of the second, ∮ f dr = ∫ n × ∇f dA with
/// f = |r|²/2. For a segment from p to q, r × dr adds up to p × q, and |r|² dr to (q - p) (|p|² + p·q + |q|²)/3.
surface_inside integrals_of(std::span<const aabb::contact> contacts, const placed_mesh& first,
                            const placed_mesh& second) {
    surface_inside inside;
    bool has_origin = false;
    for (const aabb::contact& c : contacts) {
        const aabb::triangle_intersection common =
            aabb::intersection_of(first.triangle(c.triangle_a), second.triangle(c.triangle_b));
        if (common.size != 2) continue;  // only a segment has an integral
        // The sum over a closed curve of r × dr is the same for every origin; one on the curve rounds least.
        if (!std::exchange(has_origin, true)) inside.origin = in_eigen(common.corners[0]);
        const Vector3d p = in_eigen(common.corners[0]) - inside.origin;
        const Vector3d q = in_eigen(common.corners[1]) - inside.origin;
        // The part inside the first body lies to the left of the curve, seen from outside the second.
        const Vector3d along =
            normal_of(corners_of(second, c.triangle_b)).cross(normal_of(corners_of(first, c.triangle_a)));
        const double half = dot(q - p, along) < 0 ? -0.5 : 0.5;
        inside.area += p.cross(q) * half;
        inside.moment -= (q - p) * (half * (dot(p, p) + dot(p, q) + dot(q, q)) / 3);
    }
    return inside;
}

/// The force -(k + c A·v/|A|) A of a pressure on the second body's surface inside the first, with the integral A of
/// that surface's normal. It acts where its moment has no part across A; velocities are those of this point.
contact_force pressure_force(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                             const placed_mesh& second) {
    const surface_inside inside = integrals_of(contacts, first, second);
    const Vector3d& area = inside.area;
    const double size = length_of(area);
    if (size == 0) return {};
    // (c - o) × A is the part of the moment across A for c - o = A × moment/|A|².
    const Vector3d point = inside.origin + area.cross(inside.moment) / (size * size);
    const Vector3d approach = velocity_at(second, point) - velocity_at(first, point);
    const double rate = dot(area, approach) / size;
    double pressure = law.stiffness + law.damping * rate;
    if (!law.may_pull) pressure = std::max(pressure, 0.0);
    Vector3d force = area * -pressure;
    if (law.friction > 0) force += friction_of(law, std::max(pressure, 0.0) * size, approach - area * (rate / size));
    return {from_eigen(force), from_eigen(point),
            from_eigen(area * (-pressure * dot(area, inside.moment) / (size * size))), 0};
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

/// The force on the second body from all contacts, by law: a pressure, a spring at the deepest point, or at each.
contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts, const placed_mesh& first,
                       const placed_mesh& second) {
    if (first.radius > 0 && second.radius == 0)
        throw aabb::input_error("a ball must have a greater index than every other body that it touches");
    if (law.geometry == contact_geometry::shared_volume && second.radius == 0)
        return pressure_force(law, contacts, first, second);
    std::vector<depth_of_point> depths = first.radius > 0 && !contacts.empty()
                                             ? depth_of_balls(first, second, law.rest)
                                             : depths_below_planes(contacts, first, second, law.rest);
    if (law.geometry == contact_geometry::each_vertex)
        keep_deepest_of_each(depths);
    else
        keep_deepest(depths);
    return spring_force(law, depths, first, second);
}

double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second) {
    // With the apex on the floor, cones over its plane have no volume.
    const Vector3d apex = corners_of(first, 0)[0];
    double sum = cones_over(second, half_spaces_of(first, is_floor ? 1 : first.mesh->triangle_count()), apex);
    if (!is_floor) sum += cones_over(first, half_spaces_of(second, second.mesh->triangle_count()), apex);
    return sum / 6;
}

/// The initial positions, velocities, orientations and angular momenta of the bodies, at time 0.
motion_state stepped_world::start() const {
    motion_state state;
    for (const body& b : bodies) {
        state.position.insert(state.position.end(), std::begin(b.position.at), std::end(b.position.at));
        state.velocity.insert(state.velocity.end(), std::begin(b.velocity.at), std::end(b.velocity.at));
        if (!b.inertia) continue;
        const std::array<double, 4> orientation = quaternion_of(b.rotation);
        const aabb::vec3d momentum = angular_momentum_of(rotor_of(*b.inertia), orientation, b.angular_velocity);
        state.orientation.insert(state.orientation.end(), orientation.begin(), orientation.end());
        state.angular_momentum.insert(state.angular_momentum.end(), std::begin(momentum.at), std::end(momentum.at));
    }
    return state;
}

std::vector<rotor> stepped_world::rotors() const {
    std::vector<rotor> of_bodies;
    for (const body& b : bodies)
        if (b.inertia) of_bodies.push_back(rotor_of(*b.inertia));
    return of_bodies;
}

std::vector<std::uint32_t> stepped_world::mesh_of() const {
    std::vector<std::uint32_t> meshes_of_bodies;
    for (const body& b : bodies) meshes_of_bodies.push_back(b.mesh);
    return meshes_of_bodies;
}

void stepped_world::place(const motion_state& state, std::vector<aabb::pose>& poses) const {
    poses.resize(bodies.size());
    std::size_t turning = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        poses[i] = {bodies[i].inertia ? matrix_of(state.orientation_of(turning++)) : bodies[i].rotation,
                    from_eigen(vector_at(state.position, i))};
}

dynamics::dynamics(const stepped_world& world) : world_(world), rotors_(world.rotors()) {
    if (world.law.friction > 0 && !(world.law.slip_speed > 0))
        throw aabb::input_error("friction needs a slip speed above 0");
    std::size_t turning = 0;
    for (const body& b : world.bodies) turning_.push_back(b.inertia ? std::optional(turning++) : std::nullopt);
}

aabb::vec3d dynamics::angular_velocity(const motion_state& state, std::size_t body) const {
    const std::optional<std::size_t> turning = turning_[body];
    if (!turning) return {0, 0, 0};
    return angular_velocity_of(rotors_[*turning], state.orientation_of(*turning), state.momentum_of(*turning));
}

/// Sets the acceleration of every body that is not fixed: gravity, and contact forces over its mass; and the torque of
/// contact forces on every body that turns.
/// @param contacts sorted, so that those of two bodies follow each other
void dynamics::accelerate(const motion_state& state, std::span<const aabb::contact> contacts, motion_rates& rates) {
    const std::vector<body>& bodies = world_.bodies;
    world_.place(state, poses_);
    motions_.resize(bodies.size());
    std::ranges::fill(rates.acceleration, 0.0);
    std::ranges::fill(rates.torque, 0.0);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        motions_[i] = {from_eigen(vector_at(state.velocity, i)), angular_velocity(state, i)};
        if (std::isfinite(bodies[i].mass)) rates.acceleration[3 * i + 2] = -world_.gravity;
    }
    const auto placed = [&](std::uint32_t i) {
        return placed_mesh{&world_.meshes[bodies[i].mesh], poses_[i], motions_[i], bodies[i].radius};
    };
    const auto push = [&](std::uint32_t i, const Vector3d& force, const Vector3d& point, const Vector3d& moment) {
        vector_at(std::span(rates.acceleration), i) += force / bodies[i].mass;
        if (const std::optional<std::size_t> turning = turning_[i])
            vector_at(std::span(rates.torque), *turning) +=
                moment + Vector3d(point - vector_at(state.position, i)).cross(force);
    };
    spring_energy_ = 0;
    for (auto from = contacts.begin(); from != contacts.end();) {
        const std::uint32_t a = from->a, b = from->b;
        const auto to = std::find_if(from, contacts.end(), [&](const auto& c) { return c.a != a || c.b != b; });
        const contact_force contact = force_of(world_.law, {from, to}, placed(a), placed(b));
        push(a, -in_eigen(contact.force), in_eigen(contact.point), -in_eigen(contact.moment));
        push(b, in_eigen(contact.force), in_eigen(contact.point), in_eigen(contact.moment));
        spring_energy_ += contact.energy;
        from = to;
    }
}

void turn_all_freely(std::span<const rotor> rotors, motion_state& state, double time) {
    for (std::size_t i = 0; i < state.turning_bodies(); ++i)
        turn_freely(rotors[i], std::span(state.orientation).subspan(4 * i).first<4>(), state.momentum_of(i), time);
}

/// Sums m (v²/2 + g z) over the bodies that are not fixed, and ω·L/2 over those that turn.
double dynamics::mechanical_energy(const motion_state& state) const {
    double sum = 0;
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
        if (turning_[i])
            sum += dot(in_eigen(angular_velocity(state, i)), vector_at(state.angular_momentum, *turning_[i])) / 2;
        const double mass = world_.bodies[i].mass;
        if (!std::isfinite(mass)) continue;
        const auto v = vector_at(state.velocity, i);
        sum += mass * (dot(v, v) / 2 + world_.gravity * state.position[3 * i + 2]);
    }
    return sum;
}

}  // namespace aabblab
