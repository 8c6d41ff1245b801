module aabblab.stiff;

import :method;
import :rules;
import :shapes;
import :simulation;
import aabb.geometry;
import aabblab.fmt;
import aabblab.scenes;

namespace aabblab {

namespace {

struct trajectory {
    std::vector<std::vector<double>> positions;  ///< of all bodies, by sampled step
    double detection_ms = 0;
    double energy_error = 0;            ///< the root mean square of twenty samples, relative to the initial energy
    std::vector<double> times, depths;  ///< twenty samples of `greatest_depth`
};

/// A lattice of balls that fall on a floor.
class dropped_balls {
public:
    /// @param side number of balls along an edge of the lattice
    /// @param diameter m
    dropped_balls(std::size_t side, double diameter) : diameter_(diameter) {
        // Of the fall, 5 diameters, only the last half diameter is simulated; the rest has a closed form, v² = 2 g h.
        const double fallen = 4.5 * diameter;
        world_ =
            dropped_world({.balls = static_cast<std::uint32_t>(side * side * side),
                           .height = 0.5,
                           .speed = std::sqrt(2 * 9.81 * fallen)},
                          {make_mesh("square").mesh, scaled(make_mesh("icosphere:triangles=80").mesh, diameter / 2)},
                          /*seed=*/1);
    }

    /// Scales a time for balls of 1 m to these balls, s.
    [[nodiscard]] double seconds(double for_1_m) const { return for_1_m * std::sqrt(diameter_); }

    /// Simulates the fall with the contacts that the candidate finds. Samples the greatest depth, and the energy on
    /// request, twenty times. Ends early if bodies leave the range of valid poses.
    /// @param stored_every the interval of the stored positions, in steps
    /// @throws aabb::input_error if it ends before the first of its twenty samples.
    /// @param tolerance of an adaptive integrator
    [[nodiscard]] trajectory run(const candidate& tested, const integrator_info& stepping, double step,
                                 std::size_t stored_every, bool with_energy, double tolerance = 0) const {
        trajectory t;
        simulation balls(world_, tested, stepping, tolerance);
        balls.time_detections();
        const double initial_energy = dynamics(world_).mechanical_energy(balls.state());
        const auto steps = static_cast<std::size_t>(std::llround(seconds(end) / step));
        double squares = 0;  // of relative energy errors
        const std::size_t sample_interval = std::max<std::size_t>(steps / 20, 1);
        for (std::size_t s = 1; s <= steps; ++s) {
            try {
                balls.advance(step);
            } catch (const aabb::input_error&) {
                if (t.depths.empty()) throw;
                break;
            }
            if (s % stored_every == 0) t.positions.push_back(balls.state().position);
            if (s % sample_interval != 0) continue;
            t.times.push_back(balls.state().time);
            t.depths.push_back(greatest_depth(balls.state().position));
            if (with_energy) squares += std::pow(energy_of(balls) / initial_energy - 1, 2);
        }
        t.energy_error = std::sqrt(squares / static_cast<double>(t.times.size()));
        t.detection_ms = balls.detection_ms();
        return t;
    }

    /// How far a trajectory departs from the reference: by stored step, the greatest difference of any coordinate of
    /// any ball, in diameters. Infinite after the trajectory's end, if it ended early.
    [[nodiscard]] std::vector<double> departures(const trajectory& t, const trajectory& reference) const {
        std::vector<double> errors;
        for (std::size_t s = 0; s < std::min(t.positions.size(), reference.positions.size()); ++s) {
            double greatest = 0;
            for (std::size_t i = 0; i < t.positions[s].size(); ++i)
                greatest = std::max(greatest, std::abs(t.positions[s][i] - reference.positions[s][i]) / diameter_);
            errors.push_back(greatest);
        }
        errors.resize(reference.positions.size(), std::numeric_limits<double>::infinity());
        return errors;
    }

private:
    static constexpr double end = 0.48;  // s, for balls of 1 m

