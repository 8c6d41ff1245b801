module;
#include <fmt/format.h>

module aabblab.tables;

import aabblab.numbers;

namespace aabblab {

namespace {

std::optional<double> least_ratio_of(const scene_summary& scene) {
    std::optional<double> least;
    for (const summary_line& line : scene.lines)
        if (line.ratio && line.status == "exact") least = std::min(least.value_or(*line.ratio), *line.ratio);
    return least;
}

/// Ratios of one composition or engine, over scenes.
struct standing {
    contender_name name;
    std::size_t scenes = 0;
    std::size_t wins = 0;  ///< scenes in which it is the fastest of the exact ones
    bool exact = true;
    double log_sum = 0;
    double least = std::numeric_limits<double>::infinity();
    double greatest = 0;
    std::vector<double> regrets;  ///< ratios over that of the fastest of the exact ones

    void add(const summary_line& line, bool wins_here, std::optional<double> least_ratio) {
        if (least_ratio) regrets.push_back(*line.ratio / *least_ratio);
        ++scenes;
        wins += wins_here ? 1 : 0;
        exact = exact && line.status == "exact";
        log_sum += std::log(*line.ratio);
        least = std::min(least, *line.ratio);
        greatest = std::max(greatest, *line.ratio);
    }
    [[nodiscard]] double ratio() const { return std::exp(log_sum / static_cast<double>(scenes)); }
};

}  // namespace

table overall_table_of(std::span<const scene_summary> scenes) {
    std::vector<standing> all;
    std::map<contender_name, std::size_t> places;
    for (const scene_summary& scene : scenes) {
        const summary_line* const fastest = ranking_of(scene).front();
        const std::optional<double> least_ratio = least_ratio_of(scene);
        for (const summary_line& line : scene.lines) {
            if (!line.ratio) continue;
            const auto [place, is_new] = places.emplace(line.name, all.size());
            if (is_new) all.emplace_back().name = line.name;
            all[place->second].add(line, &line == fastest, least_ratio);
        }
    }
    std::vector<contender_name> names;
    for (const standing& one : all) names.push_back(one.name);
    const std::vector<aabb::strategy_kind> differing = differing_kinds(names);
    std::ranges::sort(all, {}, [](const standing& one) { return std::tuple(!one.exact, one.ratio(), one.name); });
    const bool inexact = std::ranges::any_of(all, [](const standing& one) { return !one.exact; });
    table t{name_columns_of(differing), {}};
    if (inexact) t.columns.push_back({"answer"});
    t.columns.insert(t.columns.end(),
                     {{"ratio"}, {"least", true, 2}, {"greatest", true, 1}, {"scenes"}, {"fastest in"}});
    const bool regretted = std::ranges::all_of(all, [](const standing& one) { return !one.regrets.empty(); });
    if (regretted) t.columns.insert(t.columns.end(), {{"regret"}, {"worst"}});
    for (const standing& one : all) {
        std::vector<std::string>& cells = t.rows.emplace_back(name_cells_of(differing, one.name, t.rows.size() + 1));
        if (inexact) cells.emplace_back(one.exact ? "exact" : "inexact");
        for (const double ratio : {one.ratio(), one.least, one.greatest}) cells.push_back(fmt::format("{:.2f}", ratio));
        cells.push_back(grouped(one.scenes));
        cells.push_back(grouped(one.wins));
        if (!regretted) continue;
        cells.push_back(fmt::format("{:.2f}", quartiles_of(one.regrets).median));
        cells.push_back(fmt::format("{:.2f}", std::ranges::max(one.regrets)));
    }
    return t;
}

}  // namespace aabblab
