module aabblab.stiff;

import :ball_world;
import :oscillating_ball;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr double step = 1e-3;                                   // s, of every simulation
constexpr double softest = 0.01 / step, stiffest = 1e3 / step;  // frequencies ω = √(k/m), 1/s

/// Whether an integrator is stable at this frequency: in a number of steps, the greatest energy of a ball in contact is
/// at most 1 % more in the second half, and never more than in linear oscillations. Halves, as a symplectic integrator
/// conserves only a modified energy.
bool is_stable(const stiff_setting& setting, const integrator_info& stepping, double frequency) {
    // So small that the motion is linear up to the last per mille before the limit, where the energy of central
    // differences varies by a factor of 1000; and great enough that rounding does not matter.
    const double amplitude = oscillating_ball::gravity / (frequency * frequency) * 1e-3;
    oscillating_ball ball(setting.tested, stepping, frequency, amplitude);
    double before = 0, after = 0;
    // 0.2 % beyond their limits, the energy of Dormand and Prince's method grows by 2e-6 a step, that of others by a
    // hundredth and more.
    const int steps = !setting.quick ? 20'000 : stepping.order > 4 ? 10'000 : 1000;
    for (int i = 0; i < steps; ++i) {
        ball.advance(step);
        if (!ball.is_linear()) return false;
        double& greatest = i < steps / 2 ? before : after;
        greatest = std::max(greatest, ball.energy());
    }
    return after <= 1.01 * before;
}

/// The frequency at which an integrator fails first, as the stiffness grows from the softest contact by factors of 16
/// and then by bisection, within 0.2 %; 0 if it fails at the softest, the stiffest if it never fails.
double limit_of(const stiff_setting& setting, const integrator_info& stepping) {
    if (!is_stable(setting, stepping, softest)) return 0;
    double stable = softest, unstable = 4 * softest;
    while (is_stable(setting, stepping, unstable)) {
        if (unstable >= stiffest) return stiffest;
        stable = unstable;
        unstable = std::min(4 * unstable, stiffest);
    }
    while (unstable > stable * 1.004) {
        const double middle = std::sqrt(stable * unstable);
        (is_stable(setting, stepping, middle) ? stable : unstable) = middle;
    }
    return std::sqrt(stable * unstable);
}

/// The greatest relative gain of energy in a single bounce without loss and gravity, over the phases at which steps
/// cross the surface. Infinite if a bounce does not end within ten contact times.
double greatest_gain(const candidate& tested, const integrator_info& stepping, double scaled_step, int phases) {
    const oscillator contact{scaled_step / step};
    constexpr double speed = 1;  // m/s
    double greatest = -1;
    for (int i = 0; i < phases; ++i) {
        stepped_world world = ball_on_floor(contact, speed);
        world.bodies[1].position[2] = speed * step * (i + 0.5) / phases;
        simulation ball(world, tested, stepping);
        const double end = 10 * contact.contact_time() + 3 * step;
        // Two steps above the floor, so that the last force is not that of a contact.
        while (!(depth_of_ball(ball.state()) < 0 && speed_of_ball(ball.state()) > 0) && ball.state().time < end)
            ball.advance(step);
        ball.advance(step);
        if (!(depth_of_ball(ball.state()) < 0)) return std::numeric_limits<double>::infinity();
        greatest = std::max(greatest, std::pow(speed_of_ball(ball.state()) / speed, 2) - 1);
    }
    return greatest;
}

}  // namespace

/// Lets the stiffness grow at a fixed step until each integrator fails, for a ball that never leaves the floor, and
/// measures the energy that a bouncing ball gains.
void run_growing_stiffness(const stiff_setting& setting, stiff_result& result) {
    const int phases = setting.quick ? 50 : 500;
    for (const integrator_info& i : integrators_of(setting)) {
        if (i.adaptive) continue;
        run_or_record_failure(result, i.name, [&] {
            constexpr auto quantity = "dt·ω at which it fails";
            const double limit = limit_of(setting, i) * step;
            const std::string name(i.name);
            if (i.stable_below == 0)
                result.add(at_most(name, quantity, limit, 0));
            else if (std::isinf(i.stable_below))
                result.add(at_least(name, quantity, limit, stiffest * step));
            else
                result.add(within(name, quantity, limit, i.stable_below, 0.005));
            for (const double y : {0.1, 0.2, 0.5, 0.8, 1.2, 1.9, 2.5, 5.0, 10.0}) {
                if (y > i.stable_below && i.stable_below > 0) break;
                const double gain = greatest_gain(setting.tested, i, y, phases);
                result.plot("energy_gain", i.name, y, gain);
                if (y != 0.2 && y != 10) continue;
                // The proof is in the study's reference. Central differences: y²/4 from the phases, and y⁴/2.
                const double bound = i.name == "implicit_midpoint" ? y * y / 4 : y * y / 4 + y * y * y * y / 2;
                result.add(expected_if(i.order == 2, at_most(name + ", dt·ω " + short_number(y),
                                                             "greatest energy gain of a bounce", gain, bound)));
            }
        });
    }
}

stiff_study growing_stiffness_study() {
    return {
        "growing_stiffness",
        "A ball of 1 kg oscillates on a floor, always in contact, on ever stiffer springs at a fixed step of 1 ms, "
        "until its energy grows. A second ball bounces without loss, at many phases between steps and contact: what "
        "energy a bounce may gain. An integrator that no linear spring makes unstable gains energy too, since contacts "
        "begin and end within steps",
        "limits of dt·ω, ω = √(k/m): explicit Euler 0, symplectic Euler and central differences 2, the implicit "
        "midpoint none, Runge-Kutta where the stability polynomial leaves the unit circle: order 4 at 2√2, Dormand and "
        "Prince at 0.9972. The midpoint's energy changes only in steps across the surface, by ω² min(x², x'²)/2 "
        "with the distances x and x' before and after, so a bounce gains at most (dt·ω)²/4; central differences gain "
        "(dt·ω)²/4 to leading order",
        &run_growing_stiffness,
        {figure{.name = "energy_gain",
                .caption = "The greatest energy that a ball gains in a bounce without loss, over the stiffness at a "
                           "fixed step. The implicit midpoint is stable for every linear spring, but not for contacts "
                           "that begin and end.",
                .x = {"step times angular frequency", /*logarithmic=*/true},
                .y = {"greatest relative gain of energy", /*logarithmic=*/true}}}};
}

}  // namespace aabblab
