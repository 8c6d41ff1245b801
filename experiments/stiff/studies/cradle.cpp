module;
#include <cmath>

module aabblab.stiff;

import :incline;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr std::size_t balls = 5;
constexpr double speed = 1;        // of the first ball, m/s
constexpr double stiffness = 1e6;  // N/m
// Two balls of 1 kg oscillate as their reduced mass of half a kilogram. Functions: clang 19 does not initialise
// variables of a module's implementation unit in their order.
double frequency() {
    return std::sqrt(2 * stiffness);
}
double contact_time() {  // without damping, s
    return std::numbers::pi / frequency();
}
double step() {
    return 0.01 / frequency();
}

/// Balls of 1 kg in a row along x, at rest but for the first, without gravity.
stepped_world row_of_balls(double gap, double damping) {
    stepped_world world;
    world.meshes = {mesh_around_ball()};
    for (std::size_t i = 0; i < balls; ++i) {
        // Each cube is turned about x by another angle: coplanar sides would be decided in exact arithmetic, which
        // takes twenty times as long.
        const double angle = 0.3 * static_cast<double>(i), cosine = std::cos(angle), sine = std::sin(angle);
        world.bodies.push_back({.position = {(2 * ball_radius + gap) * static_cast<double>(i), 0, 0},
                                .velocity = {i == 0 ? speed : 0, 0, 0},
                                .mass = 1,
                                .rotation = {1, 0, 0, 0, cosine, -sine, 0, sine, cosine},
                                .inertia = inertia_of_ball(1, ball_radius),
                                .radius = ball_radius});
    }
    world.law = {.stiffness = stiffness, .damping = damping, .may_pull = false};
    return world;
}

double speed_of(const simulation& row, std::size_t ball) {
    return row.state().velocity[3 * ball];
}

/// The implicit midpoint detects contacts in each of its iterations, and has the order of Verlet.
bool is_left_out(const integrator_info& i, const stiff_setting& setting) {
    return setting.quick && i.name == "implicit_midpoint";
}

}  // namespace

/// Across gaps every ball hits the next one alone and gives it (1+e)/2 of its speed. Touching balls with springs share
/// the impact instead: a wave disperses along them.
void run_cradle(const stiff_setting& setting, stiff_result& result) {
    for (const double damping_ratio : {0.0, 0.1}) {
        // e as for a ball on a floor, where the force of spring and dashpot vanishes.
        const double restitution =
            std::exp(-2 * damping_ratio * std::acos(damping_ratio) / std::sqrt(1 - damping_ratio * damping_ratio));
        const double damping = 2 * damping_ratio * std::sqrt(stiffness / 2);  // ζ of the reduced mass
        const double last_speed = speed * std::pow((1 + restitution) / 2, balls - 1);
        // The slowest ball takes two contact times to the next one.
        const double gap = 2 * contact_time() * speed;
        const double end = 2 * static_cast<double>(balls) * (gap / last_speed + contact_time());
        for (const integrator_info& i : integrators_of(setting)) {
            if (i.stable_below == 0) continue;  // explicit Euler gains energy in every contact
            if (is_left_out(i, setting)) continue;
            run_or_record_failure(result, i.name, [&] {
                const std::string subject = std::string(i.name) + ", e " + short_number(restitution);
                simulation row(row_of_balls(gap, damping), setting, i, /*tolerance=*/1e-9);
                while (row.state().time < end && speed_of(row, balls - 1) < 0.5 * last_speed) row.advance(step());
                // Its contact ends.
                for (double until = row.state().time + contact_time(); row.state().time < until;) row.advance(step());
                // A contact begins and ends within a step: a spring then has (ω dt)² of the energy, and a dashpot
                // 2ζω dt of the impulse. Euler and Verlet evaluate the dashpot a step late, another ζω dt.
                const double phase = frequency() * step();
                const double late = phase * phase + 3 * damping_ratio * phase;
                result.add(within(subject, "speed of the last of five balls (m/s)", speed_of(row, balls - 1),
                                  last_speed, (balls - 1) * late));
                double momentum = 0;
                for (std::size_t b = 0; b < balls; ++b) momentum += speed_of(row, b);
                result.add(within(subject, "momentum over that at the start", momentum / speed, 1, 1e-12));
            });
        }
    }
    for (const integrator_info& i : integrators_of(setting)) {
        if (i.order != 2 || i.adaptive || is_left_out(i, setting)) continue;
        simulation row(row_of_balls(/*gap=*/0, /*damping=*/0), setting, i);
        while (row.state().time < 4 * static_cast<double>(balls) * contact_time()) row.advance(step());
        for (const std::size_t b : {std::size_t{0}, balls - 2, balls - 1})
            result.add(reported(std::string(i.name) + ", touching balls",
                                "speed of ball " + std::to_string(b + 1) + " (m/s)", speed_of(row, b)));
    }
}

stiff_study cradle_study() {
    return {
        "cradle",
        "Five balls of 1 kg in a row; the first hits the next one at 1 m/s. With gaps between them the impacts "
        "follow each other. Touching balls on springs disperse the impact; their speeds are only shown. --quick "
        "leaves out the implicit midpoint",
        "closed form of impacts one by one: the last ball gets ((1+e)/2)⁴ of the speed, with the restitution e of a "
        "spring and dashpot that do not pull",
        &run_cradle};
}

}  // namespace aabblab
