module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

module aabblab.play;

import :player;
import aabb.geometry;
import aabb.pipeline;
import aabblab.configs;
import aabblab.scenes;
import aabblab.stopwatch;

namespace aabblab {

namespace {

void add_told(std::span<const told_times> told, timing& times) {
    times.build = {};
    for (std::size_t frame = 0; frame < told.size(); ++frame) {
        const auto [update, search] = told[frame];
        if (frame == 0) {
            times.first.wall_ms = update + search;
        } else {
            times.update.wall_ms += update;
            times.search.wall_ms += search;
        }
    }
}

/// Fills the processor's caches with other things.
void fill_caches() {
    constexpr std::size_t larger_than_caches = std::size_t{128} << 20U;
    constexpr std::size_t line = 64;
    static std::vector<unsigned char> other_things(larger_than_caches);
    for (std::size_t i = 0; i < other_things.size(); i += line) ++other_things[i];
}

/// Asks once where caches are cold. Otherwise several times in a row, of which it tells the mean: a query that takes a
/// microsecond would be slowed down by all that was done since the one before.
template <class Query>
elapsed mean_time(const Query& query, bool cold) {
    const int times = cold ? 1 : 16;
    if (!cold) query();
    const elapsed all = elapsed_in([&] {
        for (int i = 0; i < times; ++i) query();
    });
    return {all.wall_ms / times, all.cpu_ms / times};
}

/// Times the query, detects all contacts, and holds the answer against them.
elapsed ask(player& who, const asking& how, std::string& wrong) {
    if (how.cold) fill_caches();
    if (how.ask == question::pairs) return detect_in(who);
    std::optional<aabb::contact> first;
    std::uint64_t count = 0;
    const elapsed took = how.ask == question::first ? mean_time([&] { first = who.first_contact(); }, how.cold)
                                                    : mean_time([&] { count = who.count_contacts(); }, how.cold);
    who.detect();
    const std::vector<aabb::contact>& all = who.sorted_contacts();
    if (how.ask == question::count && count != all.size())
        wrong = "it counts " + std::to_string(count) + " contacts of " + std::to_string(all.size());
    if (how.ask == question::first && (first ? !std::ranges::binary_search(all, *first) : !all.empty()))
        wrong =
            first ? "its first contact is none" : "it finds no contact, and there are " + std::to_string(all.size());
    return took;
}

}  // namespace

timing time_scene(const scene_choice& choice, const contender& who, const asking& how) {
    scene_play scene(choice);
    return time_scene(scene, who, how);
}

timing time_scene(scene_play& scene, const contender& who, const asking& how) {
    timing times;
    std::optional<player> p;
    times.build = elapsed_in([&] { p.emplace(who, scene, aabb::instrumentation::none); });
    tally found(scene.meshes() != nullptr);
    const bool timed = !who.told;
    const auto take = [&](const played_frame& frame) {
        found.add(frame.pairs, frame.contacts);
        if (!timed) return;
        if (frame.number == 0) {
            times.first += frame.update;
            times.first += frame.search;
            times.first += frame.detect;
        } else {
            times.update += frame.update;
            times.search += frame.search;
            times.detect += frame.detect;
        }
    };
    play(scene, *p, take, std::numeric_limits<std::size_t>::max(),
         [&](player& asked) { return ask(asked, how, times.wrong); });
    if (!timed) add_told(*who.told, times);
    times.digest = found.digest();
    return times;
}

}  // namespace aabblab
