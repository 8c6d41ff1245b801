module;
#include <cstddef>
#include <optional>
#include <string>

module aabblab.play;

import :player;
import aabb.pipeline;
import aabblab.scenes;
import aabblab.stopwatch;

namespace aabblab {

timing time_scene(const scene_choice& choice, const contender& who) {
    scene_play scene(choice);
    return time_scene(scene, who);
}

timing time_scene(scene_play& scene, const contender& who) {
    timing times;
    std::optional<player> p;
    times.build = elapsed_in([&] { p.emplace(who, scene, aabb::instrumentation::none); });
    tally found(scene.meshes() != nullptr);
    play(scene, *p, [&](const played_frame& frame) {
        if (frame.number == 0) {
            times.first += frame.update;
            times.first += frame.search;
            times.first += frame.detect;
        } else {
            times.update += frame.update;
            times.search += frame.search;
            times.detect += frame.detect;
        }
        found.add(frame.pairs, frame.contacts);
    });
    times.digest = found.digest();
    return times;
}

}  // namespace aabblab
