module;
#include <random>

module aabblab.trials;

import aabblab.metrics;
import aabblab.progress;

namespace aabblab {

namespace {

/// A candidate with the row that all its repeats share.
struct timed_candidate {
    const candidate* tested;
    row result;
};

/// Reduces a validated row to the metrics that the experiment records; the columns of the others stay empty.
row recorded_row(const experiment& e, const validated_row& v) {
    row r = v;
    r.experiment = e.name;
    if (!e.records(metric_group::counts)) r.counts = {};
    if (!e.records(metric_group::bytes)) r.bytes = {};
    if (!e.records(metric_group::error)) {
        r.false_negatives = r.false_positives = std::nullopt;
        r.box_inflation = std::nullopt;
    }
    return r;
}

/// The repeats that one process runs: p of P processes runs those from R p / P to R (p + 1) / P.
round_limits share_of_process(const experiment& e, std::size_t process) {
    const std::size_t repeats = e.records(metric_group::time) ? e.repeats : 1;
    return {.end = repeats * (process + 1) / e.processes, .begin = repeats * process / e.processes};
}

std::vector<row> rows_of(const scene_choice& scene, std::span<const row> rows) {
    std::vector<row> matching;
    std::ranges::copy_if(rows, std::back_inserter(matching), [&](const row& r) { return r.scene == scene; });
    return matching;
}

/// Early stopping: the candidates that took `e.patience` times as long as the fastest in the first repeat of this
/// process, and are not repeated.
/// @param share the repeats of this process
/// @param rows of one scene
std::set<candidate_name> stopped_early(const experiment& e, const round_limits& share, std::span<const row> rows) {
    std::set<candidate_name> names;
    if (!e.patience) return names;
    const row_value& whole_ms = measured("whole_ms");
    double fastest = std::numeric_limits<double>::infinity();
    for (const row& r : rows)
        if (r.repeat == share.begin) fastest = std::min(fastest, whole_ms(r).value_or(fastest));
    const double limit = static_cast<double>(*e.patience) * fastest;
    for (const row& r : rows)
        if (r.repeat == share.begin && whole_ms(r).value_or(0) > limit) names.insert(r.name);
    return names;
}

/// Drops the rows of an interrupted repeat, the last, with fewer rows than candidates that are not stopped early, so
/// that all run it again: ratios are formed within a repeat.
/// @param share the repeats of this process
void drop_interrupted_repeat(const experiment& e, const scene_choice& scene, const round_limits& share,
                             std::size_t candidate_count, results_folder& results) {
    if (results.rows().empty()) return;
    const row last = results.rows().back();
    if (last.scene != scene || last.repeat < share.begin || last.repeat >= share.end) return;
    const std::vector<row> rows = rows_of(scene, results.rows());
    if (last.repeat > share.begin) candidate_count -= stopped_early(e, share, rows).size();
    if (static_cast<std::size_t>(std::ranges::count(rows, last.repeat, &row::repeat)) < candidate_count)
        results.drop([&](const row& r) { return r.scene == scene && r.repeat == last.repeat; });
}

/// The candidates that still lack rows of repeats, so that a resumed experiment runs only what is missing.
/// @param share the repeats of this process
/// @param rows of one scene
std::vector<candidate> unfinished(const experiment& e, std::span<const candidate> candidates, const round_limits& share,
                                  std::span<const row> rows) {
    const std::set<candidate_name> stopped = stopped_early(e, share, rows);
    std::vector<candidate> remaining;
    for (const candidate& c : candidates) {
        if (stopped.contains(c.name)) continue;
        const auto finished = std::ranges::count_if(
            rows, [&](const row& r) { return r.name == c.name && r.repeat >= share.begin && r.repeat < share.end; });
        if (static_cast<std::size_t>(finished) < share.end - share.begin) remaining.push_back(c);
    }
    return remaining;
}

/// Whether a timed run may legitimately find other contacts than the validated one: during validation a reactive scene
/// follows the ground truth; during a timed run it follows the results of an inexact candidate.
bool may_diverge(const scene_choice& scene, const candidate& c) {
    return !(c.exact && c.exact_boxes) && has_meshes(scene) && make_mesh_scene(scene)->reacts();
}

/// Runs a candidate on a scene once and stores the times in its row. The digest (a hash of the pairs) was validated
/// with work counters; it is compared again, since timed code without counters is a separate template instantiation.
/// @returns a description of what is wrong; empty if the results agree
std::string time_repeat(const scene_choice& scene, const query_settings& query, timed_candidate& timed) {
    row& r = timed.result;
    const observation times = observe(scene, *timed.tested, {.query = query});
    const bool is_external = timed.tested->reported != nullptr;
    const auto store = [is_external](elapsed took, std::optional<double>& wall_ms, std::optional<double>& cpu_ms) {
        wall_ms = took.wall_ms;
        if (!is_external) cpu_ms = took.cpu_ms;  // an external program reports only wall times
    };
    store(times.build, r.build_ms, r.build_cpu_ms);
    store({times.first.wall_ms(), times.first.cpu_ms()}, r.first_ms, r.first_cpu_ms);
    store(times.rest.update, r.update_ms, r.update_cpu_ms);
    store(times.rest.search, r.search_ms, r.search_cpu_ms);
    store(times.rest.detect, r.detect_ms, r.detect_cpu_ms);
    std::string wrong = times.wrong;
    if (wrong.empty() && is_external) wrong = timed.tested->reported->fault();
    if (wrong.empty() && times.digest != r.digest && !may_diverge(scene, *timed.tested))
        wrong = "its digest is " + times.digest + " when timed, but was " + r.digest + " when validated";
    if (wrong.empty()) return {};
    return text_of(r.name) + " has a wrong result on " + scene.kind + " (" + parameters_text(scene) + "): " + wrong;
}

/// The candidates that are ready to be timed, and the failures of the others.
struct validated_candidates {
    std::vector<timed_candidate> timed;
    std::vector<std::string> failures;
};

/// Compares the candidates with the ground truth, and stores its digest and their differences.
validated_candidates validate(const experiment& e, const scene_choice& scene, std::span<const candidate> candidates,
                              results_folder& results) {
    validated_candidates validated;
    const scene_validation validation = validate_scene(scene, candidates);
    results.set_digest(scene, validation.digest);
    std::vector<candidate_name> names;
    std::vector<difference> differences;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const validated_row& v = validation.candidates[i];
        names.push_back(v.name);
        differences.insert(differences.end(), v.differences.begin(), v.differences.end());
        if (v.failure.empty())
            validated.timed.push_back({&candidates[i], recorded_row(e, v)});
        else
            validated.failures.push_back(v.failure);
    }
    if (e.records(metric_group::error)) results.set_differences(scene, names, differences);
    return validated;
}

/// Reuses the validation of the first process.
validated_candidates validated_before(std::span<const candidate> candidates, std::span<const row> rows) {
    validated_candidates validated;
    for (const candidate& c : candidates)
        if (const auto r = std::ranges::find(rows, c.name, &row::name); r != rows.end())
            validated.timed.push_back({&c, *r});
    return validated;
}

/// Shuffles all candidates but the baseline, reproducibly for each scene. In the order of the config, a candidate often
/// follows a similar one, whose code is still cached, and repeats are too few for each to follow every other.
std::vector<candidate> shuffled(std::span<const candidate> candidates, const scene_choice& scene) {
    std::vector<candidate> order(candidates.begin(), candidates.end());
    const std::string text = scene.kind + parameters_text(scene);
    std::seed_seq seed(text.begin(), text.end());
    if (!order.empty()) std::ranges::shuffle(std::span(order).subspan(1), std::mt19937_64(seed));
    return order;
}

}  // namespace

