module;
#include <complex>

module aabblab.stiff;

import :rules;
import :shapes;
import :simulation;

namespace aabblab {

namespace {

constexpr double mass = 1;                              // kg
constexpr double gravity = 9.81;                        // m/s²
constexpr double arm = 0.25;                            // from the tip to the centre of mass, m
constexpr double across = 0.02;                         // I1, about the centre of mass, kg m²
constexpr double along = 0.01;                          // I3, about the axis
constexpr double stiffness = 1e5;                       // of the floor under the tip, N/m
constexpr double weight_moment = mass * gravity * arm;  // mgl, N m
const double least_sleeping_spin = std::sqrt(4 * across * weight_moment) / along;

/// A top whose tip presses a smooth floor with its weight, inclined by `tilt` about y.
/// @param spin ω3, along the axis, rad/s
/// @param precession Ω, about the vertical
stepped_world top_with(double tilt, double spin, double precession) {
    stepped_world world;
    world.meshes = {floor_of(4), hanging_pyramid(0.5F, 0.25F, static_cast<float>(arm))};
    const double s = std::sin(tilt), c = std::cos(tilt);
    const double about_axis = spin - precession * c;
    world.bodies = {{},
                    {.mesh = 1,
                     .position = {0.3, -0.2, arm * c - mass * gravity / stiffness},
                     .mass = mass,
                     .rotation = {c, 0, s, 0, 1, 0, -s, 0, c},
                     .inertia = matrix3{across, 0, 0, 0, across, 0, 0, 0, along},
                     .angular_velocity = {about_axis * s, 0, about_axis * c + precession}}};
    world.law.stiffness = stiffness;
    world.gravity = gravity;
    return world;
}

/// The horizontal part of the top's axis, as a complex number: of the size of the tilt if it is small.
std::complex<double> lean_of(const motion_state& state) {
    const matrix3 rotation = matrix_of(state.orientation_of(0));
    return {rotation[2], rotation[5]};
}

/// The mean precession over a time, rad/s.
double precession_of(const stiff_setting& setting, const integrator_info& stepping, const stepped_world& world,
                     double end, std::size_t steps) {
    simulation top(world, setting, stepping);
    double angle = 0;
    for (std::size_t s = 0; s < steps; ++s) {
        const std::complex<double> before = lean_of(top.state());
        top.advance(end / static_cast<double>(steps));
        angle += std::arg(lean_of(top.state()) / before);
    }
    return angle / end;
}

/// A bound of the relative error of a steady precession with steps of h, to leading order. An integrator of order p
/// turns the top by its angle y = ω3 h per step with a relative error of C y^p, where C is the error of its half period
/// over π. If every term of a Ω² - b Ω + mgl = 0 is off by this share, Ω is off by a Ω² + b Ω + mgl = 2 b Ω over the
/// slope, √(b² - 4 a mgl), relative to Ω.
/// @param condition b/√(b² - 4 a mgl)
double precession_error_of(const integrator_info& i, double spin, double step, double condition) {
    return i.half_period_error / std::numbers::pi * std::pow(spin * step, i.order) * 2 * condition;
}

/// Starts the top in steady precession, slow or fast, and compares its mean precession with the closed form.
void judge_precession(const stiff_setting& setting, const integrator_info& i, stiff_result& result) {
    constexpr double tilt = 0.5, spin = 100;
    const double a = across * std::cos(tilt), b = along * spin;
    const double root = std::sqrt(b * b - 4 * a * weight_moment);
    for (const bool is_slow : {true, false}) {
        const double expected = (b + (is_slow ? -root : root)) / (2 * a);
        const stepped_world world = top_with(tilt, spin, expected);
        const double end = std::numbers::pi / expected;  // half a turn
        constexpr double step = 2e-4;                    // at most
        const auto steps = static_cast<std::size_t>(std::ceil(end / step));
        const double whole = precession_of(setting, i, world, end, steps);
        const double half = precession_of(setting, i, world, end, 2 * steps);
        // Half the step has at most half the error, so at most the difference of both; and rounding.
        const double bound = precession_error_of(i, spin, end / static_cast<double>(2 * steps), b / root);
        const double tolerance = std::min(std::abs(half - whole) / expected, bound) + 1e-9;
        result.add(within(std::string(i.name) + (is_slow ? ", slow" : ", fast"), "steady precession (rad/s)", half,
                          expected, tolerance));
    }
}

/// The lean of an upright top after a time, over that at its start.
double growth_of(const stiff_setting& setting, const integrator_info& stepping, const stepped_world& world, double end,
                 std::size_t steps) {
    simulation top(world, setting, stepping);
    const double initial = std::abs(lean_of(top.state()));
    for (std::size_t s = 0; s < steps; ++s) top.advance(end / static_cast<double>(steps));
    return std::abs(lean_of(top.state())) / initial;
}

/// The lean of an upright top after a time over that at its start, if it is small: z'' - i (I3 ω3/I1) z' - (mgl/I1) z =
/// 0. It oscillates if I3² ω3² > 4 I1 mgl, and grows else.
double linear_growth(double spin, double time) {
    using complex = std::complex<double>;
    const complex gyration(0, along * spin / across);
    const complex root = std::sqrt(gyration * gyration + 4 * weight_moment / across);
    const complex fast = (gyration + root) / 2.0, slow = (gyration - root) / 2.0;
    return std::abs((slow * std::exp(fast * time) - fast * std::exp(slow * time)) / (slow - fast));
}

/// Leans a sleeping top a little, at spins around the least with which it sleeps.
void judge_sleep(const stiff_setting& setting, const integrator_info& i, stiff_result& result) {
    constexpr double end = 1, lean = 1e-6;
    constexpr std::size_t steps = 2000;
    for (const double squared : {0.5, 0.8, 0.95, 1.05, 1.25, 2.0}) {
        const double spin = std::sqrt(squared) * least_sleeping_spin;
        const stepped_world world = top_with(lean, spin, /*precession=*/0);
        const double expected = linear_growth(spin, end);
        const double whole = growth_of(setting, i, world, end, steps);
        const double half = growth_of(setting, i, world, end, 2 * steps);
        // What half the step has at most, and the terms of third order in the lean.
        const double greatest = lean * std::max(expected, 1.0);
        const double tolerance = std::abs(half - whole) / expected + 10 * greatest * greatest + 1e-6;
        result.add(within(std::string(i.name) + ", (ω3/least)² " + short_number(squared),
                          "lean after 1 s over the first", half, expected, tolerance));
    }
}

}  // namespace

/// Compares steady precession and sleep of a top with closed forms, with integrators of order 2 and more.
void run_heavy_top(const stiff_setting& setting, stiff_result& result) {
    for (const integrator_info& i : integrators_of(setting)) {
        if (i.adaptive || i.order == 1) continue;
        run_or_record_failure(result, i.name, [&] {
            judge_precession(setting, i, result);
            judge_sleep(setting, i, result);
        });
    }
}

stiff_study heavy_top_study() {
    return {
        "heavy_top",
        "A top of 1 kg spins on its tip on a smooth floor, a spring of 1e5 N/m. Inclined by 0.5 rad, it precesses "
        "steadily, slowly or fast. Upright and leant by a millionth, it sleeps, or the lean grows, if the spin ω3 "
        "along its axis is below a least one",
        "I1 cos θ Ω² - I3 ω3 Ω + mgl = 0 for the precession Ω; it sleeps if I3² ω3² > 4 I1 mgl. These are of a top "
        "whose tip is fixed; on a smooth floor, whose force is mg if the centre of mass keeps its height, they hold "
        "with I1 about the centre of mass. Tolerance: the difference between a step and half of it, for precession at "
        "most the leading error of the integrator",
        &run_heavy_top};
}

}  // namespace aabblab