    /// Kinetic, potential and contact energy, J; that of a contact is proportional to the overlap volume of two bodies.
    [[nodiscard]] double energy_of(simulation& balls) const {
        double sum = dynamics(world_).mechanical_energy(balls.state());
        std::vector<aabb::pose> poses;
        world_.place(balls.state(), poses);
        const auto placed = [&](std::uint32_t body) {
            return placed_mesh{&world_.meshes[world_.bodies[body].mesh], poses[body]};
        };
        const std::span<const aabb::contact> contacts = balls.contacts();
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const auto& [a, b, s, t] = contacts[i];
            if (i > 0 && contacts[i - 1].a == a && contacts[i - 1].b == b) continue;  // once per pair of bodies
            sum += world_.law.stiffness * overlap_volume(placed(a), /*is_floor=*/a == 0, placed(b));
        }
        return sum;
    }

    /// The greatest overlap of two balls as spheres, in diameters; 0 if none. `p` has the floor as body 0.
    [[nodiscard]] double greatest_depth(const std::vector<double>& p) const {
        double least_distance = diameter_;
        for (std::size_t i = 1; 3 * i < p.size(); ++i)
            for (std::size_t j = i + 1; 3 * j < p.size(); ++j)
                least_distance = std::min(least_distance, std::hypot(p[3 * i] - p[3 * j], p[3 * i + 1] - p[3 * j + 1],
                                                                     p[3 * i + 2] - p[3 * j + 2]));
        return 1 - least_distance / diameter_;
    }

