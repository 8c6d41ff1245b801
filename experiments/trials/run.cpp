module;
#include <random>

module aabblab.trials;

import aabblab.metrics;
import aabblab.progress;

namespace aabblab {

namespace {

/// A contender with the row that all its repeats have in common.
struct timed_contender {
    const contender* who;
    row result;
};

/// With what the experiment records.
row row_of(const experiment& e, const validated_row& v) {
    row r = v;
    r.experiment = e.name;
    if (!e.records(metric_group::counts)) r.counts = {};
    if (!e.records(metric_group::bytes)) r.bytes = {};
    if (!e.records(metric_group::error)) {
        r.missing = r.invented = std::nullopt;
        r.box_inflation = std::nullopt;
    }
    return r;
}

/// The repeats of one process.
round_limits repeats_of(const experiment& e, std::size_t process) {
    const std::size_t repeats = e.records(metric_group::time) ? e.repeats : 1;
    return {.end = repeats * (process + 1) / e.processes, .begin = repeats * process / e.processes};
}

/// The rows of a scene that there are.
std::vector<row> rows_of(const scene_choice& scene, std::span<const row> rows) {
    std::vector<row> found;
    for (const row& r : rows)
        if (r.scene == scene) found.push_back(r);
    return found;
}

/// Who is not repeated, of the rows of a scene: those who took too long in the first repeat of the share.
std::set<contender_name> given_up(const experiment& e, const round_limits& share, std::span<const row> rows) {
    std::set<contender_name> names;
    if (!e.patience) return names;
    const row_value& whole = measured("whole_ms");
    double least = std::numeric_limits<double>::infinity();
    for (const row& r : rows)
        if (r.repeat == share.begin) least = std::min(least, whole(r).value_or(least));
    const double longest = stopping_rule{.ratio = static_cast<double>(*e.patience)}.hopeless_after(least);
    for (const row& r : rows)
        if (r.repeat == share.begin && whole(r).value_or(0) > longest) names.insert(r.name);
    return names;
}

/// Ratios are formed within a repeat, so one that was interrupted is played again, whole. It can only be the last.
void drop_interrupted_repeat(const experiment& e, const scene_choice& scene, const round_limits& share,
                             std::size_t contenders, results_folder& results) {
    if (results.rows().empty()) return;
    const row last = results.rows().back();
    if (last.scene != scene || last.repeat < share.begin || last.repeat >= share.end) return;
    const std::vector<row> rows = rows_of(scene, results.rows());
    if (last.repeat > share.begin) contenders -= given_up(e, share, rows).size();
    const auto played = std::ranges::count(rows, last.repeat, &row::repeat);
    if (static_cast<std::size_t>(played) < contenders) results.drop(scene, last.repeat);
}

std::vector<contender> unfinished(const experiment& e, std::span<const contender> contenders, const round_limits& share,
                                  std::span<const row> rows) {
    const std::set<contender_name> out = given_up(e, share, rows);
    std::vector<contender> left;
    for (const contender& who : contenders) {
        if (out.contains(who.name)) continue;
        const auto finished = std::ranges::count_if(
            rows, [&](const row& r) { return r.name == who.name && r.repeat >= share.begin && r.repeat < share.end; });
        if (static_cast<std::size_t>(finished) < share.end - share.begin) left.push_back(who);
    }
    return left;
}

/// Whether what is timed may find other contacts than what was validated: validated, a scene that reacts is told the
/// exact ones; timed, it is moved by what an inexact contender finds.
bool goes_its_own_way(const scene_choice& scene, const contender& who) {
    return !(who.exact && who.exact_boxes) && has_meshes(scene) && make_mesh_scene(scene)->reacts();
}

/// Times one repeat. The answer is compared again: what is timed is compiled apart from what counted its work.
/// @returns what is wrong; empty when nothing is
std::string time_into(const scene_choice& scene, const asking& how, timed_contender& timed) {
    row& r = timed.result;
    const observation times = observe(scene, *timed.who, {.asked = how});
    const bool told = timed.who->told != nullptr;
    const auto take = [told](double wall, double cpu, std::optional<double>& wall_ms, std::optional<double>& cpu_ms) {
        wall_ms = wall;
        if (!told) cpu_ms = cpu;
    };
    take(times.build.wall_ms, times.build.cpu_ms, r.build_ms, r.build_cpu_ms);
    take(times.first.wall_ms(), times.first.cpu_ms(), r.first_ms, r.first_cpu_ms);
    take(times.rest.update.wall_ms, times.rest.update.cpu_ms, r.update_ms, r.update_cpu_ms);
    take(times.rest.search.wall_ms, times.rest.search.cpu_ms, r.search_ms, r.search_cpu_ms);
    take(times.rest.detect.wall_ms, times.rest.detect.cpu_ms, r.detect_ms, r.detect_cpu_ms);
    std::string wrong = times.wrong;
    if (wrong.empty() && times.digest != r.digest && !goes_its_own_way(scene, *timed.who))
        wrong = "timed, its digest is " + times.digest + ", validated it was " + r.digest;
    if (wrong.empty()) return {};
    return text_of(r.name) + " is wrong on " + scene.kind + " (" + parameters_text(scene) + "): " + wrong;
}

/// Who is ready to be timed, and what is wrong with the others.
struct admission {
    std::vector<timed_contender> timed;
    std::vector<std::string> failures;
};

/// Plays the scene beside the exact answer.
admission validated(const experiment& e, const scene_choice& scene, std::span<const contender> contenders,
                    results_folder& results) {
    admission all;
    const scene_validation found = validate_scene(scene, contenders);
    results.set_digest(scene, found.digest);
    std::vector<contender_name> names;
    std::vector<difference> differences;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const validated_row& v = found.contenders[i];
        names.push_back(v.name);
        differences.insert(differences.end(), v.differences.begin(), v.differences.end());
        if (v.failure.empty())
            all.timed.push_back({&contenders[i], row_of(e, v)});
        else
            all.failures.push_back(v.failure);
    }
    if (e.records(metric_group::error)) results.set_differences(scene, names, differences);
    return all;
}

/// Those whom the first process validated, with what it found.
admission known(std::span<const contender> contenders, std::span<const row> rows) {
    admission all;
    for (const contender& who : contenders) {
        const auto before = std::ranges::find(rows, who.name, &row::name);
        if (before != rows.end()) all.timed.push_back({&who, *before});
    }
    return all;
}

/// Contenders in the order in which they are played: all but the first, to which others are held, shuffled in each
/// scene, the same each time. Who is played after its like, named beside it in a config, finds code at hand, and few
/// repeats are too few for everyone to be played after everyone.
std::vector<contender> shuffled(std::span<const contender> contenders, const scene_choice& scene) {
    std::vector<contender> all(contenders.begin(), contenders.end());
    const std::string text = scene.kind + parameters_text(scene);
    std::seed_seq seed(text.begin(), text.end());
    if (!all.empty()) std::ranges::shuffle(std::span(all).subspan(1), std::mt19937_64(seed));
    return all;
}

}  // namespace

