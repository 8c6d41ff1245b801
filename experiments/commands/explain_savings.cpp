#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "output.hpp"
#include "told_times.hpp"

// Imports, so it comes last.
#include "explain_savings.hpp"

import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabblab.numbers;
import aabblab.play;
import aabblab.race;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

constexpr std::size_t most_frames = 40;
constexpr std::size_t rounds = 5;
/// With more objects, what sorts or sweeps all of them slowly would take minutes.
constexpr std::size_t most_objects_of_any = 20'000;

/// A composition that differs from the selected one in one kind.
struct alternative {
    aabb::strategy_kind kind;
    aabb::composition composition;
};

/// Those that make sense in the scene and are exact.
std::vector<alternative> others(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<alternative> all;
    for (const aabb::strategy_info& info : aabb::strategies(kind)) {
        if (info.name == selected[kind].name) continue;
        aabb::composition c = selected;
        c[kind] = {info.name, {}};
        if (refusal_of(c, info_of(kind).stage).empty() && is_exact(c, info_of(kind).stage) &&
            (meshes || needs_meshes(c).empty()))
            all.push_back({kind, c});
    }
    return all;
}

/// The same with counters in its stages.
contender with_counters(contender who) {
    who.make_global = [make = who.make_global](aabb::instrumentation) { return make(aabb::instrumentation::counters); };
    if (who.make_local)
        who.make_local = [make = who.make_local](aabb::instrumentation) {
            return make(aabb::instrumentation::counters);
        };
    return who;
}

template <class Value>
std::vector<double> values_of(std::span<const race_time> times, Value value) {
    std::vector<double> all;
    for (const race_time& t : times) all.push_back(value(t));
    return all;
}

/// Ratio and range.
std::vector<std::string> ratio_cells(std::span<const race_time> times, std::span<const race_time> selected) {
    if (times.size() < selected.size()) return {fmt::format("> {:.0f}", hopeless_ratio), "-"};
    const auto ms = [](const race_time& t) { return t.frame_ms(); };
    const paired_ratio ratio = paired_ratio_of(values_of(times, ms), values_of(selected, ms));
    return {fmt::format("{:.2f}{}", ratio.median, ratio.may_be_same() ? "?" : ""),
            fmt::format("{:.2f}-{:.2f}", ratio.least, ratio.greatest)};
}

void add_row(table& t, const std::string& kind, const std::string& name, std::span<const race_time> times,
             std::span<const race_time> selected) {
    const auto median = [&](auto value) { return quartiles_of(values_of(times, value)).median; };
    const bool is_selected = times.data() == selected.data();
    const std::vector<std::string> ratio =
        is_selected ? std::vector<std::string>{"1", "-"} : ratio_cells(times, selected);
    t.rows.push_back({kind, name, fmt::format("{:.4g}", median([](const race_time& one) { return one.frame_ms(); })),
                      ratio[0], ratio[1],
                      fmt::format("{:.3g}", median([](const race_time& one) { return one.build_ms; })),
                      grouped(times.back().bytes)});
}

}  // namespace

bool print_savings(const scene_choice& choice, const aabb::composition& selected) {
    const scene_play scene(choice);
    const bool meshes = scene.meshes() != nullptr;
    const bool any = scene.objects() <= most_objects_of_any;
    std::vector<alternative> all;
    std::string alone;  // kinds of which nothing else goes with the rest
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (!meshes && info_of(kind).stage == aabb::stage::local_detection) continue;
        if (!any && !info_of(kind).apart) continue;
        const std::vector<alternative> some = others(selected, kind, meshes);
        all.insert(all.end(), some.begin(), some.end());
        if (some.empty()) alone += (alone.empty() ? "" : ", ") + std::string(name_of(kind));
    }
    std::vector<contender> playing{contender_of(selected, meshes)};
    for (const alternative& one : all) playing.push_back(contender_of(one.composition, meshes));
    playing.push_back(with_counters(playing.front()));
    const auto times = play_in_turn(choice, playing, most_frames, rounds);
    table t{{{"kind", false},
             {"in its place", false},
             {"ms/frame"},
             {"ratio"},
             {"range"},
             {"build ms", true, 1},
             {"bytes", true, 2}},
            {}};
    add_row(t, "", "as selected", times[0], times[0]);
    for (std::size_t i = 0; i < all.size(); ++i)
        add_row(t, std::string(name_of(all[i].kind)), all[i].composition[all[i].kind].name, times[i + 1], times[0]);
    add_row(t, "counters", "of all work", times.back(), times[0]);
    const auto print_line = [](const std::string& line) { print(wrapped(line) + "\n"); };
    print_line(fmt::format("what each choice saves: one kind at a time in another way, all in turn, {} rounds of {}",
                           rounds, counted(std::min(scene.frames(), most_frames), "frame")));
    print(to_text(t, output_width()) + "\n");
    if (!alone.empty()) print_line(alone + ": nothing else can be composed with the rest.");
    if (!any)
        print_line(fmt::format("With more than {} only kinds that stand apart are tried in other ways.",
                               counted(most_objects_of_any, "object")));
    print_line(ms_a_frame_text);
    print_line(fmt::format(
        "ratio: ms/frame over that of what is selected in the same round, the median; range: the least and the "
        "greatest; ?: the range comes within 3 % of 1, so that the rounds leave it open; > {:.0f}: seen after one "
        "round.",
        hopeless_ratio));
    print_line(build_ms_text);
    print_line("bytes: held after the last of these frames; counters: the same with all work counted.");
    // What is inexact, or moves a scene that reacts, finds others by design.
    bool same = true;
    const bool comparable = playing.front().exact && playing.front().exact_boxes;
    for (std::size_t i = 1; comparable && i < times.size(); ++i) {
        if (times[i].front().digest == times[0].front().digest) continue;
        same = false;
        print_line(fmt::format("{} finds other pairs than what is selected: one of the two is wrong.",
                               i <= all.size() ? all[i - 1].composition[all[i - 1].kind].name : "what is counted"));
    }
    flush_output();
    return same;
}

}  // namespace aabblab
