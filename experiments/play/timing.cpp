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
    times.build_ms = milliseconds_of([&] { p.emplace(who, scene, aabb::instrumentation::none); });
    tally found(scene.meshes() != nullptr);
    play(scene, *p, [&](const played_frame& frame) {
        if (frame.number == 0) {
            times.first_ms = frame.ms();
        } else {
            times.update_ms += frame.update_ms;
            times.search_ms += frame.search_ms;
            times.detect_ms += frame.detect_ms;
        }
        found.add(frame.pairs, frame.contacts);
    });
    times.digest = found.digest();
    return times;
}

}  // namespace aabblab