experiment_record record_of(const experiment& e) {
    return {e.name, e.file, e.text, hash_of(e), e.quick, e.scenes, e.notes};
}

std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                   std::span<const contender> contenders, results_folder& results,
                                   std::size_t process) {
    const round_limits share = repeats_of(e, process);
    drop_interrupted_repeat(e, scene, share, contenders.size(), results);
    const std::vector<row> rows = rows_of(scene, results.rows());
    const std::vector<contender> left = unfinished(e, shuffled(contenders, scene), share, rows);
    if (left.empty()) return {};
    auto [timed, failures] = process == 0 ? validated(e, scene, left, results) : known(left, rows);
    progress shown("timing " + scene.kind, (share.end - share.begin) * timed.size());
    const std::size_t in_round = timed.size();
    std::size_t done = 0;
    std::set<contender_name> out;  // who is not repeated
    const auto play = [&](timed_contender& turn, std::size_t repeat) {
        shown.at(done++);
        turn.result.repeat = repeat;
        turn.result.process = process;
        if (results.has(turn.result)) return;
        std::string failure;
        try {
            if (e.records(metric_group::time)) failure = time_into(scene, e.how, turn);
        } catch (const engine_timeout& error) {
            // What it did before stays.
            failures.emplace_back(error.what());
            out.insert(turn.result.name);
            return;
        }
        if (failure.empty()) return results.add(turn.result);
        out.insert(turn.result.name);
        failures.push_back(failure);
        results.drop(scene, turn.result.name);
    };
    const auto give_up = [&](std::size_t repeat) {
        out.merge(given_up(e, share, rows_of(scene, results.rows())));
        std::erase_if(timed, [&](const timed_contender& t) { return out.contains(t.result.name); });
        done = (repeat + 1 - share.begin) * in_round;
    };
    run_rounds(timed, share, play, give_up);
    return failures;
}

}  // namespace aabblab
