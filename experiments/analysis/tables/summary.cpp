module aabblab.tables;

import aabblab.text;

namespace aabblab {

namespace {

using repeats_of_candidate = std::vector<const row*>;

std::optional<double> ms_per_frame(const row& r) {
    static const row_value& frame = measured("frame_ms");
    return frame(r);
}

/// Adds a value to a sum, which stays empty if all its values are.
template <class Number>
void add(std::optional<Number>& sum, const std::optional<Number>& value) {
    if (value) sum = sum.value_or(0) + *value;
}

/// Adds a seed to the summary of a candidate, without times. Over the seeds, pairs and errors are sums, bytes are
/// maxima and counts of work are means.
/// @param share the weight of the seed in means: 1 / number of seeds
void add_untimed(const row& r, double share, candidate_summary& summary) {
    summary.pairs += r.candidates;
    add(summary.contacts, r.contacts);
    add(summary.false_negatives, r.false_negatives);
    add(summary.false_positives, r.false_positives);
    if (summary.status != "inexact") summary.status = r.status;  // one inexact seed is enough
    const auto all_bytes = measured("all_bytes")(r);
    summary.bytes =
        std::max(summary.bytes, all_bytes ? std::optional(static_cast<std::uint64_t>(*all_bytes)) : std::nullopt);
    const auto tree_bytes = measured("tree_bytes")(r);
    if (tree_bytes.value_or(0) > 0) summary.bytes_per_triangle = std::max(summary.bytes_per_triangle, tree_bytes);
    if (r.box_inflation) add(summary.box_inflation, std::optional(*r.box_inflation * share));
    // Counts are of the frames after frame 0, or of frame 0 if there is no other.
    const double counted_frames = r.frames > 1 ? static_cast<double>(r.frames - 1) : 1;
    for (std::size_t i = 0; i < r.counts.size(); ++i)
        if (r.counts[i])
            add(summary.counts[i], std::optional(static_cast<double>(*r.counts[i]) / counted_frames * share));
    for (std::size_t i = 0; i < r.bytes.size(); ++i)
        summary.bytes_by_part[i] = std::max(summary.bytes_by_part[i], r.bytes[i]);
}

/// Summarises all repeats of one composition or engine in one scene, over all seeds, except its ratio to the baseline.
candidate_summary summary_of(std::span<const row* const> repeats) {
    candidate_summary summary;
    summary.name = repeats[0]->name;
    summary.repeats = repeats.size();
    // Repeats of a seed differ only in times: its first row has its pairs, errors, bytes and counts.
    std::map<std::optional<std::uint64_t>, const row*> first_rows;  // by seed
    for (const row* r : repeats) first_rows.emplace(r->scene.seed, r);
    for (const auto& [seed, r] : first_rows) add_untimed(*r, 1 / static_cast<double>(first_rows.size()), summary);
    std::vector<double> times, builds;
    for (const row* r : repeats)
        if (const std::optional<double> ms = ms_per_frame(*r)) {
            times.push_back(*ms);
            builds.push_back(*r->build_ms);  // timed with the frames
        }
    for (const metric& m : metrics()) {
        std::vector<double> values;
        for (const row* r : repeats)
            if (const std::optional<double> value = m.value(*r)) values.push_back(*value);
        // A median over seeds would hide errors that occur in a single seed.
        summary.metrics.push_back(
            values.empty() ? std::nullopt
            : m.group == metric_group::error
                ? std::optional(std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()))
                : std::optional(quartiles_of(values).median));
    }
    if (times.empty()) return summary;
    summary.ms_per_frame = quartiles_of(times);
    summary.build_ms = quartiles_of(builds).median;
    return summary;
}

/// Sets the ratio to the baseline's times in the same repeat and seed, and its 95 % interval, by a bootstrap.
void set_ratio(candidate_summary& summary, std::span<const row* const> repeats, std::span<const row* const> baseline) {
    std::map<std::pair<std::optional<std::uint64_t>, std::uint64_t>, double> base_ms;  // by seed and repeat
    for (const row* b : baseline)
        if (ms_per_frame(*b).value_or(0) > 0) base_ms.emplace(std::pair(b->scene.seed, b->repeat), *ms_per_frame(*b));
    std::map<std::optional<std::uint64_t>, std::size_t> seeds;
    std::map<std::uint64_t, std::size_t> processes;
    for (const row* r : repeats) {
        seeds.emplace(r->scene.seed, seeds.size());
        processes.emplace(r->process, processes.size());
    }
    cells ratios(processes.size(), seeds.size());
    std::size_t count = 0;
    for (const row* r : repeats) {
        const auto denominator = base_ms.find({r->scene.seed, r->repeat});
        if (denominator == base_ms.end() || ms_per_frame(*r).value_or(0) <= 0) continue;
        ratios.add(processes.at(r->process), seeds.at(r->scene.seed),
                   std::log(*ms_per_frame(*r) / denominator->second));
        ++count;
    }
    if (count == 0) return;
    const estimate log_ratio = bootstrap(ratios);
    summary.ratio = std::exp(log_ratio.value);
    // Student's t has infinite variance with two degrees of freedom or fewer: such an interval is useless.
    if (count == 1 || (log_ratio.error > 0 && log_ratio.degrees <= 2)) return;
    const auto [low, high] = log_ratio.range();
    summary.ratio_interval = {std::exp(low), std::exp(high)};
}

/// Labels candidates by an engine's name, or by strategies that differ within the scene; `common` has the others.
void set_labels(scene_summary& scene) {
    std::vector<candidate_name> names;
    for (const candidate_summary& summary : scene.candidates) names.push_back(summary.name);
    scene.differing = differing_kinds(names);
    // Any composition will do: they all share what does not differ. Only engines have a name in `engine`.
    const auto composition = std::ranges::find(names, "", &candidate_name::engine);
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (composition == names.end() || std::ranges::find(scene.differing, kind) != scene.differing.end()) continue;
        if (const std::string& value = composition->choices[kind]; !value.empty())
            scene.common += (scene.common.empty() ? "" : ", ") + std::string(name_of(kind)) + " " + value;
    }
    for (candidate_summary& summary : scene.candidates) {
        const candidate_name& name = summary.name;
        summary.label = name.engine.empty() ? label_of(name.choices, scene.differing) : name.engine;
        if (summary.label.empty()) summary.label = only_name_of(name);
    }
}

