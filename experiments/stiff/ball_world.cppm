/// One ball, which is an octahedron on its vertex, and a floor: the world of which everything is known.
module aabblab.stiff:ball_world;

import aabb.std;
import aabblab.stepping;
import :shapes;

namespace aabblab {

/// Mass 1 kg on a linear spring with a dashpot, in closed form: x'' = -ω² x - 2ζω x'. Underdamped.
struct oscillator {
    double frequency;  ///< ω, 1/s
    double damping;    ///< ζ

    /// How deep a mass is that touches at time 0 with this speed, m.
    [[nodiscard]] double depth(double speed, double time) const {
        return speed / damped() * std::exp(-damping * frequency * time) * std::sin(damped() * time);
    }
    /// The rate at which this depth grows, m/s.
    [[nodiscard]] double sinking(double speed, double time) const {
        return speed * std::exp(-damping * frequency * time) *
               (std::cos(damped() * time) - damping * frequency / damped() * std::sin(damped() * time));
    }
    /// Until it is back where it touched, s.
    [[nodiscard]] double contact_time() const { return std::numbers::pi / damped(); }
    /// Speed when it is back there, over the one with which it came.
    [[nodiscard]] double restitution() const {
        return std::exp(-std::numbers::pi * damping / std::sqrt(1 - damping * damping));
    }
    /// ζ with which the restitution is this.
    [[nodiscard]] static double damping_for(double restitution) {
        const double logarithm = std::log(restitution);
        return -logarithm / std::hypot(std::numbers::pi, logarithm);
    }

private:
    [[nodiscard]] double damped() const { return frequency * std::sqrt(1 - damping * damping); }
};

/// A ball of 1 kg that touches the floor at time 0.
[[nodiscard]] inline stepped_world ball_on_floor(const oscillator& contact, double speed_down, double gravity = 0) {
    stepped_world world;
    world.meshes = {floor_of(4), octahedron(0.5)};
    // Beside the diagonal of the floor.
    world.bodies = {{}, {.mesh = 1, .position = {0.3, -0.2, 0}, .velocity = {0, 0, -speed_down}, .mass = 1}};
    world.law = {contact_geometry::deepest_vertex, contact.frequency * contact.frequency,
                 2 * contact.damping * contact.frequency, 0};
    world.gravity = gravity;
    return world;
}

/// How far the ball's lowest vertex is below the floor, m.
[[nodiscard]] inline double depth_of_ball(const motion_state& state) {
    return -state.position[5];
}
/// Upwards, m/s.
[[nodiscard]] inline double speed_of_ball(const motion_state& state) {
    return state.velocity[5];
}

}  // namespace aabblab
