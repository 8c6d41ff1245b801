module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

module aabblab.runner;

import :playing;
import aabb;
import aabblab.config;
import aabblab.progress;
import aabblab.results;
import aabblab.scenes;

namespace aabblab {

namespace {

/// A contender with the row that all its repeats have in common.
struct timed_contender {
    const contender* who;
    row result;
    bool strayed = false;
};

row row_of(const experiment& e, const scene_choice& scene, const scene_verdicts& all, const verdict& v) {
    row r;
    r.experiment = e.name;
    r.scene = scene.kind;
    r.scene_parameters = parameters_text(scene);
    r.objects = all.objects;
    r.frames = all.frames;
    r.name = v.name;
    r.candidates = v.candidates;
    r.contacts = v.contacts;
    r.digest = v.digest;
    r.triangles = v.triangles;
    // Engines count nothing.
    const bool counted = std::ranges::any_of(v.counts, [](std::uint64_t n) { return n > 0; });
    if (e.measured.counts && counted) std::ranges::copy(v.counts, r.counts.begin());
    if (e.measured.bytes) std::ranges::copy(v.bytes, r.bytes.begin());
    if (e.measured.error) {
        r.missing = v.missing;
        r.invented = v.invented;
        r.box_inflation = v.box_inflation;
    }
    r.status = v.differences.empty() ? "exact" : "inexact";
    return r;
}

std::vector<contender> unfinished(const experiment& e, const scene_choice& scene, std::span<const contender> contenders,
                                  std::size_t repeats, std::span<const row> rows) {
    std::vector<contender> left;
    for (const contender& who : contenders) {
        const auto finished = std::ranges::count_if(rows, [&](const row& r) {
            return r.experiment == e.name && r.scene == scene.kind && r.scene_parameters == parameters_text(scene) &&
                   r.name == who.name;
        });
        if (static_cast<std::size_t>(finished) < repeats) left.push_back(who);
    }
    return left;
}

/// Times one repeat. The answer is compared again: what is timed is compiled apart from what counted its work.
/// @returns what is wrong; empty when nothing is
std::string time_into(const scene_choice& scene, timed_contender& timed) {
    row& r = timed.result;
    const timing times = time_scene(scene, *timed.who);
    r.build_ms = times.build_ms;
    r.first_ms = times.first_ms;
    r.update_ms = times.update_ms;
    r.search_ms = times.search_ms;
    r.detect_ms = times.detect_ms;
    if (times.digest == r.digest) return {};
    timed.strayed = true;
    return text_of(r.name) + " is wrong on " + scene.kind + " (" + r.scene_parameters + "): timed, its digest is " +
           times.digest + ", validated it was " + r.digest;
}

}  // namespace

std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                   std::span<const contender> contenders, results_folder& results) {
    const std::size_t repeats = e.measured.time ? e.repeats : 1;
    const std::vector<contender> left = unfinished(e, scene, contenders, repeats, results.rows());
    if (left.empty()) return {};
    const scene_verdicts validated = validate_scene(scene, left);
    results.set_digest(scene, validated.digest);
    std::vector<std::string> failures;
    std::vector<contender_name> names;
    std::vector<difference> differences;
    std::vector<timed_contender> timed;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const verdict& v = validated.verdicts[i];
        names.push_back(v.name);
        differences.insert(differences.end(), v.differences.begin(), v.differences.end());
        if (v.failure.empty())
            timed.push_back({&left[i], row_of(e, scene, validated, v)});
        else
            failures.push_back(v.failure);
    }
    if (e.measured.error) results.set_differences(scene, names, differences);
    progress shown("timing " + scene.kind, repeats * timed.size());
    for (std::size_t repeat = 0, done = 0; repeat < repeats; ++repeat)
        for (std::size_t i = 0; i < timed.size(); ++i, shown.at(++done)) {
            // Each repeat begins with another contender, so that none is always the first.
            timed_contender& turn = timed[(i + repeat) % timed.size()];
            turn.result.repeat = repeat;
            if (turn.strayed || results.has(turn.result)) continue;
            const std::string failure = e.measured.time ? time_into(scene, turn) : std::string();
            if (failure.empty()) {
                results.add(turn.result);
                continue;
            }
            failures.push_back(failure);
            results.drop(scene, turn.result.name);
        }
    return failures;
}

}  // namespace aabblab
