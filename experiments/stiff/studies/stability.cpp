module;
#include <cmath>

module aabblab.stiff;

import :oscillating_ball;
import :rules;

namespace aabblab {

namespace {

constexpr double frequency = 1e3;  // ω of the contact, 1/s
// The depth of equilibrium, m.
constexpr double at_rest = oscillating_ball::gravity / (frequency * frequency);

/// The relative drift of the energy of a ball that oscillates for a number of periods: its greatest value in the last
/// tenth of the steps over that in the first tenth, minus 1. Bounded oscillations of the energy do not count.
/// @param scaled_step dt·ω
double drift_of(const candidate& tested, const integrator_info& stepping, double scaled_step, std::size_t steps,
                double tolerance) {
    oscillating_ball ball(tested, stepping, frequency, /*amplitude=*/at_rest / 100, tolerance);
    double first = 0, last = 0;
    for (std::size_t i = 0; i < steps; ++i) {
        ball.advance(scaled_step / frequency);
        if (i < steps / 10) first = std::max(first, ball.energy());
        if (i >= steps - steps / 10) last = std::max(last, ball.energy());
    }
    return last / first - 1;
}

/// What a step of a symplectic integrator does not change if x'' = -ω² x, up to rounding: central differences
/// v² + ω² x² (1 - (dt·ω)²/4), symplectic Euler v² + ω² x² + ω² dt x v, and the implicit midpoint twice the energy.
double conserved(const integrator_info& i, const oscillating_ball& ball, double scaled_step) {
    const double x = frequency * ball.offset(), v = ball.speed();
    if (i.name == "velocity_verlet") return v * v + x * x * (1 - scaled_step * scaled_step / 4);
    if (i.name == "symplectic_euler") return v * v + x * x + scaled_step * x * v;
    return v * v + x * x;
}

/// The change of what is conserved, or of the energy, from the start to the end of a number of steps, relative to it.
double change_of(const candidate& tested, const integrator_info& stepping, double scaled_step, std::size_t steps) {
    oscillating_ball ball(tested, stepping, frequency, /*amplitude=*/at_rest / 100);
    const double initial = conserved(stepping, ball, scaled_step);
    for (std::size_t i = 0; i < steps; ++i) ball.advance(scaled_step / frequency);
    return conserved(stepping, ball, scaled_step) / initial - 1;
}

/// The usual advice, and the greatest stable steps of the integrators of order 2 and more.
std::vector<figure_mark> marks() {
    std::vector<figure_mark> list = {{0.157, "5 %"}, {0.314, "10 % of the contact time"}};
    for (const integrator_info& i : integrators())
        if (i.order > 1 && std::isfinite(i.stable_below))
            list.push_back({i.stable_below, std::string(i.name) + " " + short_number(i.stable_below)});
    return list;
}

}  // namespace

/// Measures energy drift at several steps. Symplectic integrators must conserve a modified energy; others with fixed
/// steps must change the energy by the energy factor of each step.
void run_stability(const stiff_setting& setting, stiff_result& result) {
    const double periods = setting.quick ? 100 : 1000;
    for (const integrator_info& i : integrators_of(setting)) {
        std::vector<double> scaled_steps = {0.05, 0.1, 0.157, 0.314, 0.8};  // 5 and 10 % of the contact time among them
        if (i.is_symplectic()) scaled_steps.insert(scaled_steps.end(), {1.6, 1.9});  // below the limit of 2
        run_or_record_failure(result, i.name, [&] {
            for (const double y : scaled_steps) {
                const std::string subject = std::string(i.name) + ", dt·ω " + short_number(y);
                double steps = std::floor(periods * 2 * std::numbers::pi / y);
                double drift = 0;
                if (i.adaptive) {
                    drift = drift_of(setting.tested, i, y, static_cast<std::size_t>(steps),
                                     /*tolerance=*/1e-6 * at_rest / 100);
                    result.add(reported(subject, "energy drift", drift));
                } else if (i.is_symplectic()) {
                    drift = change_of(setting.tested, i, y, static_cast<std::size_t>(steps));
                    // A step rounds the depth, a hundred times the amplitude; near the limit, x matters less than v.
                    const double rounding = steps * 100 * 1e-15 / std::max(1 - y * y / 4, 0.1);
                    result.add(at_most(subject, "change of the conserved energy", std::abs(drift), rounding));
                } else {
                    // The ball must stay in contact, so its energy must not grow by more than a thousand.
                    const double growth = std::log(i.energy_factor(y));
                    if (growth > 0) steps = std::min(steps, std::floor(std::log(1e3) / growth));
                    drift = change_of(setting.tested, i, y, static_cast<std::size_t>(steps));
                    result.add(within(subject, "energy drift", drift, std::expm1(steps * growth), 0.01));
                }
                result.plot("energy_drift", i.name, y, std::abs(drift));
            }
        });
    }
}

stiff_study stability_study() {
    return {
        "stability",
        "A ball of 1 kg oscillates on a floor about its equilibrium depth, always in contact, without a dashpot, for "
        "1000 periods (100 with --quick). The study measures the energy drift: of adaptive integrators the relative "
        "change in peak energy from the first to the last tenth; of symplectic ones the change of the modified energy "
        "that they conserve; of others the change from start to end, or until the energy is a thousand times as great",
        "central differences conserve v² + ω² x² (1 - (dt·ω)²/4), symplectic Euler v² + ω² x² + ω² dt x v, the "
        "implicit "
        "midpoint the energy, with ω = √(k/m); a step of a Runge-Kutta method multiplies the energy by the squared "
        "modulus of its stability polynomial at i dt·ω; usual advice for the discrete element method is a step of 5 to "
        "10 % of the contact time, dt·ω 0.157 to 0.314",
        &run_stability,
        {figure{.name = "energy_drift",
                .caption =
                    "Relative drift of a ball's energy over 1000 periods (100 with --quick) in contact, its "
                    "absolute value, over the step size; of symplectic integrators, that of the modified energy that "
                    "they conserve. An integrator is stopped at a thousand times the energy. Marks show the usual "
                    "advice and the greatest stable steps.",
                .x = {"step times angular frequency", /*logarithmic=*/true},
                .y = {"relative energy drift", /*logarithmic=*/true},
                .marks = marks()}}};
}

}  // namespace aabblab
