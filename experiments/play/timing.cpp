module;
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

module aabblab.play;

import :player;
import aabb.pipeline;
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

}  // namespace

timing time_scene(const scene_choice& choice, const contender& who) {
    scene_play scene(choice);
    return time_scene(scene, who);
}

timing time_scene(scene_play& scene, const contender& who) {
    timing times;
    std::optional<player> p;
    times.build = elapsed_in([&] { p.emplace(who, scene, aabb::instrumentation::none); });
    tally found(scene.meshes() != nullptr);
    const bool timed = !who.told;
    play(scene, *p, [&](const played_frame& frame) {
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
    });
    if (!timed) add_told(*who.told, times);
    times.digest = found.digest();
    return times;
}

}  // namespace aabblab
