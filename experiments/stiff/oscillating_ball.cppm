/// A ball that oscillates in contact with the floor: a linear oscillator, as long as it never leaves.
module aabblab.stiff:oscillating_ball;

import aabb.std;
import aabblab.stepping;
import aabblab.trials;
import :ball_world;
import :simulation;

namespace aabblab {

/// A ball of 1 kg that oscillates without a dashpot about its equilibrium depth.
class oscillating_ball {
public:
    static constexpr double gravity = 9.81;  // m/s²

    /// @param frequency ω of the contact, 1/s
    /// @param amplitude m; the ball leaves contact above the depth of equilibrium, gravity/ω²
    /// @param tolerance of an adaptive integrator
    oscillating_ball(const candidate& tested, const integrator_info& stepping, double frequency, double amplitude,
                     double tolerance = 0)
        : frequency_(frequency),
          at_rest_(gravity / (frequency * frequency)),
          world_(ball_on_floor({frequency}, /*speed_down=*/0, gravity)),
          ball_(with_depth(world_, at_rest_ + amplitude), tested, stepping, tolerance) {}

    void advance(double step) { ball_.advance(step); }
    /// Above the depth of equilibrium, m.
    [[nodiscard]] double offset() const { return at_rest_ - depth_of_ball(ball_.state()); }
    /// Upwards, m/s.
    [[nodiscard]] double speed() const { return speed_of_ball(ball_.state()); }
    /// The energy of the oscillation, J.
    [[nodiscard]] double energy() const {
        return (speed() * speed() + frequency_ * frequency_ * offset() * offset()) / 2;
    }
    /// Whether the amplitude is below a tenth of the depth of equilibrium, so that no stage of a step leaves contact.
    /// False if the energy is NaN.
    [[nodiscard]] bool is_linear() const { return energy() < 0.01 * frequency_ * frequency_ * at_rest_ * at_rest_ / 2; }

private:
    static const stepped_world& with_depth(stepped_world& world, double depth) {
        world.bodies[1].position[2] = -depth;
        return world;
    }

    double frequency_;
    double at_rest_;  // the depth of equilibrium, m
    stepped_world world_;
    simulation ball_;
};

}  // namespace aabblab
