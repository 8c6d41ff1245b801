module aabblab.stiff;

import :rules;
import :shapes;
import :simulation;

namespace aabblab {

namespace {

constexpr double stiffness = 1e6;  // N/m
constexpr double gravity = 9.81;   // m/s²
constexpr double edge = 0.25;      // m
constexpr std::size_t bodies = 10;

/// Ten stacked pyramids with masses in geometric progression, from 1 kg at the bottom to `ratio` kg at the top. The
/// dashpots are critical for the slowest oscillation, of the total mass M on n springs in series. Their stiffness is
/// k/n and their damping c/n, so c/n = 2 √(M k/n).
stepped_world stack_of(double ratio) {
    stepped_world world;
    world.meshes = {floor_of(4), hanging_pyramid(edge, 2 * edge)};
    world.bodies = {{}};  // the fixed floor
    double total_mass = 0;
    for (std::size_t i = 0; i < bodies; ++i) {
        const auto level = static_cast<double>(i);
        const double mass = std::pow(ratio, level / (bodies - 1));
        total_mass += mass;
        // Apexes must not touch the diagonals between triangles.
        world.bodies.push_back({.mesh = 1, .position = {0.05 + 0.002 * level, 0.01, edge * level}, .mass = mass});
    }
    world.law.stiffness = stiffness;
    world.law.damping = 2 * std::sqrt(bodies * stiffness * total_mass);
    world.gravity = gravity;
    return world;
}

/// The depth of body i in the one below, m.
double depth_of(const motion_state& state, std::size_t i) {
    const double below = i == 1 ? 0 : state.position[3 * (i - 1) + 2] + edge;
    return below - state.position[3 * i + 2];
}

}  // namespace

/// Compares the depth of each settled body in the one below with mg/k, with the mass m of it and those above. Explicit
/// Verlet runs only where masses are similar: more mass needs a stronger dashpot, and so shorter steps.
void run_stack(const stiff_setting& setting, stiff_result& result) {
    for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
        const stepped_world world = stack_of(ratio);
        for (const integrator_info& i : integrators_of(setting)) {
            // The dashpot limits explicit integrators to steps of a quarter of m/c.
            const double step = i.name == "velocity_verlet" ? 0.25 / world.law.damping : 0.05;
            if (i.name != "bdf" && (i.name != "velocity_verlet" || ratio > (setting.quick ? 1 : 10))) continue;
            run_or_record_failure(result, i.name, [&] {
                simulation stack(world, setting.tested, i, /*tolerance=*/1e-9);
                double greatest = 0;  // depth of the lowest body
                const double end = 2;
                while (stack.state().time < end) {
                    stack.advance(step);
                    greatest = std::max(greatest, depth_of(stack.state(), 1));
                    setting.progress(stack.state().time / end);
                }
                double worst = 0;  // relative error of a depth
                double mass = 0;   // of body b and those above
                for (std::size_t b = bodies; b > 0; --b) {
                    mass += world.bodies[b].mass;
                    worst = std::max(worst, std::abs(depth_of(stack.state(), b) * stiffness / (mass * gravity) - 1));
                }
                const std::string subject = std::string(i.name) + ", masses up to " + short_number(ratio) + " kg";
                result.add(within(subject, "greatest depth (m)", greatest, mass * gravity / stiffness, 0.01));
                result.add(at_most(subject, "relative error of the depths at rest", worst, 1e-3));
                result.add(reported(subject, "detections", static_cast<double>(stack.detections())));
            });
        }
    }
}

stiff_study stack_study() {
    return {"stack",
            "Ten stacked bodies, heavy ones above light ones, on springs of 1e6 N/m and dashpots that damp the slowest "
            "mode critically. The study measures how deep each is in the one below after 2 s",
            "mg/k, where m is the total mass above; the scenes resemble HighMassRatio1 of Box2D and HeavyOnLightTest "
            "of Jolt",
            &run_stack};
}

}  // namespace aabblab
