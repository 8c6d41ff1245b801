module;
#include <cmath>

module aabblab.stiff;

import :incline;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr aabb::vec3d slender = {0.2, 0.2, 1};
// Functions: clang 19 does not initialise variables of a module's implementation unit in their order.
double slenderness() {  // α
    return std::atan(slender[0] / slender[2]);
}
double half_diagonal() {  // R, m
    return std::hypot(slender[0], slender[2]) / 2;
}
double rate() {  // p, 1/s
    return std::sqrt(0.75 * earth_gravity / half_diagonal());
}
double released_at() {  // θ₀
    return slenderness() / 2;
}

struct rocked {
    double quarter_period = 0;  // from the release to the impact of the other edge, s
    double amplitude = 0;       // θ after the impact, on the other side
};

/// Releases a block that stands on an edge, tilted by θ₀, and lets it rock to its other edge until it turns back.
rocked rock(const stiff_setting& setting, const integrator_info& stepping, const rubbing& contact, double step) {
    const incline ground;
    stepped_world world = block_on_incline(ground, contact, slender, /*speed=*/0);
    const matrix3 rotation = incline{}.rotation(released_at());
    body& block = world.bodies[1];
    block.rotation = rotation;
    const auto edge_height = [](const matrix3& r, double side) {  // against the centre
        return r[6] * side * slender[0] / 2 - r[8] * slender[2] / 2;
    };
    // Two of the four springs carry the weight.
    block.position[2] = -edge_height(rotation, 1) - 2 * earth_gravity / (contact.frequency * contact.frequency);
    simulation rocking(world, setting, stepping);
    rocked result;
    while (rocking.state().time < 5 / rate()) {
        rocking.advance(step);
        const motion_state& state = rocking.state();
        const matrix3 now = matrix_of(state.orientation_of(0));
        if (result.quarter_period == 0) {
            if (state.position[5] + edge_height(now, -1) < 0) result.quarter_period = state.time;
        } else if (rocking.angular_velocity(1)[1] > 0 && state.time > 1.5 * result.quarter_period) {
            result.amplitude = std::atan2(now[6], now[8]);  // the block leans back
            break;
        }
    }
    return result;
}

}  // namespace

/// A slender block is assumed: sin(α - θ) is nearly α - θ, so that θ'' = -p² (α - θ), and the first impact comes after
/// arcosh(1/(1 - θ₀/α))/p, a quarter of the period (Housner 1963). The impact at the other edge keeps the angular
/// momentum about it, which leaves 1 - 1.5 sin² α of the angular velocity. Its square is the ratio of the energies
/// m g R (cos(α - θ) - cos α) of both amplitudes.
///
/// The slip creeps on its edge, at a speed in proportion to the slip speed, which costs energy in proportion: results
/// of two slip speeds are extrapolated to none.
void run_rocking(const stiff_setting& setting, stiff_result& result) {
    const double quarter = std::acosh(1 / (1 - released_at() / slenderness())) / rate();
    const double restitution = 1 - 1.5 * std::pow(std::sin(slenderness()), 2);
    const auto lift = [](double tilt) { return std::cos(slenderness() - tilt) - std::cos(slenderness()); };
    for (const integrator_info& i : integrators_of(setting)) {
        if (!i.is_symplectic() || i.stable_below > 2) continue;  // others take the same way with more detections
        run_or_record_failure(result, i.name, [&] {
            std::vector<double> quarters, ratios;
            rubbing contact{.friction = 0.6, .slip_speed = 0.01, .frequency = 1e3, .damping = 0.5};
            // Peaks of 13 weights, at an effective mass of a quarter: dt < 2 m v_s/(μ N) is 6e-5 s at the lesser one.
            constexpr double step = 1e-5;
            for (const double slip_speed : {0.01, 0.005}) {
                contact.slip_speed = slip_speed;
                const rocked rocking = rock(setting, i, contact, step);
                quarters.push_back(rocking.quarter_period);
                ratios.push_back(std::sqrt(lift(rocking.amplitude) / lift(released_at())));
            }
            const auto without_creep = [](const std::vector<double>& values) { return 2 * values[1] - values[0]; };
            const std::string subject(i.name);
            // Errors: sin α against α, α²/6 of the moment; the springs' depth, of the height of the other edge and of
            // the energy; a step.
            const double depth = 2 * earth_gravity / (contact.frequency * contact.frequency);
            result.add(
                within(subject, "quarter of the period (s)", without_creep(quarters), quarter,
                       slenderness() * slenderness() / 12 + depth / (slender[0] * released_at()) + step / quarter));
            result.add(within(subject, "angular velocity left by the impact, share", without_creep(ratios), restitution,
                              depth / (half_diagonal() * lift(released_at())) / 2));
            result.add(reported(subject, "the same at a slip speed of 0.01 m/s", ratios[0]));
        });
    }
}

stiff_study rocking_study() {
    return {"rocking",
            "A slender block of 1 kg is released on its edge, at half of the angle at which it would tip, and rocks "
            "until it comes to rest on its other edge. Springs and dashpots at its four lower vertices do not pull; "
            "friction holds the edges. Creep of the friction is extrapolated to none",
            "Housner 1963: the period (4/p) arcosh(1/(1 - θ₀/α)) with p² = 3g/(4R), and 1 - 1.5 sin² α of the angular "
            "velocity left by an impact, with the half diagonal R and the slenderness α = atan(b/h)",
            &run_rocking};
}

}  // namespace aabblab
