module;
#include <fmt/format.h>

module aabblab.errors;

import :front;
import aabblab.numbers;

namespace aabblab {

namespace {

/// A method over several sets of pairs.
struct pooled {
    std::string curve;
    aabb::strategy_choice triangle;
    std::uint64_t count = 0;
    std::uint64_t intersecting = 0;
    std::uint64_t false_negatives = 0;
    std::uint64_t false_positives = 0;
    double ns_of_sets = 0;  ///< sum of medians
    std::size_t sets = 0;

    [[nodiscard]] double error() const {
        return static_cast<double>(false_negatives + false_positives) / static_cast<double>(count);
    }
    [[nodiscard]] double ns() const { return ns_of_sets / static_cast<double>(sets); }
};

/// In the order of the methods.
std::vector<pooled> pooled_over(std::span<const error_point> points) {
    std::vector<pooled> all;
    for (const error_point& p : points) {
        auto found =
            std::ranges::find_if(all, [&](const pooled& m) { return m.curve == p.curve && m.triangle == p.triangle; });
        if (found == all.end()) found = all.insert(all.end(), {.curve = p.curve, .triangle = p.triangle});
        found->count += p.count;
        found->intersecting += p.intersecting;
        found->false_negatives += p.false_negatives;
        found->false_positives += p.false_positives;
        found->ns_of_sets += p.ns_a_pair.median;
        ++found->sets;
    }
    return all;
}

pair_group group_of(const error_point& p) {
    if (std::ranges::find(pair_classes(), p.pairs, &pair_class_info::name) == pair_classes().end())
        return pair_group::of_meshes;
    return p.in_double ? pair_group::of_doubles : pair_group::of_floats;
}

std::vector<error_point> of_group(std::span<const error_point> points, pair_group group) {
    std::vector<error_point> some;
    std::ranges::copy_if(points, std::back_inserter(some), [&](const error_point& p) { return group_of(p) == group; });
    return some;
}

/// "0", "1.2e-05", "0.31": a share of the pairs.
std::string share_text(std::uint64_t wrong, std::uint64_t of) {
    if (of == 0) return "-";
    if (wrong == 0) return "0";
    return fmt::format("{:.2g}", static_cast<double>(wrong) / static_cast<double>(of));
}

std::string name_of(pair_group group) {
    switch (group) {
        case pair_group::of_floats: return "float";
        case pair_group::of_doubles: return "double";
        case pair_group::of_meshes: break;
    }
    return "meshes";
}

std::vector<std::string> sets_in(std::span<const error_point> points) {
    std::vector<std::string> names;
    for (const error_point& p : points)
        if (std::ranges::find(names, p.pairs) == names.end()) names.push_back(p.pairs);
    return names;
}

figure figure_of(const std::string& name, const std::string& what, std::span<const error_point> points) {
    const std::vector<pooled> methods = pooled_over(points);
    figure f{.name = name,
             .caption = fmt::format("Share of wrong answers over the time a pair, {}: each method over its knob. What "
                                    "gets nothing wrong stands on the line of one wrong answer in N = {} pairs; by the "
                                    "rule of three its share is then below 3/N with 95 % certainty.",
                                    what, grouped(methods.front().count)),
             .x = {"time a pair (ns)", true, {}},
             .y = {"share of wrong answers", true, {}},
             .lines = {},
             .marks = {}};
    const double floor = 1 / static_cast<double>(methods.front().count);
    const auto point_of = [&](const pooled& m) {
        const double share = std::max(floor, m.error());
        return figure_point{m.ns(), share, share, share};
    };
    for (const pooled& m : methods) {
        auto line = std::ranges::find(f.lines, m.curve, &series::label);
        if (line == f.lines.end()) line = f.lines.insert(f.lines.end(), {m.curve, series_style::line, {}});
        line->points.push_back(point_of(m));
    }
    series front{"not dominated", series_style::line, {}};
    std::vector<cost> costs;
    for (const pooled& m : methods) costs.push_back({m.ns(), m.error()});
    for (const std::size_t i : front_of(costs)) front.points.push_back(point_of(methods[i]));
    // Below the curves.
    f.lines.insert(f.lines.begin(), front);
    f.lines.push_back({"nothing wrong (1/N to 3/N)", series_style::level, {{1, floor, floor, 3 * floor}}});
    return f;
}

}  // namespace

std::vector<pair_group> groups_in(std::span<const error_point> points) {
    std::vector<pair_group> groups;
    for (const pair_group group : {pair_group::of_floats, pair_group::of_doubles, pair_group::of_meshes})
        if (std::ranges::find(points, group, group_of) != points.end()) groups.push_back(group);
    return groups;
}

std::string_view title_of(pair_group group) {
    switch (group) {
        case pair_group::of_floats: return "generated triangles of floats";
        case pair_group::of_doubles: return "generated triangles of doubles";
        case pair_group::of_meshes: break;
    }
    return "triangles of meshes whose boxes overlap";
}

table error_summary(std::span<const error_point> points, pair_group group) {
    table t{{{"triangle", false}, {"ns a pair"}, {"wrong"}, {"missed"}, {"invented"}}, {}};
    std::vector<pooled> methods = pooled_over(of_group(points, group));
    std::ranges::stable_sort(methods, {}, [](const pooled& m) { return std::pair(m.error(), m.ns()); });
    for (const pooled& m : methods)
        t.rows.push_back({to_text(m.triangle), fmt::format("{:.1f}", m.ns()),
                          share_text(m.false_negatives + m.false_positives, m.count),
                          share_text(m.false_negatives, m.intersecting),
                          share_text(m.false_positives, m.count - m.intersecting)});
    return t;
}

table errors_by_set(std::span<const error_point> points, pair_group group) {
    const std::vector<error_point> some = of_group(points, group);
    table t{{{"triangle", false}}, {}};
    const std::vector<std::string> sets = sets_in(some);
    // Scenes of meshes have long names.
    for (const std::string& set : sets)
        t.columns.push_back({group == pair_group::of_meshes ? fmt::format("scene {}", &set - sets.data() + 1) : set});
    for (const pooled& m : pooled_over(some)) {
        std::vector<std::string>& row = t.rows.emplace_back();
        row.push_back(to_text(m.triangle));
        for (const std::string& set : sets) {
            const auto found = std::ranges::find_if(some, [&](const error_point& p) {
                return p.pairs == set && p.curve == m.curve && p.triangle == m.triangle;
            });
            row.push_back(found->wrong() == 0 ? "0"
                                              : fmt::format("{}+{}", share_text(found->false_negatives, found->count),
                                                            share_text(found->false_positives, found->count)));
        }
    }
    return t;
}

figure group_figure(std::span<const error_point> points, pair_group group) {
    const std::vector<error_point> some = of_group(points, group);
    return figure_of("errors_" + name_of(group), fmt::format("{} sets of {}", sets_in(some).size(), title_of(group)),
                     some);
}

std::string group_statement(std::span<const error_point> points, pair_group group) {
    const std::vector<pooled> methods = pooled_over(of_group(points, group));
    std::vector<cost> costs;
    for (const pooled& m : methods) costs.push_back({m.ns(), m.error()});
    const std::vector<std::size_t> front = front_of(costs);
    const auto wrong = [](const pooled& m) {
        const std::uint64_t all = m.false_negatives + m.false_positives;
        return all == 0 ? "none of " + grouped(m.count) + " pairs wrong"
                        : fmt::format("{} of {} pairs wrong", grouped(all), grouped(m.count));
    };
    const pooled& fastest = methods[front.front()];
    const pooled& best = methods[front.back()];
    std::string text = fmt::format("Of {}, {} is the fastest, with {:.1f} ns a pair, and gets {}", title_of(group),
                                   to_text(fastest.triangle), fastest.ns(), wrong(fastest));
    if (&fastest != &best)
        text += fmt::format("; {} gets {}, in {:.1f} ns a pair, {:.2f} times the time", to_text(best.triangle),
                            wrong(best), best.ns(), best.ns() / fastest.ns());
    return text + ".";
}

std::vector<figure> error_figures(std::span<const error_point> points) {
    std::vector<figure> figures;
    for (const pair_group group : groups_in(points)) {
        figures.push_back(group_figure(points, group));
        const std::vector<error_point> some = of_group(points, group);
        for (const std::string& set : sets_in(some)) {
            std::vector<error_point> own;
            std::ranges::copy_if(some, std::back_inserter(own), [&](const error_point& p) { return p.pairs == set; });
            std::string name = "errors_" + name_of(group) + "_" + file_name(set);
            while (std::ranges::find(figures, name, &figure::name) != figures.end()) name += "-again";
            figures.push_back(figure_of(name, fmt::format("{}, {}", set, title_of(group)), own));
        }
    }
    return figures;
}

}  // namespace aabblab
