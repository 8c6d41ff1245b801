module;
#include <cmath>

module aabblab.stiff;

import :incline;
import :rules;
import :simulation;
import aabblab.fmt;

namespace aabblab {

namespace {

// A ball of inertia 2/5 m r² has 2/7 of its mass against a force at its surface: 1/m + r²/I = 3.5/m.
constexpr double friction = 0.3;              // μ
constexpr double effective_mass = 2.0 / 7;    // kg
constexpr double adaptive_tolerance = 1e-10;  // of adaptive integrators

/// The time in which friction at the slip speed would stop the slip of a ball whose weight presses it with this share.
double decay_of_slip(const rubbing& contact, double pressing_share = 1) {
    return contact.slip_speed * effective_mass / (contact.friction * earth_gravity * pressing_share);
}

/// The speed of the ball's lowest point against the floor, m/s.
double slip_of(const simulation& ball, const incline& floor) {
    return floor.speed(ball.state(), 1) - ball_radius * ball.angular_velocity(1)[1];
}

/// Slides a ball without spin on level ground until it rolls. The angular momentum about the point of contact,
/// m r v + 2/5 m r² ω, is kept, hence v* = 5/7 v₀; the slip v - r ω falls by 3.5 μ g, hence t* = 2 v₀/(7 μ g), and
/// x* = v₀ t* - μ g t*²/2 = 12 v₀²/(49 μ g). Of the energy, 5/7 are left.
void measure_slide_to_roll(const stiff_setting& setting, stiff_result& result) {
    constexpr double speed = 1;  // v₀, m/s
    const incline ground;
    const rubbing contact{.friction = friction, .slip_speed = 1e-3 * speed};
    const double until_rolling = 2 * speed / (7 * friction * earth_gravity);
    const double distance = 12 * speed * speed / (49 * friction * earth_gravity);
    const double step = 0.2 * decay_of_slip(contact);
    const stepped_world world = ball_on_incline(ground, contact, speed);
    for (const integrator_info& i : integrators_of(setting)) {
        run_or_record_failure(result, i.name, [&] {
            simulation ball(world, setting, i, adaptive_tolerance);
            const double height = ground.height(ball.state(), 1);
            const double depth = ball_radius - height;
            double rise = 0, time = 0, path = 0, slip = speed;
            while (ball.state().time < 1.5 * until_rolling) {
                ball.advance(step);
                rise = std::max(rise, std::abs(ground.height(ball.state(), 1) - height) / depth);
                const double slip_before = std::exchange(slip, slip_of(ball, ground));
                if (time > 0 || slip > contact.slip_speed) continue;
                // Interpolated between the last two steps.
                const double too_far = step * (contact.slip_speed - slip) / (slip_before - slip);
                time = ball.state().time - too_far;
                path = ground.path(ball.state(), 1) - too_far * ground.speed(ball.state(), 1);
            }
            const std::string subject = std::string(i.name);
            // Until the slip falls below the slip speed, Coulomb's law is exact; the rest would take a share of
            // slip_speed/v₀ of the time, and less of the path. Integrators may be one step late.
            const double late = contact.slip_speed / speed + step / until_rolling;
            result.add(within(subject, "time until it rolls, t* (s)", time, until_rolling, late));
            result.add(within(subject, "path until it rolls, x* (m)", path, distance,
                              late * until_rolling * speed / distance));
            // Exact, as the point of contact is exactly r from the centre: sums of steps round.
            const double rounding = i.adaptive ? 1e3 * adaptive_tolerance : 1e-9;
            const double rolling = ground.speed(ball.state(), 1);
            result.add(within(subject, "rolling speed over initial speed", rolling / speed, 5.0 / 7, rounding));
            const double spin = ball.angular_velocity(1)[1] * ball_radius;
            result.add(within(subject, "energy lost, share",
                              1 - (rolling * rolling + 0.4 * spin * spin) / (speed * speed), 2.0 / 7, 10 * rounding));
            // Released at rest depth, the ball must not move up or down: a missed contact would let it fall.
            result.add(at_most(subject, "greatest rise or fall over depth at rest", rise, 1e-5));
        });
    }
}

/// A ball that is released on an incline rolls iff tan θ <= 3.5 μ, with 5/7 g sin θ, as static friction must be
/// 2/7 m g sin θ; otherwise it slides with g (sin θ - μ cos θ), and its slip grows by g (sin θ - 3.5 μ cos θ).
void measure_incline(const stiff_setting& setting, stiff_result& result) {
    const double duration = setting.quick ? 0.25 : 0.5;  // s, hundreds of decay times
    const rubbing contact{.friction = friction, .slip_speed = 5e-3};
    for (const double steepness : {0.5, 0.98, 1.02, 1.5}) {  // tan θ/(3.5 μ)
        const incline floor{std::atan(3.5 * friction * steepness)};
        const double sine = std::sin(floor.angle), cosine = std::cos(floor.angle);
        const double step = 0.2 * decay_of_slip(contact, cosine);
        const auto half = static_cast<int>(duration / 2 / step);
        for (const integrator_info& i : integrators_of(setting)) {
            run_or_record_failure(result, i.name, [&] {
                simulation ball(ball_on_incline(floor, contact, /*speed=*/0), setting, i, adaptive_tolerance);
                const double start = floor.path(ball.state(), 1);
                for (int s = 0; s < half; ++s) ball.advance(step);
                const double slip_at_half = slip_of(ball, floor);
                for (int s = 0; s < half; ++s) ball.advance(step);
                const double time = 2 * half * step;
                const double slip = slip_of(ball, floor);
                const std::string subject = std::string(i.name) + ", tan θ = " + short_number(steepness) + " · 3.5 μ";
                const double acceleration = 2 * (floor.path(ball.state(), 1) - start) / (time * time);
                if (steepness < 1) {
                    // v = 5/7 g sin θ t + 2/7 slip, with a slip up to v_s.
                    const double error = 0.8 * contact.slip_speed / (earth_gravity * sine * time) + step / time;
                    result.add(
                        within(subject, "acceleration (m/s²)", acceleration, 5.0 / 7 * earth_gravity * sine, error));
                    // It creeps: the linear law gives 2/7 m g sin θ at this slip, after many decay times.
                    result.add(within(subject, "slip over slip speed", slip / contact.slip_speed, steepness, 1e-5));
                } else {
                    // v = 5/7 g sin θ t + 2/7 slip again. Where the slip reaches v_s, it is at most v_s ahead of
                    // one under Coulomb's law, and then grows at the same rate.
                    const double ahead = effective_mass * contact.slip_speed;
                    const double slides = earth_gravity * (sine - friction * cosine);
                    result.add(within(subject, "acceleration (m/s²)", acceleration, slides,
                                      2 * ahead / (slides * time) + step / time));
                    result.add(within(subject, "growth of the slip (m/s²)", (slip - slip_at_half) / (half * step),
                                      earth_gravity * (sine - 3.5 * friction * cosine), 1e-5));
                }
            });
        }
    }
}

/// The greatest step at which a slip below the slip speed does not grow, by bisection.
double greatest_step_of(const stiff_setting& setting, const integrator_info& stepping, const rubbing& contact) {
    const incline ground;
    const stepped_world world = ball_on_incline(ground, contact, contact.slip_speed / 2);
    double stable = 0.5 * decay_of_slip(contact), unstable = 4 * decay_of_slip(contact);
    while (unstable - stable > 1e-3 * stable) {
        const double step = (stable + unstable) / 2;
        simulation ball(world, setting, stepping);
        for (int s = 0; s < 2000; ++s) ball.advance(step);
        (std::abs(slip_of(ball, ground)) < contact.slip_speed / 2 ? stable : unstable) = step;
    }
    return stable;
}

/// Below the slip speed, friction is a dashpot of μ N/v_s, so that explicit integrators multiply the slip by 1 - dt μ
/// N/ (m v_s) per step, with the effective mass m: they need dt < 2 m v_s/(μ N). Verlet's velocity lags by a step, with
/// the same limit: the roots of z² - (1 - h/2) z + h/2 leave the unit circle at h = 2.
void measure_limits(const stiff_setting& setting, stiff_result& result) {
    const rubbing contact{.friction = friction, .slip_speed = 1e-4};
    const double limit = 2 * decay_of_slip(contact);
    for (const integrator_info& i : integrators_of(setting))
        if (i.is_symplectic() && i.stable_below <= 2)
            result.add(within(std::string(i.name), "greatest stable step (s)", greatest_step_of(setting, i, contact),
                              limit, 0.01));
}

/// Adds published results of SimBenchmark's rolling test: 25 balls on a box that is pushed for 4 s along an axis or
/// along the diagonal of two. The error is the mean over time of the squared errors of the speeds of a ball and of the
/// box.
void add_published(stiff_result& result) {
    struct published_error {
        std::string_view simulator;
        double along_axis, along_diagonal;  // m²/s²
    };
    for (const auto& [simulator, along_axis, along_diagonal] :
         std::initializer_list<published_error>{{"RAI without ERP", 4.1268e-07, 4.13711e-07},
                                                {"Bullet without ERP", 4.93482e-09, 5.70654e-09},
                                                {"ODE without ERP", 7.66873e-09, 3.14497},
                                                {"MuJoCo", 0.0092196, 0.00692691},
                                                {"DART", 0.42589, 3.14497}})
        for (const auto& [direction, error] : {std::pair("an axis", along_axis), {"the diagonal", along_diagonal}})
            result.add(reported(fmt::format("published: {}, pushed along {}, 0.001 s", simulator, direction),
                                "speed error, RMS (m/s)", std::sqrt(error)));
}

}  // namespace

void run_rolling(const stiff_setting& setting, stiff_result& result) {
    measure_slide_to_roll(setting, result);
    measure_incline(setting, result);
    measure_limits(setting, result);
    add_published(result);
}

stiff_study rolling_study() {
    return {"rolling",
            "A ball of 1 kg and 0.1 m slides without spin at 1 m/s until friction makes it roll, and is released on "
            "inclines, where it rolls or slides. Its contacts are those of an analytic ball, wherever the mesh around "
            "it is found to touch the floor. Friction with μ = 0.3 is regularised: linear up to a slip speed v_s. The "
            "greatest stable step is that of a slip below it",
            "closed forms for a solid ball: t* = 2v₀/(7μg), x* = 12v₀²/(49μg), v* = 5/7 v₀, 2/7 of the energy lost; it "
            "rolls iff tan θ <= 3.5 μ; with the linear law it creeps by v_s tan θ/(3.5 μ), and explicit steps are "
            "stable below 2 m v_s/(μN), with the effective mass m = 2/7 kg (a linear law in place of that of Castro "
            "et al. 2019, arXiv 1909.05700). Published: SimBenchmark's rolling test (leggedrobotics/SimBenchmark, "
            "data/rolling/default.csv of 9 July 2018), in which ODE and DART do not move along the diagonal; the "
            "authors of "
            "RAI made the benchmark",
            &run_rolling};
}

}  // namespace aabblab
