module aabblab.stiff;

import :ball_world;
import :rules;
import :simulation;
import aabblab.statistics;

namespace aabblab {

namespace {

constexpr double frequency = 1e3;             // ω of the contact, 1/s
constexpr double speed = 1;                   // m/s
constexpr double adaptive_tolerance = 1e-11;  // of adaptive integrators
constexpr double scaled_step = 0.05;          // dt·ω of most bounces

/// What tolerances add up to, at most, over a trajectory: one per detection, relative to the greatest depth v/ω.
double sum_of_tolerances(std::size_t detections) {
    return adaptive_tolerance * static_cast<double>(detections) * frequency / speed;
}

struct trajectory_error {
    double greatest = 0;
    std::size_t detections = 0;
};

/// Lets a ball hit the floor without a dashpot, and compares position and velocity with the closed form after each step
/// until it separates, relative to the greatest depth v/ω and to the speed v.
trajectory_error error_of(const candidate& tested, const integrator_info& stepping, double step) {
    const oscillator contact{frequency};
    const stepped_world world = ball_on_floor(contact, speed);
    simulation ball(world, tested, stepping, adaptive_tolerance);
    trajectory_error error;
    for (ball.advance(step); ball.state().time <= contact.contact_time(); ball.advance(step)) {
        const double time = ball.state().time;
        const double depth_error = depth_of_ball(ball.state()) - contact.depth(speed, time);
        const double speed_error = speed_of_ball(ball.state()) + contact.sinking(speed, time);
        error.greatest = std::max(error.greatest, std::hypot(depth_error * frequency, speed_error) / speed);
    }
    error.detections = ball.detections();
    return error;
}

/// A single contact, from touching to separating.
struct bounce {
    double contact_time = 0, restitution = 0;
    std::size_t detections = 0;
};

/// Lets a ball hit the floor until it is back at its surface, or for four contact times. No step goes beyond the
/// surface, where a dashpot's force ends at once: the contact continues with an eighth of the step from the last state
/// inside, again and again, so that neither time nor speed is read late.
bounce bounce_of(const oscillator& contact, const candidate& tested, const integrator_info& stepping) {
    constexpr double step = scaled_step / frequency;
    stepped_world world = ball_on_floor(contact, speed);
    bounce result;
    for (double part = step; part > 1e-10 * step; part /= 8) {
        simulation ball(world, tested, stepping, adaptive_tolerance);
        motion_state inside = ball.state();
        while (result.contact_time + inside.time < 4 * contact.contact_time()) {
            ball.advance(part);
            if (depth_of_ball(ball.state()) < 0) break;
            inside = ball.state();
        }
        world.bodies[1].position[2] = -depth_of_ball(inside);
        world.bodies[1].velocity[2] = speed_of_ball(inside);
        result.contact_time += inside.time;
        result.restitution = speed_of_ball(inside) / speed;
        result.detections += ball.detections();
    }
    return result;
}

/// Bounds of the errors of a bounce, relative.
struct bounce_bounds {
    double contact_time, restitution;
};

/// Derives bounds for a step h = y/ω. An integrator computes another oscillator: its eigenvalue λ is off by at most
/// that of the half period, s = E y^order/π relative to ω, and by the next order, a factor of y smaller. Over the phase
/// θ = ω t of the force, the speed changes by s θ, and the time at which the force ends by s θ/√(1-ζ²), with which the
/// speed decays by ζ; without pull, by s (θ + 2)/√(1-ζ²), as the phase depends on ζ, and the flight by 2 s. A velocity
/// that is a lag old acts as a mass that is c·lag too small, and another ζ lag² y² (compared with the eigenvalues of
/// central differences up to ζ = 0.7). Without pull, a step across the end of the force misses at most y²/2 of its
/// impulse, which changes the flight by ζ y².
bounce_bounds bounds_of(const oscillator& contact, const integrator_info& i, std::size_t detections) {
    constexpr double y = scaled_step;
    const double zeta = contact.damping, theta = frequency * contact.force_time();
    const double phase = contact.may_pull ? 0 : 2, kink = contact.may_pull ? 0 : y * y;
    const double mass = 1 - 2 * zeta * y * i.velocity_lag;
    const oscillator late{frequency / std::sqrt(mass), zeta / std::sqrt(mass), contact.may_pull};
    const double lag = i.velocity_lag * y;
    const double s = i.half_period_error / std::numbers::pi * std::pow(y, i.order) * (1 + y) + zeta * lag * lag;
    const double delay = s * (theta + phase) / std::sqrt(1 - zeta * zeta);
    const double sum = i.adaptive ? sum_of_tolerances(detections) : 0;
    return {(delay + s * phase + zeta * kink) / (frequency * contact.contact_time()) +
                std::abs(late.contact_time() / contact.contact_time() - 1) + sum,
            s * theta + zeta * delay + kink / 2 + std::abs(late.restitution() / contact.restitution() - 1) + sum};
}

/// The slope of log error over log step.
double order_of(std::span<const double> steps, std::span<const double> errors) {
    std::vector<double> x, y;
    for (const double step : steps) x.push_back(std::log(step));
    for (const double error : errors) y.push_back(std::log(error));
    return line_through(x, y).slope;
}

/// Lets a ball bounce without a dashpot, and adds each integrator's error at the smallest step and measured order.
void measure_convergence(const stiff_setting& setting, stiff_result& result) {
    constexpr std::array steps = {0.4, 0.2, 0.1, scaled_step};
    for (const integrator_info& i : integrators_of(setting)) {
        std::vector<trajectory_error> errors;
        run_or_record_failure(result, i.name, [&] {
            for (const double y : steps) errors.push_back(error_of(setting.tested, i, y / frequency));
        });
        if (errors.size() < steps.size()) continue;  // the integrator failed
        std::vector<double> greatest;
        for (const trajectory_error& error : errors) greatest.push_back(error.greatest);
        for (std::size_t s = 0; s < steps.size(); ++s)
            result.plot("ball_error_over_step", i.name, steps[s], greatest[s]);
        const std::string subject = std::string(i.name) + ", dt·ω " + short_number(scaled_step);
        constexpr auto quantity = "trajectory error (relative)";
        if (i.adaptive) {
            result.add(at_most(subject, quantity, greatest.back(), sum_of_tolerances(errors.back().detections)));
            continue;
        }
        // The next term is smaller by a factor of dt·ω, and the last step ends up to a step before the half period.
        result.add(within(subject, quantity, greatest.back(), i.half_period_error * std::pow(scaled_step, i.order),
                          2 * scaled_step));
        result.add(at_least(std::string(i.name), "order of convergence", order_of(steps, greatest), i.order - 0.1));
    }
}

/// Lets a ball bounce with a weak and a strong dashpot, which may pull or not, and compares contact time and
/// restitution with the closed form.
void measure_contacts(const stiff_setting& setting, stiff_result& result) {
    for (const bool pulls : {true, false})
        for (const double damping : {0.1, 0.5}) {
            const oscillator contact{frequency, damping, pulls};
            for (const integrator_info& i : integrators_of(setting))
                run_or_record_failure(result, i.name, [&] {
                    const bounce measured = bounce_of(contact, setting.tested, i);
                    const bounce_bounds bounds = bounds_of(contact, i, measured.detections);
                    const std::string subject =
                        std::string(i.name) + ", ζ " + short_number(damping) + (pulls ? "" : ", no pull");
                    result.add(within(subject, "contact time (s)", measured.contact_time, contact.contact_time(),
                                      bounds.contact_time));
                    result.add(within(subject, "restitution", measured.restitution, contact.restitution(),
                                      bounds.restitution));
                });
        }
}

constexpr std::array<std::string_view, 2> law_names = {"dashpot may pull", "no pull"};

/// Plots the restitution over the damping ratio for both laws, measured and by the closed form.
void plot_restitution(const stiff_setting& setting, stiff_result& result) {
    for (const bool pulls : {true, false}) {
        const std::string law(law_names[pulls ? 0 : 1]);
        for (double damping = 0.05; damping < 0.99; damping += 0.05) {
            const oscillator contact{frequency, damping, pulls};
            result.plot("restitution_over_damping", law + ", closed form", damping, contact.restitution());
            result.plot("restitution_over_damping", law, damping,
                        bounce_of(contact, setting.tested, *integrator_named("runge_kutta_4")).restitution);
        }
    }
}

}  // namespace

void run_ball_bounces(const stiff_setting& setting, stiff_result& result) {
    measure_convergence(setting, result);
    measure_contacts(setting, result);
    plot_restitution(setting, result);
}

stiff_study ball_bounces_study() {
    return {
        "ball_bounces",
        "A ball of 1 kg hits a floor at 1 m/s. The contact is a linear spring of ω = √(k/m) = 1000/s. The trajectory "
        "error is measured without a dashpot, relative to the greatest depth and speed. Contact time, until the ball "
        "is back at the surface, and restitution are measured with a dashpot of damping ratio ζ, which may pull the "
        "ball while it leaves, or not, at the time step dt = 0.05/ω. adaptive_dormand_prince equals dormand_prince "
        "where one step meets its tolerance",
        "closed form of the damped oscillator. A dashpot that pulls lets go at the surface, after π/(ω√(1-ζ²)): "
        "restitution exp(-πζ/√(1-ζ²)). Without pull, the force ends after 2 acos ζ/(ω√(1-ζ²)): "
        "exp(-2ζ acos ζ/√(1-ζ²)) (Schwager and Pöschel 2007, arXiv cond-mat/0701278). Errors: the leading term of each "
        "integrator",
        &run_ball_bounces,
        {figure{.name = "ball_error_over_step",
                .caption = "Error of the ball's position and velocity during contact over the step size. It falls "
                           "with the order of each integrator.",
                .x = {"step times angular frequency", /*logarithmic=*/true},
                .y = {"trajectory error (relative)", /*logarithmic=*/true}},
         figure{.name = "restitution_over_damping",
                .caption = "Restitution over the damping ratio of a linear spring with a dashpot: whether the dashpot "
                           "may pull decides it. Points are measured, lines the closed forms.",
                .x = {"damping ratio"},
                .y = {"restitution"},
                .lines = {{"dashpot may pull", series_style::points},
                          {"no pull", series_style::points},
                          {"dashpot may pull, closed form"},
                          {"no pull, closed form"}}}}};
}

}  // namespace aabblab
