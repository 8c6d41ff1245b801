module aabblab.errors;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// "0", "1.2e-05", "0.31": a share of the pairs.
std::string share_text(std::uint64_t wrong, std::uint64_t pairs) {
    return pairs == 0 ? "-" : fmt::format("{:.2g}", static_cast<double>(wrong) / static_cast<double>(pairs));
}

/// Replaces characters that are unsafe in file names.
std::string file_name(std::string text) {
    for (char& c : text)
        if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_') c = '-';
    return text.substr(0, 100);
}

/// The settings of a strategy that differ along a curve, or its name if that differs.
std::string knob_text(const std::string& curve, const aabb::strategy_choice& choice,
                      std::span<const aabb::strategy_choice> along) {
    if (std::ranges::any_of(along, [&](const aabb::strategy_choice& c) { return c.name != choice.name; }))
        return to_text(choice);
    std::string text;
    for (const aabb::setting& s : choice.settings) {
        const bool is_common = std::ranges::all_of(along, [&](const aabb::strategy_choice& c) {
            return std::ranges::find(c.settings, s) != c.settings.end();
        });
        if (is_common) continue;
        // The legend says what is varied: "GJK over iterations".
        const bool is_named = curve.find(s.name) != std::string::npos;
        text += (text.empty() ? "" : ", ") + (is_named ? s.value : s.name + "=" + s.value);
    }
    return text.empty() ? choice.name : text;
}

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
    field("cpu_ns", p.cpu_ns);
    field("cpu_ns_low", p.cpu_ns_low);
    field("cpu_ns_high", p.cpu_ns_high);
};

/// Columns that results of earlier versions lack.
constexpr auto later_columns = std::to_array<std::string_view>({"cpu_ns", "cpu_ns_low", "cpu_ns_high"});

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

std::vector<std::size_t> front_of(std::span<const cost> methods) {
    std::vector<std::size_t> order(methods.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return methods[i]; });
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (front.empty() || methods[i][1] < methods[front.back()][1]) front.push_back(i);
    return front;
}

std::vector<std::string> knob_labels(const std::string& curve, std::span<const std::vector<std::string>> choices) {
    std::vector<std::string> labels(choices.size());
    if (choices.size() < 2) return labels;  // nothing is varied
    for (std::size_t kind = 0; kind < choices[0].size(); ++kind) {
        std::vector<aabb::strategy_choice> along;
        for (const std::vector<std::string>& point : choices) along.push_back(aabb::parse_strategy(point[kind]));
        if (std::ranges::all_of(along, [&](const aabb::strategy_choice& c) { return c == along[0]; })) continue;
        for (std::size_t i = 0; i < along.size(); ++i)
            labels[i] += (labels[i].empty() ? "" : ", ") + knob_text(curve, along[i], along);
    }
    return labels;
}

std::string unused_file_name(const std::string& name, std::span<const figure> figures) {
    std::string unused = file_name(name);
    while (std::ranges::find(figures, unused, &figure::name) != figures.end()) unused += "-again";
    return unused;
}

std::optional<interval> interval_of(const cells& logarithms) {
    if (logarithms.empty()) return std::nullopt;
    const estimate mean = bootstrap(logarithms);
    // Student's t has infinite variance with two degrees of freedom or fewer: such an interval is useless.
    if (!(mean.error > 0) || mean.degrees <= 2) return std::nullopt;
    const auto [low, high] = mean.range();
    return interval{std::exp(low), std::exp(high)};
}

/// One row per method, from the least error: shares of wrong results, FN among intersecting pairs, FP among the others.
table error_summary(std::span<const error_point> points, pair_group group) {
    table t = empty_table({"triangle"}, {"ns/pair", "wrong", "FN", "FP"}, {"most in"});
    const std::vector<error_point> subset = of_group(points, group);
    const std::vector<std::string> sets = sets_in(subset);
    std::vector<tested_method> methods = methods_in(subset);
    std::ranges::stable_sort(methods, {}, [](const tested_method& m) { return std::pair(m.worst().error(), m.ns()); });
    for (const tested_method& m : methods) {
        const error_point& worst = m.worst();
        const auto number = std::ranges::find(sets, worst.pairs) - sets.begin() + 1;
        t.rows.push_back({to_text(m.triangle), fmt::format("{:.1f}", m.ns()), share_text(worst.wrong(), worst.count),
                          share_text(worst.false_negatives, worst.intersecting),
                          share_text(worst.false_positives, worst.count - worst.intersecting),
                          worst.wrong() == 0               ? "-"
                          : group == pair_group::of_meshes ? fmt::format("scene {}", number)
                                                           : worst.pairs});
    }
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
    for (const tested_method& m : methods_in(subset)) {
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

std::string csv_of(std::span<const error_point> points) {
    return csv_of(points, columns_of_point);
}

std::string csv_of(std::span<const hit_point> points) {
    return csv_of(points, columns_of_hit);
}

std::vector<error_point> read_error_rows(const std::filesystem::path& file) {
    return rows_of_file<error_point>(file, columns_of_point, later_columns);
}

}  // namespace aabblab
