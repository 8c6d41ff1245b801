module aabblab.tables;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// Bytes in KiB, with three significant digits.
std::string kib_text(std::uint64_t bytes) {
    const double kib = static_cast<double>(bytes) / 1024;
    return kib < 100 ? fmt::format("{:.1f}", kib) : grouped(static_cast<std::uint64_t>(std::llround(kib)));
}

std::string text_or_dash(const std::optional<double>& value, int decimals) {
    return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

/// True if any candidate of the scene has a value of the member.
template <class Value>
bool any_has(const scene_summary& scene, std::optional<Value> candidate_summary::* member) {
    return std::ranges::any_of(scene.candidates, [&](const candidate_summary& c) { return (c.*member).has_value(); });
}

/// "exact", "inexact", or "-3 +5" for three false negatives and five false positives.
std::string result_of(const candidate_summary& candidate) {
    if (candidate.status == "exact" || !candidate.false_negatives) return candidate.status;
    return fmt::format("-{} +{}", *candidate.false_negatives, *candidate.false_positives);
}

/// The decimals that show at least three digits of the fastest time of a scene.
int decimals_of(const scene_summary& scene) {
    double least = 100;
    for (const candidate_summary& candidate : scene.candidates)
        if (candidate.ms_per_frame) least = std::min(least, candidate.ms_per_frame->median);
    return least < 1 ? 4 : least < 10 ? 3 : 2;
}

/// The cells of time, quartiles, ratio and its interval; "-" if the candidate was not timed.
std::vector<std::string> time_cells(const candidate_summary& candidate, int decimals) {
    if (!candidate.ms_per_frame) return {"-", "-", "-", "-"};
    const auto [low, median, high] = *candidate.ms_per_frame;
    const std::optional<interval>& range = candidate.ratio_interval;
    return {fmt::format("{:.{}f}", median, decimals), three_digits(low) + "-" + three_digits(high),
            text_or_dash(candidate.ratio, 2), range ? fmt::format("{:.2f}-{:.2f}", range->low, range->high) : "-"};
}

/// A column that moves above the table if it is constant.
struct shared_column {
    column shown;
    std::string above;  ///< "{} pairs"
    std::vector<std::string> cells;

    [[nodiscard]] bool is_constant() const {
        return cells.size() > 1 && std::ranges::adjacent_find(cells, std::ranges::not_equal_to{}) == cells.end();
    }
};

/// The columns that move to the heading if all their cells are equal, as results of exact candidates are.
std::vector<shared_column> shared_columns(const scene_summary& scene,
                                          std::span<const candidate_summary* const> ranking) {
    shared_column result{{"result"}, "{}", {}};
    shared_column pairs{{"pairs"}, "{} pairs of boxes", {}};
    shared_column contacts{{.name = "contacts", .spare = 1}, "{} pairs of triangles", {}};
    shared_column bytes{{.name = "KiB", .spare = 2}, "{} KiB", {}};
    for (const candidate_summary* candidate : ranking) {
        result.cells.push_back(result_of(*candidate));
        pairs.cells.push_back(grouped(candidate->pairs));
        contacts.cells.push_back(candidate->contacts ? grouped(*candidate->contacts) : "-");
        bytes.cells.push_back(candidate->bytes ? kib_text(*candidate->bytes) : "-");
    }
    std::vector<shared_column> columns{std::move(result), std::move(pairs)};
    if (any_has(scene, &candidate_summary::contacts)) columns.push_back(std::move(contacts));
    if (any_has(scene, &candidate_summary::bytes)) columns.push_back(std::move(bytes));
    return columns;
}

/// True if any composition, not only engines, has a value other than 0 at this index: tables omit other columns.
template <class Numbers>
bool any_composition_has(const scene_summary& scene, Numbers candidate_summary::* numbers, std::size_t index) {
    return std::ranges::any_of(scene.candidates, [&](const candidate_summary& candidate) {
        return !candidate.name.is_reference() && (candidate.*numbers)[index].value_or(0) > 0;
    });
}

/// "box_tests" as "box tests".
std::string spaced(std::string_view name) {
    std::string text(name);
    std::ranges::replace(text, '_', ' ');
    return text;
}

std::string count_text(double value) {
    return value != 0 && value < 100 ? fmt::format("{:.1f}", value)
                                     : grouped(static_cast<std::uint64_t>(std::llround(value)));
}

/// "all compositions: prepare none, triangle exact", the strategies that all share; empty if they share none.
std::string common_line(const scene_summary& scene) {
    if (scene.common.empty()) return "";
    const auto is_automatic = [](const candidate_summary& candidate) { return candidate.name.is_automatic(); };
    const char* const which = scene.differing.empty()                               ? "this composition: "
                              : std::ranges::any_of(scene.candidates, is_automatic) ? "all compositions but auto: "
                                                                                    : "all compositions: ";
    return which + scene.common + "\n";
}

/// The columns that the table omits because all their cells are equal; empty if there are none.
std::string constant_line(const scene_summary& scene, std::span<const candidate_summary* const> ranking) {
    std::string constant;
    for (const shared_column& c : shared_columns(scene, ranking))
        if (c.is_constant())
            constant += (constant.empty() ? "" : ", ") + fmt::format(fmt::runtime(c.above), c.cells[0]);
    return constant.empty() ? "" : "all candidates, over all frames: " + constant + "\n";
}

/// Explains results such as "-3 +5" by the first one in the table; empty if there are none.
std::string errors_line(std::span<const candidate_summary* const> ranking) {
    for (const candidate_summary* c : ranking)
        if (c->status != "exact" && c->false_negatives)
            return fmt::format("a result {} has {} false negatives and {} false positives\n", result_of(*c),
                               *c->false_negatives, *c->false_positives);
    return "";
}

/// The candidates that were stopped early, and therefore have fewer repeats; empty if there are none.
std::string stopped_line(const scene_summary& scene) {
    std::size_t repeats = 0;
    for (const candidate_summary& candidate : scene.candidates) repeats = std::max(repeats, candidate.repeats);
    std::string stopped;
    for (const candidate_summary& candidate : scene.candidates)
        if (candidate.repeats < repeats) stopped += (stopped.empty() ? "" : ", ") + candidate.label;
    return stopped.empty() ? "" : "repeated less often than others: " + stopped + "\n";
}

/// The label of the first candidate; "none" alone would read as if there were no baseline.
std::string baseline_of(const scene_summary& scene) {
    const std::string& label = scene.candidates[0].label;
    return label == "none" ? std::string(name_of(scene.differing.front())) + " none" : label;
}

/// How to read the order of the rows, the columns of the table, and missing intervals.
std::string explanation_of_columns(const scene_summary& scene) {
    std::string text;
    const bool inexact = std::ranges::any_of(scene.candidates, [](const auto& c) { return c.status != "exact"; });
    if (scene.candidates.size() > 1 && any_has(scene, &candidate_summary::ratio))
        text += std::string("in ascending order of ratio") +
                (inexact ? ", exact results before inexact ones\n" : "\n") +
                "ratio: ms/frame relative to the baseline in the same repeat, the median over\nrepeats, with its 95 % "
                "confidence interval\nbaseline: " +
                baseline_of(scene) + "\n";
    if (any_has(scene, &candidate_summary::ms_per_frame))
        text += "ms/frame: the mean wall time per frame after frame 0, the median over repeats\n";
    if (any_has(scene, &candidate_summary::bytes)) text += "KiB: memory after the last frame, without meshes\n";
    if (std::ranges::any_of(scene.candidates, [](const candidate_summary& c) { return c.ratio && !c.ratio_interval; }))
        text +=
            "95 %: - if repeats, seeds or processes are too few; for one seed in one process,\n4 repeats are enough\n";
    return text;
}

}  // namespace

