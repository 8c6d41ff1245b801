module;
#include <complex>

module aabblab.stiff;

import :ball_world;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr double frequency = 1e3;  // ω of the contact, 1/s
constexpr double gravity = 9.81;
constexpr auto greatest_step = "greatest stable dt·ω";
// The depth of equilibrium, m.
constexpr double at_rest = gravity / (frequency * frequency);

/// A ball that oscillates about its equilibrium and never leaves contact.
class oscillating_ball {
public:
    oscillating_ball(const candidate& tested, const integrator_info& stepping, double amplitude, double tolerance)
        : world_(world_with(amplitude)), ball_(world_, tested, stepping, tolerance) {}

    void advance(double step) { ball_.advance(step); }
    [[nodiscard]] double energy() const {
        const double offset = depth_of_ball(ball_.state()) - at_rest;
        const double v = speed_of_ball(ball_.state());
        return (v * v + frequency * frequency * offset * offset) / 2;
    }

private:
    static stepped_world world_with(double amplitude) {
        stepped_world world = ball_on_floor({frequency, /*damping=*/0}, /*speed_down=*/0, gravity);
        world.bodies[1].position[2] -= at_rest + amplitude;
        return world;
    }

    stepped_world world_;
    simulation ball_;
};

/// The relative drift of the energy of a ball that oscillates for a number of periods: its greatest value in the last
/// tenth of the steps over that in the first tenth, minus 1. Bounded oscillations of the energy do not count.
/// @param scaled_step dt·ω
double drift_of(const candidate& tested, const integrator_info& stepping, double scaled_step, std::size_t periods,
                double tolerance) {
    oscillating_ball ball(tested, stepping, /*amplitude=*/at_rest / 100, tolerance);
    const auto steps = static_cast<std::size_t>(static_cast<double>(periods) * 2 * std::numbers::pi / scaled_step);
    double first = 0, last = 0;
    for (std::size_t i = 0; i < steps; ++i) {
        ball.advance(scaled_step / frequency);
        if (i < steps / 10) first = std::max(first, ball.energy());
        if (i >= steps - steps / 10) last = std::max(last, ball.energy());
    }
    return last / first - 1;
}

/// The factor by which a step changes the energy, from the stability polynomial of Dormand and Prince (1980).
double energy_factor_of_dormand_prince(double scaled_step) {
    const std::complex<double> z(0, scaled_step);
    const auto growth =
        1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 5.0)))));
    return std::norm(growth);
}

/// Whether an integrator is stable at this dt·ω: in 20,000 steps, the ball stays in contact, and its greatest energy is
/// at most 1 % more in the second half. Halves, as a symplectic integrator conserves only a modified energy.
bool is_stable(const candidate& tested, const integrator_info& stepping, double scaled_step) {
    // The amplitude is so small that the ball stays in contact even if the amplitude grows.
    oscillating_ball ball(tested, stepping, /*amplitude=*/at_rest * 1e-6, /*tolerance=*/0);
    double before = 0, after = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        ball.advance(scaled_step / frequency);
        const double energy = ball.energy();
        // The ball left contact, or its energy is NaN.
        if (!(energy < frequency * frequency * at_rest * at_rest / 2)) return false;
        double& greatest = i < steps / 2 ? before : after;
        greatest = std::max(greatest, energy);
    }
    return after <= 1.01 * before;
}

/// The greatest dt·ω at which an integrator is stable, by bisection between 0.1 and 4.
double limit_of(const candidate& tested, const integrator_info& stepping) {
    double stable = 0.1, unstable = 4;
    while (unstable - stable > 1e-3) {
        const double middle = (stable + unstable) / 2;
        (is_stable(tested, stepping, middle) ? stable : unstable) = middle;
    }
    return (stable + unstable) / 2;
}

void mark_limits(std::span<figure> figures, std::span<const stiff_row> rows) {
    for (const stiff_row& r : rows)
        if (const integrator_info* i = integrator_named(r.subject); r.quantity == greatest_step && i && i->order > 1)
            figures.front().marks.push_back({r.measured, r.subject + " " + short_number(r.measured)});
}

}  // namespace

/// Measures energy drift at several steps, and the greatest stable one of fixed steps. Symplectic energy must not
/// drift; dormand_prince, of order 5, must lose energy by the factor per step of its stability polynomial.
void run_stability(const stiff_setting& setting, stiff_result& result) {
    const std::size_t periods = setting.quick ? 100 : 1000;
    for (const integrator_info& i : integrators()) {
        std::vector<double> steps = {0.05, 0.1, 0.157, 0.314, 0.8};  // 5 and 10 % of the contact time among them
        if (!i.adaptive && i.stable_below > 1.5) steps.insert(steps.end(), {1.6, 1.9});  // below the limit of 2
        run_or_record_failure(result, i.name, [&] {
            for (const double scaled_step : steps) {
                const double drift =
                    drift_of(setting.tested, i, scaled_step, periods, /*tolerance=*/1e-6 * at_rest / 100);
                result.plot("energy_drift", i.name, scaled_step, std::abs(drift));
                const std::string subject = std::string(i.name) + ", dt·ω " + short_number(scaled_step);
                if (i.adaptive) {
                    result.add(reported(subject, "energy drift", drift));
                } else if (i.is_symplectic()) {
                    result.add(
                        at_most(subject, "energy drift, absolute value", std::abs(drift), setting.quick ? 0.05 : 1e-3));
                } else {
                    // Falling energy is greatest at the first step of each tenth: 0.9 of the run lies between.
                    const double lost =
                        std::pow(energy_factor_of_dormand_prince(scaled_step),
                                 0.9 * static_cast<double>(periods) * 2 * std::numbers::pi / scaled_step) -
                        1;
                    result.add(within(subject, "energy drift", drift, lost, 0.01));
                }
            }
        });
        if (i.adaptive) continue;
        run_or_record_failure(result, i.name, [&] {
            const double limit = limit_of(setting.tested, i);
            result.add(within(std::string(i.name), greatest_step, limit, i.stable_below, 0.005));
        });
    }
}

stiff_study stability_study() {
    return {
        "stability",
        "A ball of 1 kg oscillates on a floor about its equilibrium depth, always in contact, without a dashpot. The "
        "study measures the greatest stable step and the energy drift: the relative change in peak energy from the "
        "first to the last tenth of 1000 periods (100 with --quick)",
        "central differences are stable up to dt·ω = 2, with ω = √(k/m); the stability polynomial of Dormand and "
        "Prince (1980) gives the drift of dormand_prince, and exceeds 1 in modulus beyond 0.9972 on the imaginary "
        "axis; usual advice for the discrete element method is a step of 5 to 10 % of the contact time, dt·ω 0.157 to "
        "0.314",
        &run_stability,
        {figure{.name = "energy_drift",
                .caption =
                    "Relative drift of a ball's energy over 1000 periods (100 with --quick) in contact, its "
                    "absolute value, over the step size. Marks show the usual advice and the greatest stable steps.",
                .x = {"step times angular frequency", /*logarithmic=*/true},
                .y = {"relative energy drift", /*logarithmic=*/true},
                .marks = {{0.157, "5 %"}, {0.314, "10 % of the contact time"}}}},
        &mark_limits};
}

}  // namespace aabblab
