module aabblab.tables;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The ratio, to the baseline, of the fastest exact candidate of a scene; empty if none was timed.
std::optional<double> least_ratio_of(const scene_summary& scene) {
    std::optional<double> least;
    for (const candidate_summary& c : scene.candidates)
        if (c.ratio && c.status == "exact") least = std::min(least.value_or(*c.ratio), *c.ratio);
    return least;
}

/// The ratios of one composition or engine over the scenes.
struct standing {
    candidate_name name;
    std::size_t wins = 0;  ///< scenes in which it is the fastest exact one
    bool is_exact = true;
    std::vector<double> ratios;
    std::vector<double> regrets;  ///< ratios relative to the fastest exact one

    void add(const candidate_summary& candidate, bool is_fastest, std::optional<double> least_ratio) {
        if (least_ratio) regrets.push_back(*candidate.ratio / *least_ratio);
        wins += is_fastest ? 1 : 0;
        is_exact = is_exact && candidate.status == "exact";
        ratios.push_back(*candidate.ratio);
    }
    /// The geometric mean over the scenes.
    [[nodiscard]] double ratio() const {
        double log_sum = 0;
        for (const double value : ratios) log_sum += std::log(value);
        return std::exp(log_sum / static_cast<double>(ratios.size()));
    }
};

/// The ratios of each candidate, sorted by their geometric means, exact candidates before inexact ones.
std::vector<standing> standings_of(std::span<const scene_summary> scenes) {
    std::vector<standing> standings;
    std::map<candidate_name, std::size_t> indices;
    for (const scene_summary& scene : scenes) {
        const candidate_summary* const fastest = ranking_of(scene).front();
        const std::optional<double> least_ratio = least_ratio_of(scene);
        for (const candidate_summary& candidate : scene.candidates) {
            if (!candidate.ratio) continue;
            const auto [index, is_new] = indices.emplace(candidate.name, standings.size());
            if (is_new) standings.emplace_back().name = candidate.name;
            standings[index->second].add(candidate, &candidate == fastest, least_ratio);
        }
    }
    std::ranges::sort(standings, {}, [](const standing& s) { return std::tuple(!s.is_exact, s.ratio(), s.name); });
    return standings;
}

std::string text_of(const std::optional<std::uint64_t>& value) {
    return value ? fmt::format("{}", *value) : "";
}

/// Metrics that the table shows with more than a median, in columns of their own.
bool has_own_column(const metric& m) {
    constexpr std::array<std::string_view, 5> names{"frame_ms", "build_ms", "all_bytes", "missing", "invented"};
    return std::ranges::find(names, m.name) != names.end();
}

/// The cells of a candidate in the columns of `full_table_of`: its names, results, times, bytes and metrics.
std::vector<std::string> cells_of(const scene_summary& scene, const candidate_summary& candidate, std::size_t rank) {
    std::vector<std::string> cells{scene.experiment, scene.scene.kind, parameters_json(scene.scene)};
    cells.push_back(fmt::format("{}", fmt::join(scene.seeds, " ")));
    for (const std::uint64_t count : {scene.objects, scene.frames}) cells.push_back(fmt::format("{}", count));
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) cells.push_back(candidate.name[kind]);
    cells.insert(cells.end(),
                 {candidate.name.engine, fmt::format("{}", rank), candidate.status, text_of(candidate.false_negatives),
                  text_of(candidate.false_positives), fmt::format("{}", candidate.pairs), text_of(candidate.contacts),
                  fmt::format("{}", candidate.repeats)});
    const auto& ms = candidate.ms_per_frame;
    const auto& range = candidate.ratio_interval;
    for (const std::optional<double>& value :
         {ms ? std::optional(ms->median) : std::nullopt, ms ? std::optional(ms->low) : std::nullopt,
          ms ? std::optional(ms->high) : std::nullopt, candidate.ratio,
          range ? std::optional(range->low) : std::nullopt, range ? std::optional(range->high) : std::nullopt,
          candidate.build_ms})
        cells.push_back(value ? fmt::format("{:.6f}", *value) : "");
    cells.push_back(text_of(candidate.bytes));
    for (std::size_t i = 0; i < metrics().size(); ++i)
        if (!has_own_column(metrics()[i]))
            cells.push_back(candidate.metrics[i] ? fifteen_digits(*candidate.metrics[i]) : "");
    return cells;
}

}  // namespace

/// A row per candidate over all scenes. Its ratio in a scene is its time over that of the baseline, its regret the
/// ratio over the least one of an exact candidate.
table overall_table_of(std::span<const scene_summary> scenes) {
    const std::vector<standing> standings = standings_of(scenes);
    std::vector<candidate_name> names;
    for (const standing& entry : standings) names.push_back(entry.name);
    const std::vector<aabb::strategy_kind> differing = differing_kinds(names);
    const bool inexact = !std::ranges::all_of(standings, &standing::is_exact);
    table t{name_columns_of(differing), {}};
    if (inexact) t.columns.push_back({"result"});
    const column least_column{.name = "least", .spare = 2}, greatest_column{.name = "greatest", .spare = 1};
    t.columns.insert(t.columns.end(), {{"ratio"}, least_column, greatest_column, {"scenes"}, {"fastest in"}});
    const bool has_regrets = std::ranges::none_of(standings, [](const standing& s) { return s.regrets.empty(); });
    if (has_regrets) t.columns.insert(t.columns.end(), {{"regret"}, {"worst"}});
    for (const standing& entry : standings) {
        std::vector<std::string>& cells = t.rows.emplace_back(name_cells_of(differing, entry.name, t.rows.size() + 1));
        if (inexact) cells.emplace_back(entry.is_exact ? "exact" : "inexact");
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

/// One row per scene and candidate, for programs: no column is left out, and names are not abbreviated.
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
        for (const candidate_summary* c : ranking_of(scene)) t.rows.push_back(cells_of(scene, *c, ++rank));
    }
    return t;
}

}  // namespace aabblab
