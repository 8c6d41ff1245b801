module aabblab.comparison;

import aabb.base;
import aabb.counters;
import aabblab.fmt;
import aabblab.metrics;
import aabblab.tables;

namespace aabblab {

namespace {

using scene_key = std::pair<std::string, scene_choice>;

/// The rows of a run by scene, then by composition or engine.
class rows_by_scene {
public:
    explicit rows_by_scene(std::span<const row> rows) {
        for (const row& r : rows) scenes_[{r.experiment, r.scene}][r.name].push_back(&r);
    }

    using repeats = std::vector<const row*>;
    using repeats_by_name = std::map<candidate_name, repeats>;
    [[nodiscard]] const std::map<scene_key, repeats_by_name>& scenes() const { return scenes_; }
    /// Empty if the run lacks the scene or the name.
    [[nodiscard]] const repeats& of(const scene_key& scene, const candidate_name& name) const {
        static const repeats none;
        const auto by_name = scenes_.find(scene);
        if (by_name == scenes_.end()) return none;
        const auto entry = by_name->second.find(name);
        return entry != by_name->second.end() ? entry->second : none;
    }

private:
    std::map<scene_key, repeats_by_name> scenes_;
};

/// A scene with the seeds and the names that occur in both runs, though not every seed has rows of every name.
struct shared_scene {
    const row* first_row;               ///< of A
    std::vector<scene_key> seeds;       ///< differ in their seed only
    std::vector<candidate_name> names;  ///< in the order of A
};

template <class T>
void add_once(std::vector<T>& list, const T& value) {
    if (std::ranges::find(list, value) == list.end()) list.push_back(value);
}

/// The scenes of both runs, whatever their seeds, with the seeds and the candidates that both have.
std::vector<shared_scene> scenes_shared(std::span<const row> a, const rows_by_scene& b) {
    std::vector<shared_scene> scenes;
    std::map<scene_key, std::size_t> indices;  // keyed without the seed
    for (const row& r : a) {
        const scene_key with_seed{r.experiment, r.scene};
        if (b.of(with_seed, r.name).empty()) continue;
        const auto [index, is_new] = indices.emplace(scene_key{r.experiment, without_seed(r.scene)}, scenes.size());
        if (is_new) scenes.push_back({.first_row = &r, .seeds = {}, .names = {}});
        add_once(scenes[index->second].seeds, with_seed);
        add_once(scenes[index->second].names, r.name);
    }
    return scenes;
}

/// Short labels of the candidates of a scene: the strategies that differ, as in its table.
std::vector<std::string> labels_of(std::span<const candidate_name> names) {
    std::vector<row> rows(names.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].name = names[i];
    const scene_summary scene = summarise(rows).at(0);
    if (names.size() == 1 && !scene.common.empty()) return {scene.common};
    std::vector<std::string> labels;
    for (const candidate_summary& candidate : scene.candidates) labels.push_back(candidate.label);
    return labels;
}

/// The logarithm of a repeat's time per frame; empty if the row has no positive time.
std::optional<double> log_ms(const row& r) {
    static const row_value& frame_ms = measured("frame_ms");
    if (!r.first_ms || !r.search_ms || !r.detect_ms) return std::nullopt;
    const double ms = frame_ms(r).value_or(0);
    return std::isfinite(ms) && ms > 0 ? std::optional(std::log(ms)) : std::nullopt;
}

std::optional<double> log_ms_in(const rows_by_scene::repeats& rows, const row& same_repeat) {
    for (const row* r : rows)
        if (r->repeat == same_repeat.repeat)
            if (const std::optional<double> ms = log_ms(*r)) return ms;
    return std::nullopt;
}

std::size_t count_values(const cells& logs) {
    std::size_t count = 0;
    for (std::size_t process = 0; process < logs.processes(); ++process)
        for (std::size_t seed = 0; seed < logs.seeds(); ++seed) count += logs.at(process, seed).size();
    return count;
}

/// The probability n! m! / (n + m)! that n values all exceed m others of the same distribution, a lower bound for any
/// p-value. The bootstrap of a few values falls below it because it underestimates their variance.
double least_p_value(std::size_t n, std::size_t m) {
    double chance = 1;
    for (std::size_t i = 1; i <= n; ++i) chance *= static_cast<double>(i) / static_cast<double>(m + i);
    return chance;
}

/// Logarithms of a candidate's milliseconds per frame or, with a baseline (not null), of the ratios to its time in the
/// same repeat, in a cell per process and seed.
cells log_times(const rows_by_scene& run, const shared_scene& scene, const candidate_name& name,
                const candidate_name* baseline) {
    std::map<std::uint64_t, std::size_t> processes;  // with their indices in the cells
    for (const scene_key& seed : scene.seeds)
        for (const row* r : run.of(seed, name)) processes.emplace(r->process, 0);
    std::size_t count = 0;
    for (auto& [process, index] : processes) index = count++;
    cells logs(count, scene.seeds.size());
    for (std::size_t seed = 0; seed < scene.seeds.size(); ++seed)
        for (const row* r : run.of(scene.seeds[seed], name)) {
            const std::optional<double> ms = log_ms(*r);
            const std::optional<double> base_ms = baseline ? log_ms_in(run.of(scene.seeds[seed], *baseline), *r) : 0;
            if (ms && base_ms) logs.add(processes.at(r->process), seed, *ms - *base_ms);
        }
    return logs;
}

/// The baseline of ratios: the first composition that is timed in both runs, or else the first engine.
std::optional<candidate_name> baseline_of(const shared_scene& scene, const rows_by_scene& a, const rows_by_scene& b) {
    for (const bool engine : {false, true})
        for (const candidate_name& name : scene.names)
            if (name.engine.empty() != engine && !log_times(a, scene, name, nullptr).empty() &&
                !log_times(b, scene, name, nullptr).empty())
                return name;
    return std::nullopt;
}

/// The logarithms of one composition or engine in a scene, in A and in B.
struct measured_candidate {
    std::size_t scene;  ///< index in the report
    std::string label;
    cells a;
    cells b;
};

/// Decides for each candidate whether its time changed beyond noise, and adds it to its scene. Many tests show some
/// change by chance, so that their p-values are corrected together (Holm's rule).
/// @param measured logarithms of ratios or times
/// @param times_of_scene the list of a scene to which they are added: `ratios` or `times`
void add_decided(std::span<const measured_candidate> measured,
                 std::vector<compared_time> compared_scene::* times_of_scene, std::vector<compared_scene>& scenes) {
    std::vector<compared_time> times;
    std::vector<evidence> evidences;
    for (const measured_candidate& entry : measured) {
        const estimate a = bootstrap(entry.a), b = bootstrap(entry.b);
        const estimate change = difference_of(b, a);
        // However clear the difference, so few values cannot give a smaller p-value.
        const double least_p = least_p_value(count_values(entry.a), count_values(entry.b));
        evidence& entry_evidence = evidences.emplace_back(evidence_of(change));  // less, same or more, with a p-value
        entry_evidence.p = std::max(entry_evidence.p, least_p);
        // Even the least p-value may be insignificant after the correction; then repeats are too few for any decision.
        const outcome best = decide({outcome::more, least_p * static_cast<double>(measured.size())});
        times.push_back({.label = entry.label,
                         .in_a = std::exp(a.value),
                         .in_b = std::exp(b.value),
                         .change = std::exp(change.value),
                         .change_range = {std::exp(change.range().low), std::exp(change.range().high)},
                         .lacks_repeats = best == outcome::undecided});
    }
    const std::vector<outcome> outcomes = decide_together(evidences);
    for (std::size_t i = 0; i < times.size(); ++i) {
        // Only changes are corrected; otherwise hundreds of unchanged candidates would all end up undecided.
        times[i].verdict =
            outcomes[i] == outcome::undecided && decide(evidences[i]) == outcome::same ? outcome::same : outcomes[i];
        (scenes[measured[i].scene].*times_of_scene).push_back(std::move(times[i]));
    }
}

using number = std::pair<std::string, std::optional<std::uint64_t>>;

/// The values of a row that do not vary between repeats: a change of one is a change of the program.
std::vector<number> numbers_of(const row& r) {
    std::vector<number> numbers = {{"candidates", r.candidates}, {"contacts", r.contacts}};
    for (std::size_t i = 0; i < r.counts.size(); ++i) numbers.emplace_back(aabb::work_names[i], r.counts[i]);
    for (std::size_t i = 0; i < r.bytes.size(); ++i)
        numbers.emplace_back("bytes_" + std::string(byte_columns[i]), r.bytes[i]);
    numbers.emplace_back("missing", r.false_negatives);
    numbers.emplace_back("invented", r.false_positives);
    return numbers;
}

std::set<std::string> exact_digests(const rows_by_scene::repeats_by_name& of_scene) {
    std::set<std::string> digests;
    for (const auto& [name, repeats] : of_scene)
        for (const row* r : repeats)
            if (r->status == "exact") digests.insert(r->digest);
    return digests;
}

std::string text_of(const std::set<std::string>& digests) {
    return digests.empty() ? "-" : fmt::format("{}", fmt::join(digests, " "));
}

/// Records each scene whose exact rows in A and B do not all have the same digest, that is, find the same pairs.
void compare_results(const rows_by_scene& a, const rows_by_scene& b, comparison& report) {
    for (const auto& [scene, in_a] : a.scenes()) {
        const auto in_b = b.scenes().find(scene);
        if (in_b == b.scenes().end()) continue;
        ++report.results_compared;
        const std::set<std::string> digests_a = exact_digests(in_a);
        std::set<std::string> digests_b = exact_digests(in_b->second);
        const row& first = *in_a.begin()->second.front();
        different_result difference{first.experiment, first.scene, text_of(digests_a), text_of(digests_b)};
        digests_b.insert(digests_a.begin(), digests_a.end());
        if (digests_b.size() > 1) report.different_results.push_back(std::move(difference));
    }
}

/// Compares counts of work and bytes, which no noise disturbs, of all candidates of a scene in the runs A and B.
/// @param changed receives those that differ for any seed, as sums over the seeds
/// @returns the number of values compared
std::size_t compare_numbers(const shared_scene& scene, const rows_by_scene& a, const rows_by_scene& b,
                            std::span<const std::string> labels, std::vector<changed_number>& changed) {
    std::size_t compared = 0;
    for (std::size_t i = 0; i < scene.names.size(); ++i) {
        std::vector<std::pair<std::vector<number>, std::vector<number>>> by_seed;  // of A and B
        for (const scene_key& seed : scene.seeds) {
            const rows_by_scene::repeats& of_a = a.of(seed, scene.names[i]);
            const rows_by_scene::repeats& of_b = b.of(seed, scene.names[i]);
            // All repeats of a seed have the same counts and bytes.
            if (!of_a.empty() && !of_b.empty())
                by_seed.emplace_back(numbers_of(*of_a.front()), numbers_of(*of_b.front()));
        }
        for (std::size_t k = 0; !by_seed.empty() && k < by_seed[0].first.size(); ++k) {
            changed_number sums{labels[i], by_seed[0].first[k].first};  // over the seeds that both have
            bool is_compared = false, differs = false;
            for (const auto& [of_a, of_b] : by_seed) {
                const std::optional<std::uint64_t>& before = of_a[k].second;
                const std::optional<std::uint64_t>& after = of_b[k].second;
                if (!before || !after) continue;
                sums.in_a += *before;
                sums.in_b += *after;
                is_compared = true;
                differs = differs || *before != *after;
            }
            compared += is_compared;
            if (differs) changed.push_back(std::move(sums));
        }
    }
    return compared;
}

/// The number of compositions and engines in the scenes of a run that the other run lacks.
std::size_t count_only_in(const rows_by_scene& run, const rows_by_scene& other) {
    std::size_t count = 0;
    for (const auto& [scene, by_name] : run.scenes())
        for (const auto& [name, repeats] : by_name) count += other.of(scene, name).empty();
    return count;
}

}  // namespace

/// Compares two runs of the same experiments, of two commits or machines: the pairs that they find (by digest), times
/// per frame relative to a baseline, counts and bytes.
/// @param quantities whether milliseconds are compared, too; ratios always are
comparison compare(const run_results& a, const run_results& b, compared quantities) {
    const rows_by_scene of_a(a.rows);
    const rows_by_scene of_b(b.rows);
    comparison report;
    compare_results(of_a, of_b, report);
    if (report.results_compared == 0)
        throw aabb::input_error(a.folder.string() + " and " + b.folder.string() +
                                " have no scene in common: scenes must agree in experiment, kind, parameters and seed");
    report.only_in_a = count_only_in(of_a, of_b);
    report.only_in_b = count_only_in(of_b, of_a);
    std::vector<measured_candidate> ratios, times;
    for (const shared_scene& shared : scenes_shared(a.rows, of_b)) {
        const std::size_t index = report.scenes.size();
        const std::vector<std::string> labels = labels_of(shared.names);
        compared_scene& scene = report.scenes.emplace_back();
        scene.experiment = shared.first_row->experiment;
        scene.scene = without_seed(shared.first_row->scene);
        report.numbers_compared += compare_numbers(shared, of_a, of_b, labels, scene.changed);
        const std::optional<candidate_name> baseline = baseline_of(shared, of_a, of_b);
        if (!baseline) continue;
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const candidate_name& name = shared.names[i];
            const auto add = [&](std::vector<measured_candidate>& measured, const candidate_name* denominator) {
                measured_candidate entry{index, labels[i], log_times(of_a, shared, name, denominator),
                                         log_times(of_b, shared, name, denominator)};
                if (!entry.a.empty() && !entry.b.empty()) measured.push_back(std::move(entry));
            };
            if (quantities == compared::ratios_and_times) add(times, nullptr);
            if (name == *baseline)
                scene.baseline = labels[i];
            else
                add(ratios, &*baseline);
        }
    }
    add_decided(ratios, &compared_scene::ratios, report.scenes);
    add_decided(times, &compared_scene::times, report.scenes);
    return report;
}

}  // namespace aabblab
