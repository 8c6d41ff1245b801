module aabblab.tables;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The ratio of the fastest exact line; empty if no exact line was timed.
std::optional<double> least_ratio_of(const scene_summary& scene) {
    std::optional<double> least;
    for (const summary_line& line : scene.lines)
        if (line.ratio && line.status == "exact") least = std::min(least.value_or(*line.ratio), *line.ratio);
    return least;
}

/// The ratios of one composition or engine over the scenes.
struct standing {
    candidate_name name;
    std::size_t wins = 0;  ///< scenes in which it is the fastest exact line
    bool exact = true;
    std::vector<double> ratios;
    std::vector<double> regrets;  ///< ratios relative to the fastest exact line

    void add(const summary_line& line, bool is_fastest, std::optional<double> least_ratio) {
        if (least_ratio) regrets.push_back(*line.ratio / *least_ratio);
        wins += is_fastest ? 1 : 0;
        exact = exact && line.status == "exact";
        ratios.push_back(*line.ratio);
    }
    /// The geometric mean over the scenes.
    [[nodiscard]] double ratio() const {
        double log_sum = 0;
        for (const double value : ratios) log_sum += std::log(value);
        return std::exp(log_sum / static_cast<double>(ratios.size()));
    }
};

std::string text_of(const std::optional<std::uint64_t>& value) {
    return value ? fmt::format("{}", *value) : "";
}

/// Metrics that the table shows with more than a median, in columns of their own.
bool has_own_column(const metric& m) {
    constexpr std::array<std::string_view, 5> names{"frame_ms", "build_ms", "all_bytes", "missing", "invented"};
    return std::ranges::find(names, m.name) != names.end();
}

/// The cells of a line in the columns of `full_table_of`.
std::vector<std::string> cells_of(const scene_summary& scene, const summary_line& line, std::size_t rank) {
    std::vector<std::string> cells{scene.experiment,
                                   scene.scene.kind,
                                   parameters_json(scene.scene),
                                   fmt::format("{}", fmt::join(scene.seeds, " ")),
                                   fmt::format("{}", scene.objects),
                                   fmt::format("{}", scene.frames)};
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) cells.push_back(line.name[kind]);
    cells.insert(cells.end(), {line.name.engine, fmt::format("{}", rank), line.status, text_of(line.false_negatives),
                               text_of(line.false_positives), fmt::format("{}", line.pairs), text_of(line.contacts),
                               fmt::format("{}", line.repeats)});
    const auto& ms = line.ms_per_frame;
    const auto& range = line.ratio_interval;
    for (const std::optional<double>& value :
         {ms ? std::optional(ms->median) : std::nullopt, ms ? std::optional(ms->low) : std::nullopt,
          ms ? std::optional(ms->high) : std::nullopt, line.ratio, range ? std::optional(range->low) : std::nullopt,
          range ? std::optional(range->high) : std::nullopt, line.build_ms})
        cells.push_back(value ? fmt::format("{:.6f}", *value) : "");
    cells.push_back(text_of(line.bytes));
    for (std::size_t i = 0; i < metrics().size(); ++i)
        if (!has_own_column(metrics()[i])) cells.push_back(line.metrics[i] ? fifteen_digits(*line.metrics[i]) : "");
    return cells;
}

}  // namespace

table overall_table_of(std::span<const scene_summary> scenes) {
    std::vector<standing> standings;
    std::map<candidate_name, std::size_t> places;
    for (const scene_summary& scene : scenes) {
        const summary_line* const fastest = ranking_of(scene).front();
        const std::optional<double> least_ratio = least_ratio_of(scene);
        for (const summary_line& line : scene.lines) {
            if (!line.ratio) continue;
            const auto [place, is_new] = places.emplace(line.name, standings.size());
            if (is_new) standings.emplace_back().name = line.name;
            standings[place->second].add(line, &line == fastest, least_ratio);
        }
    }
    std::vector<candidate_name> names;
    for (const standing& entry : standings) names.push_back(entry.name);
    const std::vector<aabb::strategy_kind> differing = differing_kinds(names);
    std::ranges::sort(standings, {}, [](const standing& s) { return std::tuple(!s.exact, s.ratio(), s.name); });
    const bool inexact = std::ranges::any_of(standings, [](const standing& entry) { return !entry.exact; });
    table t{name_columns_of(differing), {}};
    if (inexact) t.columns.push_back({"result"});
    t.columns.insert(t.columns.end(),
                     {{"ratio"}, {"least", true, 2}, {"greatest", true, 1}, {"scenes"}, {"fastest in"}});
    const bool has_regrets =
        std::ranges::all_of(standings, [](const standing& entry) { return !entry.regrets.empty(); });
    if (has_regrets) t.columns.insert(t.columns.end(), {{"regret"}, {"worst"}});
    for (const standing& entry : standings) {
        std::vector<std::string>& cells = t.rows.emplace_back(name_cells_of(differing, entry.name, t.rows.size() + 1));
        if (inexact) cells.emplace_back(entry.exact ? "exact" : "inexact");
        const auto [least, greatest] = std::ranges::minmax(entry.ratios);
        for (const double ratio : {entry.ratio(), least, greatest}) cells.push_back(fmt::format("{:.2f}", ratio));
        cells.push_back(grouped(entry.ratios.size()));
        cells.push_back(grouped(entry.wins));
        if (!has_regrets) continue;
        cells.push_back(fmt::format("{:.2f}", quartiles_of(entry.regrets).median));
        cells.push_back(fmt::format("{:.2f}", std::ranges::max(entry.regrets)));
    }
    return t;
}

table full_table_of(std::span<const scene_summary> scenes) {
    table t;
    for (const char* name : {"experiment", "scene", "scene_parameters", "seeds", "objects", "frames"})
        t.columns.push_back({name});
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) t.columns.push_back({std::string(name_of(kind))});
    for (const char* name :
         {"engine", "rank", "status", "missing", "invented", "candidates", "contacts", "repeats", "frame_ms",
          "frame_ms_low", "frame_ms_high", "ratio", "ratio_low", "ratio_high", "build_ms", "all_bytes"})
        t.columns.push_back({name});
    for (const metric& m : metrics())
        if (!has_own_column(m)) t.columns.push_back({m.name});
    for (const scene_summary& scene : scenes) {
        std::size_t rank = 0;
        for (const summary_line* line : ranking_of(scene)) t.rows.push_back(cells_of(scene, *line, ++rank));
    }
    return t;
}

}  // namespace aabblab