experiment_record record_of(const experiment& e) {
    return {e.name, e.file, e.text, hash_of(e), e.quick, e.scenes, e.notes};
}

/// Times all candidates on a scene in interleaved repeats and adds a row for each run. Only the first process compares
/// them with the ground truth. A resumed process repeats an interrupted repeat, and then runs what has no row yet.
/// @param process from 0; each runs an equal share of the repeats
/// @returns a sentence per failure; rows of a candidate with a wrong result are dropped
std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                   std::span<const candidate> candidates, results_folder& results,
                                   std::size_t process) {
    const round_limits share = share_of_process(e, process);
    drop_interrupted_repeat(e, scene, share, candidates.size(), results);
    const std::vector<row> rows = rows_of(scene, results.rows());
    const std::vector<candidate> remaining = unfinished(e, shuffled(candidates, scene), share, rows);
    if (remaining.empty()) return {};
    auto [timed, failures] = process == 0 ? validate(e, scene, remaining, results) : validated_before(remaining, rows);
    progress shown("timing " + scene.kind, (share.end - share.begin) * timed.size());
    const std::size_t runs_per_round = timed.size();
    std::size_t finished_runs = 0;
    std::set<candidate_name> stopped;  // not repeated: wrong, timed out or too slow
    const auto run = [&](timed_candidate& next, std::size_t repeat) {
        shown.update(finished_runs++);
        next.result.repeat = repeat;
        next.result.process = process;
        if (results.has(next.result)) return;
        std::string failure;
        try {
            if (e.records(metric_group::time)) failure = time_repeat(scene, e.query, next);
        } catch (const engine_timeout& error) {
            // The rows of earlier repeats are kept.
            failures.emplace_back(error.what());
            stopped.insert(next.result.name);
            return;
        }
        if (failure.empty()) return results.add(next.result);
        if (next.tested->reported) next.tested->reported->is_wrong = true;
        stopped.insert(next.result.name);
        failures.push_back(failure);
        results.drop([&](const row& r) { return r.scene == scene && r.name == next.result.name; });
    };
    const auto stop_early = [&](std::size_t repeat) {
        stopped.merge(stopped_early(e, share, rows_of(scene, results.rows())));
        std::erase_if(timed, [&](const timed_candidate& t) { return stopped.contains(t.result.name); });
        finished_runs = (repeat + 1 - share.begin) * runs_per_round;
    };
    run_rounds(timed, share, run, stop_early);
    return failures;
}

}  // namespace aabblab
