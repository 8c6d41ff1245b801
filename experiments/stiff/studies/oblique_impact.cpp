module;
#include <cmath>

module aabblab.stiff;

import :incline;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr double friction = 0.2;             // μ
constexpr double normal_speed = 1;           // v_n, m/s
constexpr double frequency = 1e3;            // ω, 1/s
constexpr double step = 0.005 / frequency;   // s
constexpr double slip_speed = 0.005;         // m/s
constexpr double adaptive_tolerance = 1e-9;  // of adaptive integrators
constexpr auto lost_by_slip = "tangential speed lost over μ(1+e) v_n";

/// The restitution of a linear spring and dashpot that do not pull: they part where their force vanishes, at 2 acos(ζ)
/// of the damped phase.
double restitution_of(double damping) {
    return std::exp(-2 * damping * std::acos(damping) / std::sqrt(1 - damping * damping));
}

/// The ζ that gives this restitution, by bisection: more damping gives less.
double damping_for(double restitution) {
    double less = 0, more = 0.9;
    while (more - less > 1e-15) {
        const double middle = (less + more) / 2;
        (restitution_of(middle) > restitution ? less : more) = middle;
    }
    return less;
}

struct impact {
    double normal = 0, tangential = 0, spin = 0;  // r ω; velocities after the impact, m/s
};

/// Lets a ball that just touches the floor hit it.
impact hit(const stiff_setting& setting, const integrator_info& stepping, double restitution, double tangential,
           double spin) {
    const rubbing contact{friction, slip_speed, frequency, damping_for(restitution)};
    stepped_world world = ball_on_incline({}, contact, tangential);
    world.gravity = 0;
    world.bodies[1].position[2] = ball_radius;
    world.bodies[1].velocity[2] = -normal_speed;
    world.bodies[1].angular_velocity = {0, spin / ball_radius, 0};
    simulation ball(world, setting, stepping, adaptive_tolerance);
    while (ball.state().time < 1.2 * std::numbers::pi / frequency) ball.advance(step);
    return {ball.state().velocity[5], ball.state().velocity[3], ball_radius * ball.angular_velocity(1)[1]};
}

}  // namespace

/// The impulse m (1+e) v_n of the normal force lets friction take μ (1+e) v_n of the tangential speed, and 2.5 times as
/// much from r ω, or all of the slip, of which 2/7 is tangential speed: gross slip iff the slip exceeds 3.5 μ (1+e)
/// v_n.
void run_oblique_impact(const stiff_setting& setting, stiff_result& result) {
    for (const double restitution : {1.0, 0.5}) {
        const double impulse = friction * (1 + restitution) * normal_speed;  // μ (1+e) v_n
        for (const integrator_info& i : integrators_of(setting)) {
            if (i.stable_below == 0) continue;  // explicit Euler gains energy in every contact
            run_or_record_failure(result, i.name, [&] {
                const std::string name = std::string(i.name) + ", e " + short_number(restitution);
                // A contact begins and ends within a step: a spring then has v dt/ω, (ω dt)² of the energy, and a
                // dashpot 2ζω v dt of the impulse. Euler and Verlet evaluate the dashpot a step late, another ζω dt.
                const double damping = damping_for(restitution);
                const double phase = frequency * step;
                const double late = phase * phase + 3 * damping * phase;
                for (const double slip : {1.0, 3.4, 3.6, 5.0, -5.0}) {  // of v_t - r ω, over μ (1+e) v_n
                    // The last one comes from backspin alone.
                    const double tangential = slip < 0 ? 0 : slip * impulse;
                    const impact after = hit(setting, i, restitution, tangential, slip < 0 ? -slip * impulse : 0);
                    const double lost = (tangential - after.tangential) / impulse;
                    const double expected = std::copysign(std::min(1.0, std::abs(slip) * 2 / 7), slip);
                    const std::string subject = name + ", slip " + short_number(slip) + " μ(1+e) v_n";
                    // Of a slip that ends, up to v_s may be left: 2/7 of it is tangential.
                    const double left = std::abs(slip) < 3.5 ? 2.0 / 7 * slip_speed / impulse / std::abs(expected) : 0;
                    result.add(within(subject, lost_by_slip, lost, expected, late + left));
                    if (slip == 1.0)
                        result.add(within(subject, "restitution", after.normal / normal_speed, restitution, late));
                    if (i.order > 2 && !i.adaptive && restitution == 1 && slip > 0)
                        result.plot("oblique", i.name, slip, lost);
                }
            });
        }
    }
}

stiff_study oblique_impact_study() {
    return {"oblique_impact",
            "A ball of 1 kg hits level ground at 1 m/s and with tangential speed or spin, on a spring and dashpot that "
            "do not pull. Friction with μ = 0.2 is regularised with a slip speed of 5 mm/s",
            "closed form of rigid bodies with Coulomb's friction: gross slip iff |v_t - rω| > 3.5 μ(1+e) v_n, with the "
            "loss μ(1+e) v_n; otherwise 2/7 of the slip; e = exp(-2ζ acos(ζ)/√(1-ζ²))",
            &run_oblique_impact,
            {figure{.name = "oblique",
                    .caption = "Tangential speed that a ball loses in an elastic impact, over its slip before it; from "
                               "3.5 on it slips all the time.",
                    .x = {"slip over μ(1+e) v_n"},
                    .y = {"tangential speed lost over μ(1+e) v_n"},
                    .lines = {{"closed form", series_style::line, {{1, 2.0 / 7}, {3.5, 1}, {5, 1}}}}}}};
}

}  // namespace aabblab
