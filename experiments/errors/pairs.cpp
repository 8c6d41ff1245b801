module aabblab.errors;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

constexpr double normal_quantile = 1.959963984540054;  // of 97.5 %

/// The 95 % interval of a share, of wrong results among independent pairs, by the score method (Wilson 1927).
interval share_interval(std::uint64_t wrong, std::uint64_t pairs) {
    const auto n = static_cast<double>(pairs);
    const double share = static_cast<double>(wrong) / n;
    const double z2 = normal_quantile * normal_quantile;
    const double middle = (share + z2 / (2 * n)) / (1 + z2 / n);
    const double half = normal_quantile / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
    return {std::max(0., middle - half), middle + half};
}

/// The interval of the mean of several times from those of the times, which are independent: the variance of each limit
/// is recovered from its own interval (Zou and Donner 2008).
std::optional<interval> time_interval(const tested_method& m) {
    double below = 0, above = 0;
    for (const error_point& p : m.sets) {
        if (!p.cpu_ns || !p.cpu_ns_low || !p.cpu_ns_high) return std::nullopt;
        below += (*p.cpu_ns - *p.cpu_ns_low) * (*p.cpu_ns - *p.cpu_ns_low);
        above += (*p.cpu_ns_high - *p.cpu_ns) * (*p.cpu_ns_high - *p.cpu_ns);
    }
    const auto count = static_cast<double>(m.sets.size());
    return interval{m.ns() - std::sqrt(below) / count, m.ns() + std::sqrt(above) / count};
}

bool is_of_mesh(const error_point& p) {
    return std::ranges::find(pair_classes(), p.pairs, &pair_class_info::name) == pair_classes().end();
}

pair_group group_of(const error_point& p) {
    if (is_of_mesh(p)) return pair_group::of_meshes;
    return p.in_double ? pair_group::of_doubles : pair_group::of_floats;
}

std::string name_of(pair_group group) {
    constexpr std::array names{"float", "double", "meshes"};
    return names[static_cast<std::size_t>(group)];
}

bool errs(const error_point& p) {
    return p.wrong() > 0;
}

/// A method's point: its time, and its error in its worst set. Pairs of a mesh scene are all that there are, so that
/// their share is exact; generated ones are a sample.
/// @param least_share at which no errors are drawn
figure_point point_of(const tested_method& m, double least_share) {
    const error_point& worst = m.worst();
    figure_point p{.x = m.ns(), .y = std::max(least_share, worst.error())};
    if (const std::optional<interval> range = time_interval(m)) {
        p.x_low = range->low;
        p.x_high = range->high;
    }
    if (errs(worst) && !is_of_mesh(worst)) {
        const auto [low, high] = share_interval(worst.wrong(), worst.count);
        p.low = low;
        p.high = high;
    }
    return p;
}

/// The lines of a work-precision diagram: the Pareto front, a curve per method over its parameter, and the level on
/// which methods without errors are drawn.
std::vector<series> lines_of(const std::vector<tested_method>& methods) {
    std::uint64_t pairs = std::numeric_limits<std::uint64_t>::max();
    for (const tested_method& m : methods)
        for (const error_point& p : m.sets) pairs = std::min(pairs, p.count);
    const double least_share = 1 / static_cast<double>(pairs);
    std::vector<series> lines{series{"Pareto front"}};  // drawn first, below the curves
    std::vector<cost> costs;
    for (const tested_method& m : methods) costs.push_back(m.costs());
    for (const std::size_t i : front_of(costs))
        lines[0].points.push_back({costs[i][0], std::max(least_share, costs[i][1])});
    std::map<std::string, std::vector<std::vector<std::string>>> choices;  // by curve
    for (const tested_method& m : methods) {
        auto curve = std::ranges::find(lines, m.curve, &series::label);
        if (curve == lines.end()) curve = lines.insert(lines.end(), {m.curve, series_style::curve});
        curve->points.push_back(point_of(m, least_share));
        choices[m.curve].push_back({to_text(m.triangle)});
    }
    for (series& line : lines) {
        if (!choices.contains(line.label)) continue;  // the front
        const std::vector<std::string> labels = knob_labels(line.label, choices[line.label]);
        for (std::size_t i = 0; i < labels.size(); ++i) line.points[i].label = labels[i];
    }
    lines.push_back({"no errors (1/N to 3/N)",
                     series_style::level,
                     {{.x = 1, .y = least_share, .low = least_share, .high = 3 * least_share}}});
    return lines;
}

/// A diagram without lines yet.
figure diagram(const std::string& name, const std::string& sets, std::span<const error_point> points) {
    const bool has_processor_time = points.front().cpu_ns.has_value();
    return {.name = name,
            .caption = fmt::format("Share of wrong results over the {} time per pair, {}: each method over its "
                                   "parameter, whose value is at each point. Bars are 95 % intervals. A line joins the "
                                   "Pareto front. A method without errors is drawn on the line of one wrong result in "
                                   "N pairs; by the rule of three, the share of wrong results among generated pairs is "
                                   "then below 3/N with 95 % confidence.",
                                   has_processor_time ? "processor" : "wall", sets),
            .x = {fmt::format("{} time per pair (ns)", has_processor_time ? "processor" : "wall"), true},
            .y = {"share of wrong results", /*logarithmic=*/true}};
}

/// Sets in which any method errs: others would put all points on one level.
std::vector<std::string> sets_with_errors(std::span<const error_point> points) {
    std::vector<std::string> names = sets_in(points);
    std::erase_if(names, [&](const std::string& set) {
        return std::ranges::none_of(points, [&](const error_point& p) { return p.pairs == set && errs(p); });
    });
    return names;
}

