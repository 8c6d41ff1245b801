module aabblab.errors;

import aabb.registry;
import aabblab.fmt;
import aabblab.metrics;
import aabblab.numbers;
import aabblab.results;
import aabblab.trials;

namespace aabblab {

namespace {

/// Two numbers of a method; less is better in both.
using cost = std::array<double, 2>;

/// The Pareto front of methods with two costs, by index, ascending in the first cost: those that no other beats in one
/// and equals or beats in the other, of equal ones only one. In that order, the second cost is a new minimum.
/// @param cost_of returns the two costs of a method
template <class Method, class CostOf>
std::vector<std::size_t> front_of(const std::vector<Method>& methods, CostOf cost_of) {
    std::vector<std::size_t> order(methods.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto cost_at = [&](std::size_t i) -> cost { return std::invoke(cost_of, methods[i]); };
    std::ranges::sort(order, {}, cost_at);
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (front.empty() || cost_at(i)[1] < cost_at(front.back())[1]) front.push_back(i);
    return front;
}

/// Replaces characters that are unsafe in file names.
std::string file_name(std::string text) {
    for (char& c : text)
        if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_') c = '-';
    return text.substr(0, 100);
}

/// Appends to a name until no figure has it.
std::string unused_name(std::string name, std::span<const figure> figures) {
    while (std::ranges::find(figures, name, &figure::name) != figures.end()) name += "-again";
    return name;
}

/// The results of a method summed over several sets of pairs.
struct pooled : error_point {
    double ns_of_sets = 0;  ///< sum of medians
    std::size_t sets = 0;

    [[nodiscard]] double error() const { return static_cast<double>(wrong()) / static_cast<double>(count); }
    [[nodiscard]] double ns() const { return ns_of_sets / static_cast<double>(sets); }
    [[nodiscard]] cost costs() const { return {ns(), error()}; }
};

/// Sums the results over the sets of pairs: one entry per method (a test with its parameter), in order of appearance.
std::vector<pooled> pooled_over(std::span<const error_point> points) {
    std::vector<pooled> methods;
    for (const error_point& p : points) {
        auto method = std::ranges::find_if(
            methods, [&](const pooled& m) { return m.curve == p.curve && m.triangle == p.triangle; });
        if (method == methods.end()) {
            method = methods.emplace(method);
            method->curve = p.curve;
            method->triangle = p.triangle;
        }
        method->count += p.count;
        method->intersecting += p.intersecting;
        method->false_negatives += p.false_negatives;
        method->false_positives += p.false_positives;
        method->ns_of_sets += p.ns_per_pair.median;
        ++method->sets;
    }
    return methods;
}

pair_group group_of(const error_point& p) {
    if (std::ranges::find(pair_classes(), p.pairs, &pair_class_info::name) == pair_classes().end())
        return pair_group::of_meshes;
    return p.in_double ? pair_group::of_doubles : pair_group::of_floats;
}

std::vector<error_point> of_group(std::span<const error_point> points, pair_group group) {
    std::vector<error_point> subset;
    std::ranges::copy_if(points, std::back_inserter(subset),
                         [&](const error_point& p) { return group_of(p) == group; });
    return subset;
}

/// "0", "1.2e-05", "0.31": a share of the pairs.
std::string share_text(std::uint64_t wrong, std::uint64_t pairs) {
    return pairs == 0 ? "-" : fmt::format("{:.2g}", static_cast<double>(wrong) / static_cast<double>(pairs));
}

std::string name_of(pair_group group) {
    constexpr std::array names{"float", "double", "meshes"};
    return names[static_cast<std::size_t>(group)];
}

std::vector<std::string> sets_in(std::span<const error_point> points) {
    std::vector<std::string> names;
    for (const error_point& p : points)
        if (std::ranges::find(names, p.pairs) == names.end()) names.push_back(p.pairs);
    return names;
}

/// Error over run time in some sets of pairs: one curve per method over its parameter, and the Pareto front.
/// @param sets their description in the caption
figure figure_of(const std::string& name, const std::string& sets, std::span<const error_point> points) {
    const std::vector<pooled> methods = pooled_over(points);
    figure f{
        .name = name,
        .caption = fmt::format("Share of wrong results over the time per pair, {}: each method over its parameter. A "
                               "method without errors is drawn on the line of one wrong result in N = {} pairs; "
                               "by the rule of three, its share is below 3/N with 95 % confidence.",
                               sets, grouped(methods.front().count)),
        .x = {"time per pair (ns)", /*logarithmic=*/true},
        .y = {"share of wrong results", /*logarithmic=*/true}};
    const double least_share = 1 / static_cast<double>(methods.front().count);
    const auto point_of = [&](const pooled& m) {
        return figure_point{.x = m.ns(), .y = std::max(least_share, m.error())};
    };
    for (const pooled& m : methods) {
        auto curve = std::ranges::find(f.lines, m.curve, &series::label);
        if (curve == f.lines.end()) curve = f.lines.insert(f.lines.end(), {m.curve});
        curve->points.push_back(point_of(m));
    }
    series front{"Pareto front"};
    for (const std::size_t i : front_of(methods, &pooled::costs)) front.points.push_back(point_of(methods[i]));
    // Drawn first, below the curves.
    f.lines.insert(f.lines.begin(), front);
    f.lines.push_back({"no errors (1/N to 3/N)",
                       series_style::level,
                       {{.x = 1, .y = least_share, .low = least_share, .high = 3 * least_share}}});
    return f;
}

/// A composition with the values of its metrics.
struct plotted_composition {
    std::string label;
    double x, y;
};

/// A plot of two metrics of the compositions that ran in one scene.
class plotted_scene {
public:
    /// Collects the compositions of the curves that ran in the scene, each as a point of two metrics.
    /// @param plot the names of the metrics, x and y
    plotted_scene(const scene_summary& scene, const metric_plot& plot, std::span<const error_curve> curves)
        : scene_(scene), x_(metric_named(plot.x)), y_(metric_named(plot.y)) {
        for (const error_curve& curve : curves) {
            series& line = curves_.emplace_back(series{curve.label});
            for (const aabb::composition& c : curve.compositions)
                if (std::optional<plotted_composition> values = values_of(c)) {
                    // A curve with a single composition keeps its label in the config.
                    if (curve.compositions.size() == 1) values->label = curve.label;
                    line.points.push_back(point_of(*values));
                    plotted_.push_back(*std::move(values));
                }
        }
    }

    /// A sentence about the compositions at both ends of the Pareto front. It is empty if one composition is best in
    /// both metrics, or if a metric has no better direction.
    [[nodiscard]] std::string statement() const {
        const std::vector<std::size_t> front = front_of_plotted();
        if (front.size() < 2 || !has_front()) return {};
        const plotted_composition& first = plotted_[front.front()];
        const plotted_composition& last = plotted_[front.back()];
        return fmt::format("In {}, {} has the best {}, {}, with a {} of {}; {} has the best {}, {}, with a {} of {}.",
                           title(), first.label, x_.name, value_text(x_, first.x), y_.name, value_text(y_, first.y),
                           last.label, y_.name, value_text(y_, last.y), x_.name, value_text(x_, last.x));
    }

    /// A figure of one metric over the other, with one curve per method over its parameter. The Pareto front is added
    /// if both metrics have a better direction, and, under shares of wrong pairs, a level for methods without errors.
    [[nodiscard]] figure drawn(const std::string& name) const {
        // A logarithmic axis cannot show zero.
        const bool positive_x = std::ranges::all_of(plotted_, [](const plotted_composition& c) { return c.x > 0; });
        const bool positive_y = std::ranges::all_of(plotted_, [](const plotted_composition& c) { return c.y > 0; });
        figure f{.name = name,
                 .caption = fmt::format("{} over {} in {}: each method over its parameter.", y_.name, x_.name, title()),
                 .x = {label_of(x_), positive_x},
                 .y = {label_of(y_), positive_y || has_floor()},
                 .lines = curves_};
        if (has_front()) {
            series front{"Pareto front"};
            for (const std::size_t i : front_of_plotted()) front.points.push_back(point_of(plotted_[i]));
            // Drawn first, below the curves.
            f.lines.insert(f.lines.begin(), std::move(front));
            f.caption += " A line joins the Pareto front.";
        }
        if (has_floor()) {
            f.lines.push_back({"no errors (1/N)", series_style::level, {{.x = 1, .y = least_share()}}});
            f.caption += fmt::format(" A method without errors is drawn on the line of one wrong pair in N = {}.",
                                     grouped(exact_pairs()));
        }
        return f;
    }

    [[nodiscard]] std::string title() const {
        const std::string parameters = parameters_text(scene_.scene);
        return scene_.scene.kind + (parameters.empty() ? "" : " " + parameters);
    }

private:
    [[nodiscard]] static std::string label_of(const metric& m) {
        return m.name + (m.unit.empty() ? "" : " (" + m.unit + ")");
    }

    /// The two metrics of a composition in this scene; empty if it did not run in it.
    [[nodiscard]] std::optional<plotted_composition> values_of(const aabb::composition& c) const {
        const candidate_name name = candidate_of(c, has_meshes(scene_.scene)).name;
        const auto candidate = std::ranges::find(scene_.candidates, name, &candidate_summary::name);
        if (candidate == scene_.candidates.end()) return std::nullopt;
        const std::optional<double>& x = candidate->metrics[static_cast<std::size_t>(&x_ - metrics().data())];
        const std::optional<double>& y = candidate->metrics[static_cast<std::size_t>(&y_ - metrics().data())];
        return x && y ? std::optional(plotted_composition{candidate->label, *x, *y}) : std::nullopt;
    }

    [[nodiscard]] bool has_front() const { return x_.direction != better::neither && y_.direction != better::neither; }
    [[nodiscard]] static std::string value_text(const metric& m, double value) {
        return fmt::format("{:.3g}{}", value, m.unit.empty() ? "" : " " + m.unit);
    }

    /// True if shares of wrong pairs are drawn: since log 0 is infinite, no errors are drawn as one wrong pair.
    [[nodiscard]] bool has_floor() const { return y_.name == "wrong_share" && exact_pairs() > 0; }
    /// The number of true pairs, from the pairs and the errors of any candidate.
    [[nodiscard]] std::uint64_t exact_pairs() const {
        const candidate_summary& any = scene_.candidates[0];
        return any.contacts.value_or(any.pairs) + any.false_negatives.value_or(0) - any.false_positives.value_or(0);
    }
    [[nodiscard]] double least_share() const { return 1 / static_cast<double>(exact_pairs()); }

    [[nodiscard]] figure_point point_of(const plotted_composition& c) const {
        return {.x = c.x, .y = has_floor() ? std::max(c.y, least_share()) : c.y};
    }

    [[nodiscard]] std::vector<std::size_t> front_of_plotted() const {
        const auto signed_by = [](const metric& m, double value) {
            return m.direction == better::more ? -value : value;
        };
        return front_of(plotted_, [&](const auto& c) { return cost{signed_by(x_, c.x), signed_by(y_, c.y)}; });
    }

    const scene_summary& scene_;
    const metric& x_;
    const metric& y_;
    std::vector<series> curves_;
    std::vector<plotted_composition> plotted_;  // of all curves
};

constexpr std::array<std::string_view, 2> precisions{"float", "double"};

template <class Choice>
struct written_choice {
    Choice& choice;
};
template <class Choice>
std::string field_text(const written_choice<Choice>& from) {
    return to_text(from.choice);
}
bool parse_field(const written_choice<aabb::strategy_choice>& to, const std::string& text) {
    to.choice = aabb::parse_strategy(text);
    return true;
}

constexpr auto columns_of_point = [](auto& p, auto field) {
    field("pairs", p.pairs);
    field("precision", one_of_words(p.in_double, precisions));
    field("curve", p.curve);
    field("triangle", written_choice(p.triangle));
    field("count", p.count);
    field("intersecting", p.intersecting);
    field("false_negatives", p.false_negatives);
    field("false_positives", p.false_positives);
    field("ns", all_digits(p.ns_per_pair.median));
    field("ns_low", all_digits(p.ns_per_pair.low));
    field("ns_high", all_digits(p.ns_per_pair.high));
};

constexpr auto columns_of_hit = [](auto& p, auto field) {
    field("pairs", p.pairs);
    field("precision", one_of_words(p.in_double, precisions));
    field("triangle", p.triangle);
    field("tried", p.tried);
    field("hits", p.count);
    for (const aabb::intersection_kind kind : {aabb::intersection_kind::point, aabb::intersection_kind::segment,
                                               aabb::intersection_kind::transversal, aabb::intersection_kind::overlap})
        field(std::string(name_of(kind)), p.kinds[static_cast<std::size_t>(kind)]);
    field("different", p.different);
    field("outside", p.outside);
    field("of_bound", all_digits(p.greatest.of_bound));
    field("error", all_digits(p.greatest.greatest));
    field("bound", all_digits(p.greatest.bound));
    field("ns", all_digits(p.ns_per_hit.median));
    field("ns_low", all_digits(p.ns_per_hit.low));
    field("ns_high", all_digits(p.ns_per_hit.high));
};

}  // namespace

std::vector<pair_group> groups_in(std::span<const error_point> points) {
    std::vector<pair_group> groups;
    for (const pair_group group : {pair_group::of_floats, pair_group::of_doubles, pair_group::of_meshes})
        if (std::ranges::find(points, group, group_of) != points.end()) groups.push_back(group);
    return groups;
}

std::string_view title_of(pair_group group) {
    constexpr std::array titles{"generated triangle pairs with float coordinates",
                                "generated triangle pairs with double coordinates",
                                "triangle pairs of meshes whose boxes overlap"};
    return titles[static_cast<std::size_t>(group)];
}

/// One row per method, from the least share of wrong results: FN among intersecting pairs, FP among the others.
table error_summary(std::span<const error_point> points, pair_group group) {
    table t = empty_table({"triangle"}, {"ns/pair", "wrong", "FN", "FP"});
    std::vector<pooled> methods = pooled_over(of_group(points, group));
    std::ranges::stable_sort(methods, {}, [](const pooled& m) { return std::pair(m.error(), m.ns()); });
    for (const pooled& m : methods)
        t.rows.push_back({to_text(m.triangle), fmt::format("{:.1f}", m.ns()), share_text(m.wrong(), m.count),
                          share_text(m.false_negatives, m.intersecting),
                          share_text(m.false_positives, m.count - m.intersecting)});
    return t;
}

/// One row per method, one column per set of pairs: shares of false negatives and false positives, joined by "+".
table errors_by_set(std::span<const error_point> points, pair_group group) {
    const std::vector<error_point> subset = of_group(points, group);
    table t = empty_table({"triangle"});
    const std::vector<std::string> sets = sets_in(subset);
    // Names of mesh scenes are too long for headers, so they are numbered.
    for (const std::string& set : sets)
        t.columns.push_back({group == pair_group::of_meshes ? fmt::format("scene {}", &set - sets.data() + 1) : set});
    for (const pooled& m : pooled_over(subset)) {
        std::vector<std::string>& row = t.rows.emplace_back();
        row.push_back(to_text(m.triangle));
        for (const std::string& set : sets) {
            const auto point = std::ranges::find_if(subset, [&](const error_point& p) {
                return p.pairs == set && p.curve == m.curve && p.triangle == m.triangle;
            });  // never the end: each method of a group runs on all its sets
            row.push_back(point->wrong() == 0 ? "0"
                                              : fmt::format("{}+{}", share_text(point->false_negatives, point->count),
                                                            share_text(point->false_positives, point->count)));
        }
    }
    return t;
}

std::vector<std::string> scenes_by_number(std::span<const error_point> points, pair_group group) {
    if (group != pair_group::of_meshes) return {};
    std::vector<std::string> scenes = sets_in(of_group(points, group));
    for (std::string& scene : scenes) scene = fmt::format("scene {}: {}", &scene - scenes.data() + 1, scene);
    return scenes;
}

figure group_figure(std::span<const error_point> points, pair_group group) {
    const std::vector<error_point> subset = of_group(points, group);
    return figure_of("errors_" + name_of(group), fmt::format("{} sets of {}", sets_in(subset).size(), title_of(group)),
                     subset);
}

/// A sentence on both ends of the Pareto front of time and errors: the fastest method, and that with the fewest errors.
std::string group_statement(std::span<const error_point> points, pair_group group) {
    const std::vector<pooled> methods = pooled_over(of_group(points, group));
    const std::vector<std::size_t> front = front_of(methods, &pooled::costs);
    const auto wrong = [](const pooled& m) {
        return (m.wrong() == 0 ? "none" : grouped(m.wrong())) + " of " + grouped(m.count) + " pairs wrong";
    };
    const pooled& fastest = methods[front.front()];
    const pooled& best = methods[front.back()];
    std::string text = fmt::format("In {}, {} is the fastest, with {:.1f} ns per pair, and gets {}", title_of(group),
                                   to_text(fastest.triangle), fastest.ns(), wrong(fastest));
    if (&fastest != &best)
        text += fmt::format("; {} gets {}, with {:.1f} ns per pair, and takes {:.2f} times as long",
                            to_text(best.triangle), wrong(best), best.ns(), best.ns() / fastest.ns());
    return text + ".";
}

/// The figures of error over run time: one per group of sets (float, double, meshes), and one per set.
std::vector<figure> error_figures(std::span<const error_point> points) {
    std::vector<figure> figures;
    for (const pair_group group : groups_in(points)) {
        figures.push_back(group_figure(points, group));
        const std::vector<error_point> subset = of_group(points, group);
        for (const std::string& set : sets_in(subset)) {
            std::vector<error_point> of_set = subset;
            std::erase_if(of_set, [&](const error_point& p) { return p.pairs != set; });
            const std::string name = unused_name("errors_" + name_of(group) + "_" + file_name(set), figures);
            figures.push_back(figure_of(name, fmt::format("{}, {}", set, title_of(group)), of_set));
        }
    }
    return figures;
}

/// A figure for each scene and each pair of metrics that the study plots.
std::vector<figure> metric_figures(const error_study& study, std::span<const scene_summary> scenes) {
    std::vector<figure> figures;
    for (const scene_summary& scene : scenes)
        for (const metric_plot& plot : study.plots) {
            const plotted_scene plotted(scene, plot, study.curves);
            const std::string name = plot.y + "_over_" + plot.x + "_" + file_name(plotted.title());
            figures.push_back(plotted.drawn(unused_name(name, figures)));
        }
    return figures;
}

/// A sentence per scene and plot about both ends of its Pareto front, unless one composition is best in both metrics.
std::vector<std::string> metric_statements(const error_study& study, std::span<const scene_summary> scenes) {
    std::vector<std::string> statements;
    for (const scene_summary& scene : scenes)
        for (const metric_plot& plot : study.plots)
            if (std::string text = plotted_scene(scene, plot, study.curves).statement(); !text.empty())
                statements.push_back(std::move(text));
    return statements;
}

std::string csv_of(std::span<const error_point> points) {
    return csv_of(points, columns_of_point);
}

std::string csv_of(std::span<const hit_point> points) {
    return csv_of(points, columns_of_hit);
}

std::vector<error_point> read_error_rows(const std::filesystem::path& file) {
    return rows_of_file<error_point>(file, columns_of_point);
}

}  // namespace aabblab