/// The rows of a scene over all its seeds, by composition or engine.
struct rows_of_scene {
    scene_summary scene;
    std::vector<repeats_of_candidate> candidates;
    std::map<candidate_name, std::size_t> indices;  // of `candidates`

    /// Adds a row to those of its candidate, and its seed to those of the scene.
    void add(const row& r) {
        const auto [index, is_new] = indices.emplace(r.name, candidates.size());
        if (is_new) candidates.emplace_back();
        candidates[index->second].push_back(&r);
        if (r.scene.seed && std::ranges::find(scene.seeds, *r.scene.seed) == scene.seeds.end())
            scene.seeds.push_back(*r.scene.seed);
        // Exact rows of a seed have one digest, or they are rejected.
        if (r.status == "exact") scene.digest = r.digest;
    }
};

}  // namespace

/// Groups the rows by scene, over all seeds, then by candidate; the first candidate of a scene is its baseline.
std::vector<scene_summary> summarise(std::span<const row> rows) {
    std::vector<rows_of_scene> groups;
    std::map<std::pair<std::string, scene_choice>, std::size_t> indices;
    for (const row& r : rows) {
        const auto [index, is_new] = indices.emplace(std::pair(r.experiment, without_seed(r.scene)), groups.size());
        if (is_new) {
            scene_summary& scene = groups.emplace_back().scene;
            scene.experiment = r.experiment;
            scene.scene = without_seed(r.scene);
            scene.objects = r.objects;
            scene.frames = r.frames;
        }
        groups[index->second].add(r);
    }
    std::vector<scene_summary> scenes;
    for (rows_of_scene& group : groups) {
        for (const repeats_of_candidate& repeats : group.candidates) {
            group.scene.candidates.push_back(summary_of(repeats));
            set_ratio(group.scene.candidates.back(), repeats, group.candidates[0]);
        }
        if (group.scene.seeds.size() > 1) group.scene.digest.clear();  // each seed has its own
        set_labels(group.scene);
        scenes.push_back(std::move(group.scene));
    }
    return scenes;
}

/// The candidates in the order of tables: timed ones and exact ones first, then by ratio to the baseline or by time.
std::vector<const candidate_summary*> ranking_of(const scene_summary& scene) {
    std::vector<const candidate_summary*> candidates;
    for (const candidate_summary& summary : scene.candidates) candidates.push_back(&summary);
    const auto key = [](const candidate_summary* c) {  // false precedes true; by the pointer, equals stay in order
        const double ms = c->ms_per_frame ? c->ms_per_frame->median : 0;
        return std::tuple(!c->ms_per_frame, c->status != "exact", !c->ratio, c->ratio.value_or(0), ms, c);
    };
    std::ranges::sort(candidates, {}, key);
    return candidates;
}

/// The kinds of strategy in which compositions differ: tables name only these in each row. Engines have no strategies.
std::vector<aabb::strategy_kind> differing_kinds(std::span<const candidate_name> names) {
    std::vector<aabb::strategy_kind> kinds;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        std::set<std::string> values;
        for (const candidate_name& name : names)
            if (name.engine.empty()) values.insert(name[kind]);
        if (values.size() > 1) kinds.push_back(kind);
    }
    return kinds;
}

std::vector<column> name_columns_of(std::span<const aabb::strategy_kind> differing) {
    std::vector<column> columns{{row_number}};
    for (const aabb::strategy_kind kind : differing)
        columns.push_back({std::string(name_of(kind)), /*is_number=*/false});
    if (differing.empty()) columns.push_back({"composition", /*is_number=*/false});
    return columns;
}

/// The first cells of a row: the rank, then the strategies of the kinds that differ, or in the first an engine's name.
std::vector<std::string> name_cells_of(std::span<const aabb::strategy_kind> differing, const candidate_name& name,
                                       std::size_t rank) {
    std::vector<std::string> cells{std::to_string(rank)};
    if (name.engine.empty())
        for (const aabb::strategy_kind kind : differing) cells.push_back(name[kind]);
    else
        cells.push_back(name.engine);
    if (cells.size() == 1) cells.push_back(only_name_of(name));
    cells.resize(1 + std::max<std::size_t>(differing.size(), 1));
    return cells;
}

std::string only_name_of(const candidate_name& name) {
    constexpr std::size_t most = 32;  // beside all columns of numbers, in a line of 80
    const std::string text = label_of(name.choices);
    return text.empty() || characters(text) > most ? "this composition" : text;
}

}  // namespace aabblab
