module;
#include <cmath>

/// A ball, shaped as an octahedron on its vertex, and a floor: a world with closed-form solutions.
module aabblab.stiff:ball_world;

import aabb.std;
import aabblab.stepping;
import :shapes;

namespace aabblab {

/// The closed form of an underdamped mass of 1 kg on a linear spring with a dashpot: x'' = -ω² x - 2ζω x'.
struct oscillator {
    double frequency;    ///< ω, 1/s
    double damping = 0;  ///< ζ
    /// Whether the dashpot may pull. If not, the force ends when it vanishes, x'' = 0: at the phase 2 acos ζ of the
    /// damped oscillation, where the speed is exp(-ζωt) of the initial one, and the spring is still compressed
    /// (Schwager and Pöschel 2007).
    bool may_pull = true;

    /// The depth of a mass that touches at time 0 with this speed, m.
    [[nodiscard]] double depth(double speed, double time) const {
        return speed / damped() * std::exp(-damping * frequency * time) * std::sin(damped() * time);
    }
    /// The rate at which this depth grows, m/s.
    [[nodiscard]] double sinking(double speed, double time) const {
        return speed * std::exp(-damping * frequency * time) *
               (std::cos(damped() * time) - damping * frequency / damped() * std::sin(damped() * time));
    }
    /// The time until the force ends, s.
    [[nodiscard]] double force_time() const {
        return (may_pull ? std::numbers::pi : 2 * std::acos(damping)) / damped();
    }
    /// The time until the mass returns to where it touched, s: after the force's end it flies freely from a depth of
    /// 2ζ/ω times its speed.
    [[nodiscard]] double contact_time() const { return force_time() + (may_pull ? 0 : 2 * damping / frequency); }
    /// The speed at the end of the contact over the speed at its start.
    [[nodiscard]] double restitution() const { return std::exp(-damping * frequency * force_time()); }

private:
    [[nodiscard]] double damped() const { return frequency * std::sqrt(1 - damping * damping); }
};

/// The world of a ball of 1 kg whose lowest vertex touches a fixed floor at time 0 and moves down at `speed_down` m/s.
/// The contact is a spring of stiffness ω² with a dashpot of 2ζω, so that the ball moves as the oscillator says.
[[nodiscard]] inline stepped_world ball_on_floor(const oscillator& contact, double speed_down, double gravity = 0) {
    stepped_world world;
    world.meshes = {floor_of(4), octahedron(0.5)};
    // Body 0 is the fixed floor. The ball must not hit the diagonal between two of its triangles.
    world.bodies = {{}, {.mesh = 1, .position = {0.3, -0.2, 0}, .velocity = {0, 0, -speed_down}, .mass = 1}};
    world.law = {.stiffness = contact.frequency * contact.frequency,
                 .damping = 2 * contact.damping * contact.frequency,
                 .may_pull = contact.may_pull};
    world.gravity = gravity;
    return world;
}

/// The depth of the ball's lowest vertex below the floor, m.
[[nodiscard]] inline double depth_of_ball(const motion_state& state) {
    return -state.position[5];
}
/// The upward velocity of the ball, m/s.
[[nodiscard]] inline double speed_of_ball(const motion_state& state) {
    return state.velocity[5];
}

}  // namespace aabblab
