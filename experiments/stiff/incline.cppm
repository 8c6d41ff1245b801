/// Bodies on an inclined floor with friction.
module aabblab.stiff:incline;

import aabb.geometry;
import aabb.std;
import aabblab.stepping;
import :shapes;

namespace aabblab {

inline constexpr double earth_gravity = 9.81;  // m/s²

/// A floor through the origin, turned about the axis y: it falls along x by `angle`, in radians.
struct incline {
    double angle = 0;

    [[nodiscard]] aabb::vec3d downhill() const { return {std::cos(angle), 0, -std::sin(angle)}; }
    [[nodiscard]] aabb::vec3d normal() const { return {std::sin(angle), 0, std::cos(angle)}; }
    /// A rotation about y that maps the axes x and z of a mesh to these directions, and tilts it downhill by `more`.
    [[nodiscard]] matrix3 rotation(double more = 0) const {
        const double cosine = std::cos(angle + more), sine = std::sin(angle + more);
        return {cosine, 0, sine, 0, 1, 0, -sine, 0, cosine};
    }
    /// The body's path along the floor, m.
    [[nodiscard]] double path(const motion_state& state, std::size_t body) const {
        return dot(downhill(), three_of(state.position, body));
    }
    [[nodiscard]] double height(const motion_state& state, std::size_t body) const {
        return dot(normal(), three_of(state.position, body));
    }
    [[nodiscard]] double speed(const motion_state& state, std::size_t body) const {
        return dot(downhill(), three_of(state.velocity, body));
    }

private:
    static aabb::vec3d three_of(const std::vector<double>& values, std::size_t body) {
        return {values[3 * body], values[3 * body + 1], values[3 * body + 2]};
    }
};

[[nodiscard]] inline aabb::vec3d times(const aabb::vec3d& v, double factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

/// Friction and stiffness of the contacts of a body of 1 kg.
struct rubbing {
    double friction;         ///< μ
    double slip_speed;       ///< m/s
    double frequency = 1e3;  ///< ω of the body on its springs, 1/s
    double damping = 1;      ///< ζ
};

inline constexpr double ball_radius = 0.1;  // m

/// The mesh that stands for a ball: a cube around it, so that the ball touches nothing that the mesh does not.
[[nodiscard]] inline aabb::mesh mesh_around_ball() {
    return cuboid({2.02 * ball_radius, 2.02 * ball_radius, 2.02 * ball_radius});
}

/// A homogeneous ball of 1 kg, body 1, which the floor supports at its depth of rest.
/// @param speed downhill, without spin
[[nodiscard]] inline stepped_world ball_on_incline(const incline& floor, const rubbing& contact, double speed) {
    const double stiffness = contact.frequency * contact.frequency;
    const double depth = earth_gravity * std::cos(floor.angle) / stiffness;
    return {.meshes = {floor_of(16), mesh_around_ball()},
            .bodies = {{.rotation = floor.rotation()},
                       {.mesh = 1,
                        .position = times(floor.normal(), ball_radius - depth),
                        .velocity = times(floor.downhill(), speed),
                        .mass = 1,
                        .inertia = inertia_of_ball(1, ball_radius),
                        .radius = ball_radius}},
            .law = {.stiffness = stiffness,
                    .damping = 2 * contact.damping * contact.frequency,
                    .may_pull = false,
                    .friction = contact.friction,
                    .slip_speed = contact.slip_speed},
            .gravity = earth_gravity};
}

/// A homogeneous block of 1 kg, body 1, on springs at its four lower vertices, which carry its weight.
/// @param sides along the slope, across, and along the normal, m
/// @param speed downhill
[[nodiscard]] inline stepped_world block_on_incline(const incline& floor, const rubbing& contact,
                                                    const aabb::vec3d& sides, double speed) {
    const double stiffness = contact.frequency * contact.frequency;  // of four springs
    const double depth = earth_gravity * std::cos(floor.angle) / stiffness;
    return {.meshes = {floor_of(16), cuboid(sides)},
            .bodies = {{.rotation = floor.rotation()},
                       {.mesh = 1,
                        .position = times(floor.normal(), sides[2] / 2 - depth),
                        .velocity = times(floor.downhill(), speed),
                        .mass = 1,
                        .rotation = floor.rotation(),
                        .inertia = inertia_of_box(1, sides)}},
            .law = {.geometry = contact_geometry::each_vertex,
                    .stiffness = stiffness / 4,
                    .damping = 2 * contact.damping * contact.frequency / 4,
                    .may_pull = false,
                    .friction = contact.friction,
                    .slip_speed = contact.slip_speed},
            .gravity = earth_gravity};
}

}  // namespace aabblab