    double diameter_;
    stepped_world world_;
};

constexpr std::array<const char*, 2> sizes{"1 m", "10 mm"};  // diameters of balls

/// "depth_10_mm"
std::string figure_name(std::string words) {
    std::ranges::replace(words, ' ', '_');
    return words;
}

void plot_depths(const std::string& size, const std::string& label, const trajectory& t, stiff_result& result) {
    const std::string depth = figure_name("depth " + size);
    for (std::size_t i = 0; i < t.times.size(); ++i) result.plot(depth, label, t.times[i], t.depths[i]);
}

/// The trajectory with each method. These runs are not timed, so every processor has a thread that takes methods.
std::vector<trajectory> trajectories_of(const std::vector<method>& methods, const dropped_balls& balls, double step,
                                        const stiff_setting& setting) {
    std::vector<trajectory> trajectories(methods.size());
    std::atomic<std::size_t> next_method = 0;
    const auto run = [&](const std::function<void(double)>& progress) {
        for (std::size_t m = next_method++; m < methods.size(); m = next_method++) {
            progress(static_cast<double>(m) / static_cast<double>(methods.size()));
            trajectories[m] = balls.run(methods[m].tested, *integrator_named("velocity_verlet"), step,
                                        /*stored_every=*/1, /*with_energy=*/true);
        }
    };
    std::vector<std::future<void>> workers;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
        workers.push_back(std::async(std::launch::async, run, [](double) {}));
    run(setting.progress);
    for (std::future<void>& worker : workers) worker.get();
    return trajectories;
}

/// Adds rows for an inexact method: how far it departs from exact contacts, from which step on, and its errors.
/// @param errors the departure by step, in diameters
/// @returns whether it departs
bool report_departure(const std::string& subject, const trajectory& t, const std::vector<double>& errors,
                      stiff_result& result) {
    result.add(reported(subject, "greatest deviation (diameters)", std::ranges::max(errors)));
    const auto first = std::ranges::find_if(errors, [](double d) { return !(d <= 0); });  // or NaN
    if (first == errors.end()) return false;
    result.add(reported(subject, "first step that is wrong", static_cast<double>(first - errors.begin()) + 1));
    result.add(reported(subject, "greatest depth of two balls (diameters)", std::ranges::max(t.depths)));
    result.add(reported(subject, "energy error, RMS", t.energy_error));
    return true;
}

/// Compares the trajectory of the balls with each method with that with exact contacts, at one step size. With an exact
/// method it must not depart at all; with others, how far it departs is reported, and drawn for the first nine of them.
/// @param size the diameter of the balls in words, for labels
void compare_methods(const dropped_balls& balls, const std::string& size, const stiff_setting& setting,
                     stiff_result& result) {
    const double step = balls.seconds(1e-3);
    const trajectory reference = balls.run(setting.tested, *integrator_named("velocity_verlet"), step,
                                           /*stored_every=*/1, /*with_energy=*/true);
    std::vector<method> methods = triangle_methods(setting.quick);
    std::erase_if(methods, [](const method& m) { return m.label == "exact"; });  // the reference
    std::ranges::move(tree_and_list_methods(), std::back_inserter(methods));
    const std::vector<trajectory> trajectories = trajectories_of(methods, balls, step, setting);
    constexpr std::size_t most_drawn = 9;
    std::size_t drawn = 0;
    const std::string departure = figure_name("departure " + size);
    for (std::size_t m = 0; m < methods.size(); ++m) {
        const trajectory& t = trajectories[m];
        const std::vector<double> errors = balls.departures(t, reference);
        const std::string subject = methods[m].label + ", " + size;
        if (methods[m].tested.exact && methods[m].tested.exact_boxes) {
            result.add(at_most(subject, "greatest deviation (diameters)", std::ranges::max(errors), 0));
            continue;
        }
        if (!report_departure(subject, t, errors, result) || drawn == most_drawn) continue;
        if (drawn++ == 0) plot_depths(size, "exact", reference, result);
        for (std::size_t s = 0; s < errors.size(); ++s)
            result.plot(departure, methods[m].label, step * static_cast<double>(s + 1), errors[s]);
        plot_depths(size, methods[m].label, t, result);
    }
    result.add(
        reported("exact, " + size, "greatest depth of two balls (diameters)", std::ranges::max(reference.depths)));
    result.add(reported("exact, " + size, "energy error, RMS", reference.energy_error));
}

/// Plots error over detection time, for each integrator with several steps or tolerances and for stale Verlet lists,
/// against a 16th of the smallest step. The energy error of symplectic integrators is bounded, and must fall with the
/// step to the power of the order; that of others drifts.
void compare_steps(const dropped_balls& balls, const stiff_setting& setting, stiff_result& result) {
    const std::vector<double> steps =
        setting.quick ? std::vector{4e-3, 2e-3, 1e-3} : std::vector{4e-3, 2e-3, 1e-3, 5e-4};
    const std::vector<double> tolerances =
        setting.quick ? std::vector{1e-2, 1e-3, 1e-4} : std::vector{1e-2, 1e-3, 1e-4, 1e-5};
    // Trajectories of all step sizes are stored at the same times, those of the greatest step.
    const auto stored_every = [&](double dt) { return static_cast<std::size_t>(std::llround(steps.front() / dt)); };
    const integrator_info& verlet = *integrator_named("velocity_verlet");
    const double finest = steps.back() / 16;
    const trajectory reference = balls.run(setting.tested, verlet, finest, stored_every(finest), /*with_energy=*/false);
    const auto error_of = [&](const trajectory& t) { return balls.departures(t, reference).back(); };
    constexpr auto error_at_end = "trajectory error at the end (diameters)";
    for (const integrator_info& i : integrators_of(setting))
        run_or_record_failure(result, i.name, [&] {
            std::vector<double> energy_errors;
            for (const double knob : i.adaptive ? tolerances : steps) {
                const double dt = i.adaptive ? steps.front() : knob;
                const trajectory t = balls.run(setting.tested, i, dt, stored_every(dt), /*with_energy=*/true, knob);
                const double error = error_of(t);
                result.plot("error_over_time", i.name, t.detection_ms, error,
                            i.adaptive ? fmt::format("{:.0e}", knob) : short_number(1e3 * knob) + " ms");
                const std::string subject = std::string(i.name) + (i.adaptive ? ", tolerance " : ", ") +
                                            short_number(knob) + (i.adaptive ? "" : " s");
                result.add(reported(subject, error_at_end, error));
                result.add(reported(subject, "energy error, RMS", t.energy_error));
                energy_errors.push_back(t.energy_error);
            }
            if (!i.is_symplectic()) return;
            // Each step size is half of the previous one.
            const double measured_order =
                std::log2(energy_errors.front() / energy_errors.back()) / static_cast<double>(steps.size() - 1);
            result.add(at_least(std::string(i.name), "order of the energy error", measured_order, i.order - 0.3));
        });
    for (const char* const every : {"8", "16", "32", "64"}) {
        const method m = composed_with(std::string("prepare neighbour_list:margin=0,every=") + every);
        const trajectory t = balls.run(m.tested, verlet, 1e-3, stored_every(1e-3), /*with_energy=*/false);
        result.plot("error_over_time", "velocity_verlet, neighbour_list:margin=0", t.detection_ms, error_of(t),
                    std::string("every ") + every);
    }
}

/// The figures of the study, two of them for each size of the balls, still without points.
std::vector<figure> figures() {
    std::vector<figure> list{figure{
        .name = "error_over_time",
        .caption = "Error of a trajectory over the processor time of its collision detection, in one run: each "
                   "integrator over its step "
                   "size, adaptive ones over their tolerance, and a stale Verlet list over the frames between its "
                   "rebuilds, with steps of 1 ms.",
        .x = {"detection (ms of processor time)", /*logarithmic=*/true},
        .y = {"greatest error of a position (diameters)", /*logarithmic=*/true}}};
    const figure_axis time{"time (s)"};
    for (const std::string size : sizes) {
        list.push_back(
            {figure_name("departure " + size),
             "How far balls of " + size +
                 " depart from their trajectory with exact contacts, because of a triangle test, an engine or a stale "
                 "Verlet list. At most nine of the methods that depart are drawn.",
             time,
             {"greatest deviation (diameters)", /*logarithmic=*/true}});
        list.push_back({figure_name("depth " + size),
                        "The greatest penetration of two balls of " + size +
                            ", with exact contacts and with those of the methods that depart.",
                        time,
                        {"greatest depth (diameters)"}});
    }
    return list;
}

}  // namespace

