module aabblab.stiff;

import :ball_world;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr double gravity = 9.81;
constexpr double damping = 10;  // ζ
constexpr double end = 1;       // s

/// The depth of an overdamped ball that is released on the floor, relative to its depth at rest.
double share_of_rest(double frequency, double time) {
    const double root = std::sqrt(damping * damping - 1);
    const double slow = frequency * (damping - root);
    const double fast = frequency * (damping + root);
    return 1 - (fast * std::exp(-slow * time) - slow * std::exp(-fast * time)) / (fast - slow);
}

}  // namespace

/// Lets an overdamped ball sink into the floor and compares its depth with the closed form, once while it sinks and
/// once after 1 s, by which it rests. Runs adaptive integrators only; the implicit one, bdf, must need few detections.
void run_overdamped(const stiff_setting& setting, stiff_result& result) {
    for (const double k : {1e4, 1e6, 1e8, 1e10}) {
        const double frequency = std::sqrt(k);
        // With central differences, the rate of the dashpot limits steps to 1/(2ζω).
        const double explicit_steps = end * 2 * damping * frequency;
        const stepped_world world = ball_on_floor({frequency, damping}, /*speed_down=*/0, gravity);
        for (const integrator_info& i : integrators_of(setting)) {
            if (!i.adaptive) continue;
            // Other adaptive integrators need as many steps as an explicit one, too many for stiff contacts.
            if (i.name != "bdf" && explicit_steps > (setting.quick ? 1e4 : 1e6)) continue;
            run_or_record_failure(result, i.name, [&] {
                const std::string subject = std::string(i.name) + ", k " + short_number(k) + " N/m";
                simulation ball(world, setting.tested, i, /*tolerance=*/1e-6 * gravity / k);
                // The time constant of the slow decay.
                const double sinking = 1 / (frequency * (damping - std::sqrt(damping * damping - 1)));
                ball.advance(sinking);
                result.add(within(subject, "depth while it sinks over depth at rest",
                                  depth_of_ball(ball.state()) * k / gravity, share_of_rest(frequency, sinking), 1e-3));
                // The tolerance covers the rounding of the sum of steps.
                while (ball.state().time < end * (1 - 1e-9)) ball.advance(std::min(end / 20, end - ball.state().time));
                result.add(within(subject, "depth after 1 s over depth at rest",
                                  depth_of_ball(ball.state()) * k / gravity, share_of_rest(frequency, end), 1e-3));
                const auto detections = static_cast<double>(ball.detections());
                result.add(expected_if(i.name == "bdf", at_most(subject, "detections", detections, 2000)));
            });
        }
    }
}

stiff_study overdamped_study() {
    return {"overdamped",
            "A ball of 1 kg is released on a floor whose dashpot has ten times the critical damping, and sinks for a "
            "second. Its "
            "depth is compared while it sinks, after its time constant, and at the end. An implicit integrator takes "
            "steps as long as the motion allows, and few collision detections; stiffness limits an explicit one",
            "closed form of the overdamped oscillator under gravity", &run_overdamped};
}

}  // namespace aabblab
