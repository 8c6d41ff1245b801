module aabblab.stiff;

import :ball_world;
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

/// Published results for this test: the mean squared energy error over 20 s, J². ERP is a correction of penetration.
struct published_error {
    std::string_view simulator;
    double step, error;
};
constexpr published_error published[] = {{"RAI without ERP", 1e-3, 0.0186204},
                                         {"RAI without ERP", 1e-4, 1.86413e-06},
                                         {"RAI", 1e-3, 415.806},
                                         {"RAI", 1e-4, 0.918387},
                                         {"ODE", 1e-3, 185.027},
                                         {"ODE", 1e-4, 1.85055},
                                         {"DART", 1e-3, 72274.4},
                                         {"DART", 1e-4, 483.166},
                                         {"Bullet", 1e-3, 75245.4},
                                         {"Bullet", 1e-4, 752.345}};

/// Depth and sinking speed of a ball.
struct fall {
    double depth, speed;

    explicit fall(const motion_state& state) : depth(depth_of_ball(state)), speed(-speed_of_ball(state)) {}
};

/// The change of energy in a step of central differences, J/kg. Between contacts it does not change. In contact, with
/// the offset x from the depth at rest, v² + ω² (1 - (ω dt)²/4) x² does not change, so the energy does by
/// ω⁴ dt² (x² - x'²)/8. A step that enters the floor from a speed v to the depth d (no force before it, and one at its
/// end) changes it by -ω² d (v dt - d (1 + (ω dt)²/4))/2; one that leaves it is the same in reverse.
double change_by_central_differences(const fall& before, const fall& after, double step) {
    constexpr double square = stiffness / mass;  // ω²
    const double scaled = square * step * step;
    const auto entry = [&](double depth, double speed_without_force) {
        return -square / 2 * depth * (step * speed_without_force - depth * (1 + scaled / 4));
    };
    if (before.depth < 0 && after.depth < 0) return 0;
    if (before.depth < 0) return entry(after.depth, after.speed + step * square * after.depth / 2);
    if (after.depth < 0) return -entry(before.depth, -before.speed + step * square * before.depth / 2);
    const double x = after.depth - gravity / square, x_before = before.depth - gravity / square;
    return square * scaled / 8 * (x * x - x_before * x_before);
}

/// The change of energy in a step of the implicit midpoint, J/kg: only if the step crosses the surface, where the
/// spring acts over the whole step or not at all.
double change_by_implicit_midpoint(const fall& before, const fall& after, double /*step*/) {
    if ((before.depth < 0) == (after.depth < 0)) return 0;
    const double least = std::min(std::abs(before.depth), std::abs(after.depth));
    const double change = stiffness / mass / 2 * least * least;
    return before.depth < 0 ? change : -change;
}

/// The change of energy in a step of an integrator of order 2; null for others.
auto predicted_change_of(const integrator_info& i) {
    using change_of_step = double (*)(const fall&, const fall&, double);
    if (i.name == "velocity_verlet") return change_of_step{&change_by_central_differences};
    if (i.name == "implicit_midpoint") return change_of_step{&change_by_implicit_midpoint};
    return change_of_step{nullptr};
}

/// Statistics of a relative energy error over a run.
class energy_error {
public:
    explicit energy_error(std::size_t steps) : steps_(steps) {}

    void add(double error) {
        const auto count = static_cast<double>(steps_);
        mean_square_ += error * error / count;
        if (added_ < steps_ / 4) creep_ -= 4 * error / count;
        if (added_ >= steps_ - steps_ / 4) creep_ += 4 * error / count;
        ++added_;
    }
    [[nodiscard]] double rms() const { return std::sqrt(mean_square_); }
    /// The change from the mean of the first quarter to that of the last.
    [[nodiscard]] double creep() const { return creep_; }

private:
    std::size_t steps_, added_ = 0;
    double mean_square_ = 0, creep_ = 0;
};

}  // namespace

/// Lets the balls bounce without loss with each symplectic integrator, and reports the error of their energy beside the
/// published one. With order 2, the energy must change as predicted from where the steps enter and leave the floor.
void run_bouncing(const stiff_setting& setting, stiff_result& result) {
    const stepped_world world = bouncing_balls();
    const double initial_energy = 49 * mass * gravity * height;  // of 7 by 7 balls
    const double seconds = setting.quick ? 4 : duration;
    for (const double step : {1e-3, 1e-4}) {
        if (setting.quick && step < 1e-3) break;
        for (const integrator_info& i : integrators_of(setting)) {
            if (!i.is_symplectic()) continue;
            run_or_record_failure(result, i.name, [&] {
                simulation balls(world, setting.tested, i);
                const auto steps = static_cast<std::size_t>(std::llround(seconds / step));
                energy_error measured(steps), predicted(steps);
                const auto predicted_change = predicted_change_of(i);
                double predicted_error = 0;
                const std::string subject = std::string(i.name) + ", " + short_number(step) + " s";
                for (std::size_t s = 0; s < steps; ++s) {
                    const fall before(balls.state());
                    balls.advance(step);
                    const double error = balls.energy() / initial_energy - 1;
                    measured.add(error);
                    // All balls move alike.
                    if (predicted_change)
                        predicted_error += predicted_change(before, fall(balls.state()), step) / (gravity * height);
                    predicted.add(predicted_error);
                    if (s % (steps / 200) == 0) result.plot("bouncing_energy", subject, balls.state().time, error);
                    if (s % 1000 == 0) setting.progress(static_cast<double>(s) / static_cast<double>(steps));
                }
                // Both are sums of the same numbers but for rounding. A step rounds the position, up to the height,
                // once or twice, and the velocity twice: relative to the initial energy, 2 u and 4 u. In contact the
                // spring is 145 times as strong as gravity, at positions below a 70th of the height: 2 u. The
                // prediction rounds alike.
                constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
                const double rounding = 16 * unit * static_cast<double>(steps);
                const auto as_predicted = [&](const char* quantity, double value, double expected) {
                    result.add(expected_if(predicted_change != nullptr,
                                           within(subject, quantity, value, expected, rounding / std::abs(expected))));
                };
                as_predicted("energy error, RMS", measured.rms(), predicted.rms());
                as_predicted("energy creep, first quarter to last", measured.creep(), predicted.creep());
            });
        }
        for (const published_error& p : published)
            if (p.step == step)
                result.add(reported(std::string(p.simulator) + ", " + short_number(step) + " s (published)",
                                    "energy error, RMS", std::sqrt(p.error) / initial_energy));
    }
}

stiff_study bouncing_study() {
    return {
        "bouncing",
        "49 balls of 10 kg fall 5 m and bounce without loss for 20 s (4 s with --quick) on springs of 2e5 N/m. Errors "
        "of their energy are relative to the initial energy; creep is the change of their mean. Integrators of order 2 "
        "change the energy only where a step enters or leaves the floor",
        "the energy of each integrator of order 2 in closed form, from where its steps cross the surface: central "
        "differences change it in a bounce by (dt·ω)² (p' - p'² - p + p²), with the shares p and p' of these steps in "
        "the floor, a random walk of (dt·ω)²/√90 a bounce. Published: SimBenchmark's bouncing test "
        "(leggedrobotics/SimBenchmark, data/bouncing/sample.csv of 19 July 2018), simulators with impulses, over 20 s; "
        "the authors of "
        "RAI made the benchmark",
        &run_bouncing,
        {figure{.name = "bouncing_energy",
                .caption = "Energy error of 49 balls that bounce without loss, relative to the initial energy.",
                .x = {"time (s)"},
                .y = {"relative energy error"}}}};
}

}  // namespace aabblab