/// The candidates of a scene by rank: times if timed, results and bytes unless the heading has them, and metrics.
/// @param shown the names of the metrics asked for
table table_of(const scene_summary& scene, std::span<const std::string> shown) {
    const bool has_meshes = any_has(scene, &candidate_summary::contacts);
    const int decimals = decimals_of(scene);
    const std::vector<const candidate_summary*> ranking = ranking_of(scene);
    table t{name_columns_of(scene.differing), {}};
    for (const candidate_summary* candidate : ranking)
        t.rows.push_back(name_cells_of(scene.differing, candidate->name, t.rows.size() + 1));
    if (any_has(scene, &candidate_summary::ms_per_frame)) {
        t.columns.insert(t.columns.end(), {{"ms/frame"}, {.name = "quartiles", .spare = 4}, {"ratio"}, {"95 %"}});
        if (has_meshes) t.columns.push_back({.name = "build ms", .spare = 3});
        std::size_t i = 0;
        for (const candidate_summary* candidate : ranking) {
            std::vector<std::string>& cells = t.rows[i++];
            for (std::string& cell : time_cells(*candidate, decimals)) cells.push_back(std::move(cell));
            if (has_meshes) cells.push_back(text_or_dash(candidate->build_ms, 2));
        }
    }
    for (const shared_column& c : shared_columns(scene, ranking)) {
        if (c.is_constant()) continue;
        t.columns.push_back(c.shown);
        for (std::size_t i = 0; i < t.rows.size(); ++i) t.rows[i].push_back(c.cells[i]);
    }
    for (const std::string& name : shown) {
        const metric& m = metric_named(name);
        const auto index = static_cast<std::size_t>(&m - metrics().data());
        t.columns.push_back({m.unit.empty() ? name : name + " (" + m.unit + ")"});
        for (std::size_t i = 0; i < t.rows.size(); ++i) {
            const std::optional<double>& value = ranking[i]->metrics[index];
            t.rows[i].push_back(value ? fmt::format("{:.6g}", *value) : "-");
        }
    }
    return t;
}

