module aabblab.stiff;

import :rules;
import :shapes;
import :simulation;

namespace aabblab {

namespace {

constexpr double height = 5;      // m
constexpr double mass = 10;       // kg
constexpr double gravity = 9.81;  // m/s²
// As soft as the size of a ball allows: the depth is 71 mm, and 1 ms is 5 % of the contact time.
constexpr double stiffness = 2e5;  // N/m
constexpr double duration = 20;    // s

/// Seven by seven balls above a floor, too far from each other to touch.
stepped_world bouncing_balls() {
    stepped_world world;
    world.meshes = {floor_of(8), octahedron(0.1F)};
    world.bodies = {{}};
    // Body 0 is the fixed floor. The balls must not hit the diagonal between two of its triangles.
    for (int x = 0; x < 7; ++x)
        for (int y = 0; y < 7; ++y)
            world.bodies.push_back({.mesh = 1, .position = {x - 3.1, 0.9 * y - 2.8, height}, .mass = mass});
    world.law.stiffness = stiffness;
    world.gravity = gravity;
    return world;
}

/// Published results of two simulators for this test: the mean squared energy error over 20 s, J².
struct published_errors {
    double step, ode, dart;
};
constexpr published_errors published[] = {{1e-3, 185.027, 72274.4}, {1e-4, 1.85055, 483.166}};

}  // namespace

/// Lets the balls bounce without loss with each symplectic integrator, and reports the error of their energy beside the
/// published one. With order 2, it must be below a limit and not creep: last quarter against first.
void run_bouncing(const stiff_setting& setting, stiff_result& result) {
    const stepped_world world = bouncing_balls();
    const double initial_energy = 49 * mass * gravity * height;  // of 7 by 7 balls
    const double seconds = setting.quick ? 4 : duration;
    for (const published_errors& reference : published) {
        if (setting.quick && reference.step < 1e-3) break;
        for (const integrator_info& i : integrators()) {
            if (!i.is_symplectic()) continue;
            run_or_record_failure(result, i.name, [&] {
                simulation balls(world, setting.tested, i);
                const auto steps = static_cast<std::size_t>(std::llround(seconds / reference.step));
                double mean_square = 0, first_quarter = 0, last_quarter = 0;
                const std::string subject = std::string(i.name) + ", " + short_number(reference.step) + " s";
                for (std::size_t s = 0; s < steps; ++s) {
                    balls.advance(reference.step);
                    const double error = balls.energy() / initial_energy - 1;
                    mean_square += error * error / static_cast<double>(steps);
                    if (s < steps / 4) first_quarter += 4 * error / static_cast<double>(steps);
                    if (s >= steps - steps / 4) last_quarter += 4 * error / static_cast<double>(steps);
                    if (s % (steps / 200) == 0) result.plot("bouncing_energy", subject, balls.state().time, error);
                    if (s % 1000 == 0) setting.progress(static_cast<double>(s) / static_cast<double>(steps));
                }
                // Second order: the square of the step relative to the time scale of the contact, 1/ω.
                const double limit = reference.step * reference.step * stiffness / mass;
                const double rms = std::sqrt(mean_square), creep = std::abs(last_quarter - first_quarter);
                result.add(expected_if(i.order == 2, at_most(subject, "energy error, RMS", rms, limit)));
                result.add(expected_if(i.order == 2,
                                       at_most(subject, "energy creep, first quarter to last", creep, limit / 4)));
            });
        }
        result.add(reported("published: ODE, " + short_number(reference.step) + " s, over 20 s", "energy error, RMS",
                            std::sqrt(reference.ode) / initial_energy));
        result.add(reported("published: DART, " + short_number(reference.step) + " s, over 20 s", "energy error, RMS",
                            std::sqrt(reference.dart) / initial_energy));
    }
}

stiff_study bouncing_study() {
    return {
        "bouncing",
        "49 balls of 10 kg fall 5 m and bounce without loss for 20 s (4 s with --quick) on springs of 2e5 N/m. Their "
        "energy must not drift; errors are relative to the initial energy; creep is the change of their mean",
        "SimBenchmark's bouncing test (leggedrobotics/SimBenchmark, data/bouncing/sample.csv): the errors of ODE and "
        "DART with impulses",
        &run_bouncing,
        {figure{.name = "bouncing_energy",
                .caption = "Energy error of 49 balls that bounce without loss, relative to the initial energy.",
                .x = {"time (s)"},
                .y = {"relative energy error"}}}};
}

}  // namespace aabblab
