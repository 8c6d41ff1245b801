module aabblab.stiff;

import :ball_world;
import :rules;
import :simulation;
import aabblab.statistics;

namespace aabblab {

namespace {

constexpr double speed = 1;                  // m/s
constexpr double adaptive_tolerance = 1e-9;  // of adaptive integrators

/// A single contact, from touching to separating.
struct bounce {
    double error = 0;  // the greatest error of position and velocity, relative to the undamped ball
    double contact_time = 0, restitution = 0;
};

/// Lets a ball hit the floor, until it separates or for four contact times, and compares position and velocity with the
/// closed form after each step. The time of separation is interpolated between the last two steps.
bounce bounce_of(const oscillator& contact, const candidate& tested, const integrator_info& stepping, double step) {
    const stepped_world world = ball_on_floor(contact, speed);
    simulation ball(world, tested, stepping, adaptive_tolerance);
    bounce result;
    double previous_depth = 0;
    for (double end = 4 * contact.contact_time(); ball.state().time < end;) {
        ball.advance(step);
        const double time = ball.state().time;
        const double depth = depth_of_ball(ball.state());
        // The error of position, relative to the greatest depth v/ω, and that of velocity, relative to v.
        if (time <= contact.contact_time())
            result.error = std::max(
                result.error, std::hypot((depth - contact.depth(speed, time)) * contact.frequency / speed,
                                         speed_of_ball(ball.state()) / speed + contact.sinking(speed, time) / speed));
        if (depth < 0) {
            result.contact_time = time + step * depth / (previous_depth - depth);
            result.restitution = speed_of_ball(ball.state()) / speed;
            break;
        }
        previous_depth = depth;
    }
    return result;
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
    const oscillator contact{.frequency = 1e3, .damping = 0};
    constexpr std::array steps = {0.4, 0.2, 0.1, 0.05};
    for (const integrator_info& i : integrators()) {
        std::vector<double> errors;
        run_or_record_failure(result, i.name, [&] {
            for (const double scaled_step : steps)
                errors.push_back(bounce_of(contact, setting.tested, i, scaled_step / contact.frequency).error);
        });
        if (errors.size() < steps.size()) continue;  // the integrator failed
        for (std::size_t s = 0; s < steps.size(); ++s) result.plot("ball_error_over_step", i.name, steps[s], errors[s]);
        const std::string subject = std::string(i.name) + ", dt·ω " + short_number(steps.back());
        // The error of a first-order integrator is at most one step.
        result.add(at_most(subject, "trajectory error (relative)", errors.back(), i.order == 1 ? steps.back() : 1e-3));
        if (!i.adaptive)
            result.add(at_least(std::string(i.name), "order of convergence", order_of(steps, errors), i.order - 0.1));
    }
}

/// Lets a ball bounce with a dashpot and compares contact time and restitution with the closed form. Integrators of
/// order 1 are left out: their contact may end a step late.
void measure_contacts(const stiff_setting& setting, stiff_result& result) {
    const double damping = oscillator::damping_for(/*restitution=*/0.5);
    for (const double k : {1e4, 1e6, 1e8, 1e10}) {
        const oscillator contact{std::sqrt(k), damping};
        for (const integrator_info& i : integrators()) {
            if (i.order == 1) continue;
            run_or_record_failure(result, i.name, [&] {
                const bounce measured = bounce_of(contact, setting.tested, i, 0.05 / contact.frequency);
                const std::string subject = std::string(i.name) + ", k " + short_number(k) + " N/m";
                // Boost's central differences apply the dashpot a step late, which shortens contacts by ζ dt·ω.
                const double tolerance = i.order == 2 ? 0.015 : 0.01;  // relative
                result.add(
                    within(subject, "contact time (s)", measured.contact_time, contact.contact_time(), tolerance));
                result.add(within(subject, "restitution", measured.restitution, contact.restitution(), tolerance));
            });
        }
    }
}

}  // namespace

void run_ball_bounces(const stiff_setting& setting, stiff_result& result) {
    measure_convergence(setting, result);
    measure_contacts(setting, result);
}

stiff_study ball_bounces_study() {
    return {"ball_bounces",
            "A ball of 1 kg hits a floor at 1 m/s. The contact is a linear spring. The trajectory error is measured "
            "without a dashpot, relative to the greatest depth and speed. The restitution, 0.5, and the contact time, "
            "from touching the floor to leaving it, are measured with a dashpot, at the time step dt = 0.05/ω, with "
            "ω = √(k/m) and k = 1e4 to 1e10 N/m; symplectic_euler is left out of both, as its contact may end a step "
            "late. adaptive_dormand_prince equals dormand_prince where one step meets its tolerance",
            "closed form of the damped oscillator: contact time π/(ω√(1-ζ²)), restitution exp(-πζ/√(1-ζ²)), with the "
            "damping ratio ζ",
            &run_ball_bounces,
            {figure{.name = "ball_error_over_step",
                    .caption = "Error of the ball's position and velocity during contact over the step size. It falls "
                               "with the order of each integrator.",
                    .x = {"step times angular frequency", /*logarithmic=*/true},
                    .y = {"trajectory error (relative)", /*logarithmic=*/true}}}};
}

}  // namespace aabblab