/// The lines above the table of a scene: what the table would otherwise repeat in every row, and how to read it.
std::string heading_of(const scene_summary& scene) {
    std::string text = fmt::format("{}: {}, frame 0{}\n", scene.scene.kind, counted(scene.objects, "object"),
                                   scene.frames > 1 ? fmt::format(" and {} more", grouped(scene.frames - 1)) : "");
    std::string parameters = settings_text(scene.scene);
    if (scene.seeds.size() == 1) parameters += fmt::format("{}seed={}", parameters.empty() ? "" : " ", scene.seeds[0]);
    text += parameters + "\n";
    if (scene.seeds.size() > 1)
        text += fmt::format("pooled over {} seeds: pairs are sums, ratios geometric means\n", scene.seeds.size());
    const std::vector<const candidate_summary*> ranking = ranking_of(scene);
    text += common_line(scene) + constant_line(scene, ranking);
    if (!scene.digest.empty()) text += "digest of the ground truth: " + scene.digest + "\n";
    return text + errors_line(ranking) + stopped_line(scene) + explanation_of_columns(scene);
}

/// Work per frame after frame 0 and memory by part, by rank, without empty columns and rows of other libraries.
table counts_table_of(const scene_summary& scene) {
    constexpr auto copies = static_cast<std::size_t>(aabb::work::subset_copies);
    table t{name_columns_of(scene.differing), {}};
    std::vector<std::size_t> works, parts;  // indices of the columns with values
    for (std::size_t i = 0; i < aabb::work_names.size(); ++i) {
        if (!any_composition_has(scene, &candidate_summary::counts, i)) continue;
        works.push_back(i);
        t.columns.push_back({spaced(aabb::work_names[i])});
        if (i == copies) t.columns.push_back({"copies per object"});
    }
    for (std::size_t i = 0; i < byte_columns.size(); ++i) {
        // The meshes are the same for all compositions.
        if (byte_columns[i] == "triangles" || byte_columns[i] == "vertices") continue;
        if (!any_composition_has(scene, &candidate_summary::bytes_by_part, i)) continue;
        parts.push_back(i);
        t.columns.push_back({"KiB " + spaced(byte_columns[i])});
    }
    if (works.empty() && parts.empty()) return {};
    const bool has_trees = any_has(scene, &candidate_summary::bytes_per_triangle);
    const bool inflated = std::ranges::any_of(
        scene.candidates, [](const candidate_summary& candidate) { return candidate.box_inflation.value_or(0) > 0; });
    if (has_trees) t.columns.push_back({"tree bytes per triangle"});
    if (inflated) t.columns.push_back({"box inflation %"});
    std::size_t rank = 0;
    for (const candidate_summary* candidate : ranking_of(scene)) {
        ++rank;
        if (candidate->name.is_reference()) continue;
        std::vector<std::string>& cells = t.rows.emplace_back(name_cells_of(scene.differing, candidate->name, rank));
        for (const std::size_t i : works) {
            const double count = candidate->counts[i].value_or(0);
            cells.push_back(count_text(count));
            if (i == copies) cells.push_back(fmt::format("{:.3f}", count / static_cast<double>(scene.objects)));
        }
        for (const std::size_t i : parts) cells.push_back(kib_text(candidate->bytes_by_part[i].value_or(0)));
        if (has_trees) cells.push_back(text_or_dash(candidate->bytes_per_triangle, 2));
        if (inflated)
            cells.push_back(candidate->box_inflation ? fmt::format("{:.3f}", 100 * *candidate->box_inflation) : "-");
    }
    return t;
}

}  // namespace aabblab