/// Compares step sizes with balls of 1 m, and methods with balls of 1 m (not with --quick) and of 10 mm.
void run_dropped(const stiff_setting& setting, stiff_result& result) {
    const std::size_t side = setting.quick ? 3 : 6;
    const dropped_balls balls(side, /*diameter=*/1);
    if (!integrators_of(setting).empty()) compare_steps(balls, setting, result);
    // The published value is the mean squared error over the run, J², of an energy of 34,454 J.
    constexpr std::pair<const char*, double> published[] = {{"RAI without ERP", 8.36835},
                                                            {"ODE", 112.326},
                                                            {"RAI", 3537.39},
                                                            {"Bullet without ERP", 41498.1},
                                                            {"DART", 346909}};
    for (const auto& [simulator, error] : published)
        result.add(reported(std::string("published: ") + simulator + ", 0.001 s, over 10 s", "energy error, RMS",
                            std::sqrt(error) / 34454));
    // With balls of 1 m only stale lists depart, as with those of 10 mm.
    if (!setting.quick) compare_methods(balls, sizes[0], setting, result);
    compare_methods(dropped_balls(side, /*diameter=*/0.01), sizes[1], setting, result);
}

stiff_study dropped_study() {
    return {
        "dropped",
        "216 balls (27 with --quick) of 80 triangles fall 5 diameters on a floor and on each other, without loss. A "
        "pressure on the surface of one ball inside the other separates them. The study shows how the step size "
        "and each method change the trajectory; lists with margin=0 may miss contacts by design",
        "the trajectory with exact contacts; energy errors that fall with the order of the integrator; SimBenchmark's "
        "elastic 666 test (leggedrobotics/SimBenchmark, data/666-elastic/sample.csv of 12 August 2018), simulators "
        "with impulses; the "
        "authors of RAI made the benchmark",
        &run_dropped,
        figures(),
        /*compares_methods=*/true};
}

}  // namespace aabblab
