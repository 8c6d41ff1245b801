module;
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.errors;

import aabb.base;
import aabb.policy;
import aabblab.figures;
import aabblab.numbers;
import aabblab.tables;

namespace aabblab {

namespace {

std::string_view precision_of(bool in_double) {
    return in_double ? "double" : "float";
}

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

std::vector<error_point> of_precision(std::span<const error_point> points, bool in_double) {
    std::vector<error_point> some;
    std::ranges::copy_if(points, std::back_inserter(some),
                         [&](const error_point& p) { return p.in_double == in_double; });
    return some;
}

/// "0", "1.2e-05", "0.31": a share of the pairs.
std::string share_text(std::uint64_t wrong, std::uint64_t of) {
    if (of == 0) return "-";
    if (wrong == 0) return "0";
    return fmt::format("{:.2g}", static_cast<double>(wrong) / static_cast<double>(of));
}

std::vector<std::string> sets_in(std::span<const error_point> points) {
    std::vector<std::string> names;
    for (const error_point& p : points)
        if (std::ranges::find(names, p.pairs) == names.end()) names.push_back(p.pairs);
    return names;
}

/// What nothing else is both faster than and at least as exact as, from the fastest to the most exact.
std::vector<pooled> front_of(std::vector<pooled> methods) {
    std::ranges::sort(methods, {}, [](const pooled& m) { return std::pair(m.ns(), m.error()); });
    std::vector<pooled> front;
    for (const pooled& m : methods)
        if (front.empty() || m.error() < front.back().error()) front.push_back(m);
    return front;
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
    for (const pooled& m : front_of(methods)) front.points.push_back(point_of(m));
    // Below the curves.
    f.lines.insert(f.lines.begin(), front);
    f.lines.push_back({"nothing wrong (1/N to 3/N)", series_style::level, {{1, floor, floor, 3 * floor}}});
    return f;
}

std::string file_name(std::string text) {
    for (char& c : text)
        if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_') c = '-';
    return text.substr(0, 100);
}

}  // namespace

table error_rows(std::span<const error_point> points) {
    table t{{{"pairs", false},
             {"precision", false},
             {"curve", false},
             {"triangle", false},
             {"count"},
             {"intersecting"},
             {"false_negatives"},
             {"false_positives"},
             {"ns"},
             {"ns_low"},
             {"ns_high"}},
            {}};
    for (const error_point& p : points) {
        t.rows.push_back({p.pairs, std::string(precision_of(p.in_double)), p.curve, to_text(p.triangle),
                          std::to_string(p.count), std::to_string(p.intersecting), std::to_string(p.false_negatives),
                          std::to_string(p.false_positives), aabb::shortest(p.ns_a_pair.median),
                          aabb::shortest(p.ns_a_pair.low), aabb::shortest(p.ns_a_pair.high)});
    }
    return t;
}

table error_summary(std::span<const error_point> points, bool in_double) {
    table t{{{"triangle", false}, {"ns a pair"}, {"wrong"}, {"missed"}, {"invented"}}, {}};
    std::vector<pooled> methods = pooled_over(of_precision(points, in_double));
    std::ranges::stable_sort(methods, {}, [](const pooled& m) { return std::pair(m.error(), m.ns()); });
    for (const pooled& m : methods)
        t.rows.push_back({to_text(m.triangle), fmt::format("{:.1f}", m.ns()),
                          share_text(m.false_negatives + m.false_positives, m.count),
                          share_text(m.false_negatives, m.intersecting),
                          share_text(m.false_positives, m.count - m.intersecting)});
    return t;
}

table errors_by_set(std::span<const error_point> points, bool in_double) {
    const std::vector<error_point> some = of_precision(points, in_double);
    table t{{{"triangle", false}}, {}};
    const std::vector<std::string> sets = sets_in(some);
    for (const std::string& set : sets) t.columns.push_back({set});
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

std::vector<figure> error_figures(std::span<const error_point> points) {
    std::vector<figure> figures;
    for (const bool in_double : {false, true}) {
        const std::vector<error_point> some = of_precision(points, in_double);
        if (some.empty()) continue;
        const std::string precision(precision_of(in_double));
        const std::vector<std::string> sets = sets_in(some);
        figures.push_back(figure_of("errors_" + precision,
                                    fmt::format("over {} sets of triangles of {}", sets.size(), precision), some));
        for (const std::string& set : sets) {
            std::vector<error_point> own;
            std::ranges::copy_if(some, std::back_inserter(own), [&](const error_point& p) { return p.pairs == set; });
            std::string name = "errors_" + precision + "_" + file_name(set);
            while (std::ranges::find(figures, name, &figure::name) != figures.end()) name += "-again";
            figures.push_back(figure_of(name, set + " in " + precision, own));
        }
    }
    return figures;
}

}  // namespace aabblab