std::vector<error_point> of_set(std::span<const error_point> points, const std::string& set) {
    std::vector<error_point> subset;
    std::ranges::copy_if(points, std::back_inserter(subset), [&](const error_point& p) { return p.pairs == set; });
    return subset;
}

/// The names, separated by commas.
std::string joined(std::span<const std::string> names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace

double tested_method::ns() const {
    double sum = 0;
    for (const error_point& p : sets) sum += p.ns();
    return sum / static_cast<double>(sets.size());
}

std::vector<tested_method> methods_in(std::span<const error_point> points) {
    std::vector<tested_method> methods;
    for (const error_point& p : points) {
        auto method = std::ranges::find_if(
            methods, [&](const tested_method& m) { return m.curve == p.curve && m.triangle == p.triangle; });
        if (method == methods.end()) method = methods.insert(method, {p.curve, p.triangle, {}});
        method->sets.push_back(p);
    }
    return methods;
}

std::vector<pair_group> groups_in(std::span<const error_point> points) {
    std::vector<pair_group> groups;
    for (const pair_group group : {pair_group::of_meshes, pair_group::of_floats, pair_group::of_doubles})
        if (std::ranges::find(points, group, group_of) != points.end()) groups.push_back(group);
    return groups;
}

std::string_view title_of(pair_group group) {
    constexpr std::array titles{"generated triangle pairs with float coordinates",
                                "generated triangle pairs with double coordinates",
                                "triangle pairs of meshes whose boxes overlap"};
    return titles[static_cast<std::size_t>(group)];
}

std::vector<error_point> of_group(std::span<const error_point> points, pair_group group) {
    std::vector<error_point> subset;
    std::ranges::copy_if(points, std::back_inserter(subset),
                         [&](const error_point& p) { return group_of(p) == group; });
    return subset;
}

std::vector<std::string> sets_in(std::span<const error_point> points) {
    std::vector<std::string> names;
    for (const error_point& p : points)
        if (std::ranges::find(names, p.pairs) == names.end()) names.push_back(p.pairs);
    return names;
}

std::optional<figure> group_figure(std::span<const error_point> points, pair_group group) {
    const std::vector<error_point> subset = of_group(points, group);
    const std::vector<std::string> sets = sets_with_errors(subset);
    if (sets.empty()) return std::nullopt;
    const std::string name = "errors_" + name_of(group);
    if (group == pair_group::of_meshes) {
        figure f = diagram(name, std::string(title_of(group)), subset);
        const std::vector<std::string> scenes = scenes_by_number(points, group);
        for (const std::string& scene : scenes) {
            const std::size_t colon = scene.find(": ");  // after "scene 1"
            const std::string set = scene.substr(colon + 2);
            if (std::ranges::count(sets, set) == 0) continue;
            f.panels.push_back({scene.substr(0, colon), lines_of(methods_in(of_set(subset, set)))});
            f.caption += " " + scene + ".";
        }
        return f;
    }
    const std::string hard = fmt::format(
        "{}: the mean time over {} classes, and the share in the class in which the "
        "method errs most",
        title_of(group), sets_in(subset).size());
    figure f = diagram(name, hard, subset);
    f.lines = lines_of(methods_in(subset));
    return f;
}

std::string group_statement(std::span<const error_point> points, pair_group group) {
    const std::vector<error_point> subset = of_group(points, group);
    const std::vector<tested_method> methods = methods_in(subset);
    std::vector<cost> costs;
    for (const tested_method& m : methods) costs.push_back(m.costs());
    const std::vector<std::size_t> front = front_of(costs);
    const auto wrong = [](const tested_method& m) {
        if (!errs(m.worst())) return std::string("errs in no pair");
        return fmt::format("errs in up to {:.2g} % of the pairs of a set ({})", 100 * m.worst().error(),
                           m.worst().pairs);
    };
    const tested_method& fastest = methods[front.front()];
    const tested_method& best = methods[front.back()];
    std::string text = fmt::format("In {}, {} takes the least time, {:.1f} ns per pair, and {}", title_of(group),
                                   to_text(fastest.triangle), fastest.ns(), wrong(fastest));
    if (&fastest != &best)
        text += fmt::format("; {} {}, with {:.1f} ns per pair, and takes {:.2f} times as long", to_text(best.triangle),
                            wrong(best), best.ns(), best.ns() / fastest.ns());
    text += ".";
    std::vector<std::string> errorless = sets_in(subset);
    const std::vector<std::string> others = sets_with_errors(subset);
    std::erase_if(errorless, [&](const std::string& set) { return std::ranges::count(others, set) > 0; });
    if (!errorless.empty()) text += " No method errs in " + joined(errorless) + ", so that no figure shows it.";
    return text;
}

std::vector<figure> error_figures(std::span<const error_point> points) {
    std::vector<figure> figures;
    for (const pair_group group : groups_in(points)) {
        if (std::optional<figure> f = group_figure(points, group)) figures.push_back(*std::move(f));
        const std::vector<error_point> subset = of_group(points, group);
        for (const std::string& set : sets_with_errors(subset)) {
            const std::string name = unused_file_name("errors_" + name_of(group) + "_" + set, figures);
            figures.push_back(diagram(name, fmt::format("{}, {}", set, title_of(group)), subset));
            figures.back().lines = lines_of(methods_in(of_set(subset, set)));
        }
    }
    return figures;
}

}  // namespace aabblab
