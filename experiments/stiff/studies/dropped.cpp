module aabblab.stiff;

import :dropped_balls;
import :method;
import :rules;
import aabblab.figures;
import aabblab.stepping;

namespace aabblab {

namespace {

std::vector<method> all_methods() {
    std::vector<method> all = triangle_methods();
    std::erase_if(all, [](const method& m) { return m.label == "exact"; });  // what the others are held against
    for (const auto& more : {tree_methods(), list_methods()}) std::ranges::copy(more, std::back_inserter(all));
    return all;
}

series depth_line(const std::string& label, const trajectory& t) {
    series line{label, series_style::line, {}};
    for (std::size_t i = 0; i < t.times.size(); ++i)
        line.points.push_back({t.times[i], t.depths[i], t.depths[i], t.depths[i]});
    return line;
}

/// The trajectory by each method, as many at once as there are processors: nothing is timed.
std::vector<trajectory> played_by(const std::vector<method>& methods, const dropped_balls& balls, double step,
                                  const stiff_setting& setting) {
    std::vector<trajectory> all(methods.size());
    std::atomic<std::size_t> begun = 0;
    const auto play = [&](const std::function<void(double)>& progress) {
        for (std::size_t m = begun++; m < methods.size(); m = begun++) {
            progress(static_cast<double>(m) / static_cast<double>(methods.size()));
            all[m] = balls.play(methods[m].who, *integrator_named("velocity_verlet"), step, 1, true);
        }
    };
    std::vector<std::future<void>> others;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
        others.push_back(std::async(std::launch::async, play, [](double) {}));
    play(setting.progress);
    for (std::future<void>& other : others) other.get();
    return all;
}

/// What each method does to the trajectory, with one step of time.
void hold_methods(const dropped_balls& balls, const std::string& file, const std::string& size,
                  const stiff_setting& setting, stiff_result& result) {
    const double step = balls.seconds(1e-3);
    const trajectory right = balls.play(setting.who, *integrator_named("velocity_verlet"), step, 1, true);
    figure plot{
        .name = "departure_" + file,
        .caption = "How far balls of " + size +
                   " are from where exact contacts take them, because of a triangle "
                   "test, an engine or a stale list; what never departs is not drawn, and of others no more than nine.",
        .x = {"time (s)", false, {}},
        .y = {"greatest distance over a ball's diameter", true, {}},
        .lines = {},
        .marks = {}};
    figure depth{.name = "depth_" + file,
                 .caption = "How deep balls of " + size +
                            " are in each other at most, with exact contacts and with those "
                            "of the methods that depart.",
                 .x = {"time (s)", false, {}},
                 .y = {"greatest depth over a ball's diameter", false, {}},
                 .lines = {depth_line("exact", right)},
                 .marks = {}};
    const std::vector<method> all = all_methods();
    const std::vector<trajectory> played = played_by(all, balls, step, setting);
    constexpr std::size_t most_drawn = 9;
    for (std::size_t m = 0; m < all.size(); ++m) {
        const trajectory& t = played[m];
        const std::vector<double> far = balls.departures(t, right);
        const auto first = std::ranges::find_if(far, [](double d) { return !(d <= 0); });
        const std::string subject = all[m].label + ", " + size;
        const double greatest = std::ranges::max(far);
        if (all[m].who.exact && all[m].who.exact_boxes) {
            result.rows.push_back(at_most(subject, "greatest departure (diameters)", greatest, 0));
            continue;
        }
        result.rows.push_back(told(subject, "greatest departure (diameters)", greatest));
        if (first == far.end()) continue;
        result.rows.push_back(told(subject, "first step that is wrong", static_cast<double>(first - far.begin()) + 1));
        result.rows.push_back(told(subject, "greatest depth of two balls (diameters)", std::ranges::max(t.depths)));
        result.rows.push_back(told(subject, "energy error, RMS", t.energy_error));
        if (plot.lines.size() == most_drawn) continue;
        series line{all[m].label, series_style::line, {}};
        for (std::size_t s = 0; s < far.size(); ++s)
            line.points.push_back({step * static_cast<double>(s + 1), far[s], far[s], far[s]});
        plot.lines.push_back(std::move(line));
        depth.lines.push_back(depth_line(all[m].label, t));
    }
    result.rows.push_back(
        told("exact, " + size, "greatest depth of two balls (diameters)", std::ranges::max(right.depths)));
    result.rows.push_back(told("exact, " + size, "energy error, RMS", right.energy_error));
    if (plot.lines.empty()) return;
    result.figures.push_back(std::move(plot));
    result.figures.push_back(std::move(depth));
}

/// Error over run time: each integrator over its step, and stale lists over how stale they are.
void hold_steps(const dropped_balls& balls, const stiff_setting& setting, stiff_result& result) {
    figure cost{.name = "error_over_time",
                .caption =
                    "Error of a trajectory over the time that detection takes for it: each integrator over its "
                    "step, and a stale list over the frames from search to search, with steps of 1 ms.",
                .x = {"detection (ms)", true, {}},
                .y = {"greatest distance from the right place (diameters)", true, {}},
                .lines = {},
                .marks = {}};
    const std::vector<double> all = setting.quick ? std::vector{4e-3, 2e-3, 1e-3} : std::vector{4e-3, 2e-3, 1e-3, 5e-4};
    const auto kept = [&](double dt) { return static_cast<std::size_t>(std::llround(all.front() / dt)); };
    const integrator_info& verlet = *integrator_named("velocity_verlet");
    const double finest = all.back() / 16;
    const trajectory right = balls.play(setting.who, verlet, finest, kept(finest), false);
    const auto error_of = [&](const trajectory& t) { return balls.departures(t, right).back(); };
    for (const integrator_info& i : integrators()) {
        if (i.adaptive || i.order == 5) continue;
        series line{std::string(i.name), series_style::line, {}};
        std::vector<double> energy_errors;
        for (const double dt : all) {
            const trajectory t = balls.play(setting.who, i, dt, kept(dt), true);
            const double error = error_of(t);
            line.points.push_back({t.detection_ms, error, error, error});
            const std::string subject = std::string(i.name) + ", " + short_number(dt) + " s";
            result.rows.push_back(told(subject, "trajectory error at the end (diameters)", error));
            result.rows.push_back(told(subject, "energy error, RMS", t.energy_error));
            energy_errors.push_back(t.energy_error);
        }
        cost.lines.push_back(std::move(line));
        // Each step is half of the one before.
        const double order =
            std::log2(energy_errors.front() / energy_errors.back()) / static_cast<double>(all.size() - 1);
        result.rows.push_back(at_least(std::string(i.name), "order of the energy error", order, i.order - 0.3));
    }
    series stale{"velocity_verlet, neighbour_list:margin=0", series_style::line, {}};
    for (const char* const every : {"8", "16", "32", "64"}) {
        const method m = composed(std::string("prepare neighbour_list:margin=0,every=") + every);
        const trajectory t = balls.play(m.who, verlet, 1e-3, kept(1e-3), false);
        const double error = error_of(t);
        stale.points.push_back({t.detection_ms, error, error, error});
    }
    cost.lines.push_back(std::move(stale));
    result.figures.push_back(std::move(cost));
}

}  // namespace

stiff_result play_dropped(const stiff_setting& setting) {
    stiff_result result;
    const std::size_t side = setting.quick ? 3 : 6;
    const dropped_balls balls(side, 1);
    hold_steps(balls, setting, result);
    // The mean of the squared error over their run, J², of 34,454 J.
    result.rows.push_back(told("published: ODE, 0.001 s, over 10 s", "energy error, RMS", std::sqrt(112.326) / 34454));
    result.rows.push_back(
        told("published: Bullet without ERP, 0.001 s, over 10 s", "energy error, RMS", std::sqrt(41498.1) / 34454));
    hold_methods(balls, "1_m", "1 m", setting, result);
    hold_methods(dropped_balls(side, 0.01), "10_mm", "10 mm", setting, result);
    return result;
}

stiff_study dropped_study() {
    return {
        "dropped",
        "216 balls of 80 triangles (27 with --quick) fall 5 diameters on a floor and on each other without loss, "
        "pushed by a pressure on the surface inside the other: what a step and what each method does to the trajectory",
        "the trajectory of exact contacts; energy errors that fall with the order of the integrator; SimBenchmark's "
        "elastic 666 test (leggedrobotics/SimBenchmark, data/666-elastic/sample.csv) for ODE and Bullet with impulses",
        &play_dropped};
}

}  // namespace aabblab
