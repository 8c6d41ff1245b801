module;
#include <chrono>
#include <optional>
#include <string>

module aabblab.play;

import :player;
import aabb;
import aabblab.scenes;

namespace aabblab {

namespace {

using clock = std::chrono::steady_clock;

template <class Work>
double milliseconds_of(Work work) {
    const clock::time_point start = clock::now();
    work();
    return std::chrono::duration<double, std::milli>(clock::now() - start).count();
}

}  // namespace

timing time_scene(const scene_choice& choice, const contender& who) {
    scene_play scene(choice);
    timing times;
    std::optional<player> p;
    times.build_ms = milliseconds_of([&] { p.emplace(who, scene, aabb::instrumentation::none); });
    tally found(scene.meshes() != nullptr);
    for (bool first = true; scene.next(); first = false) {
        const double update = milliseconds_of([&] { p->update(); });
        const double search = milliseconds_of([&] { p->search(); });
        const double detect = milliseconds_of([&] { p->detect(); });
        if (first) {
            times.first_ms = update + search + detect;
        } else {
            times.update_ms += update;
            times.search_ms += search;
            times.detect_ms += detect;
        }
        found.add(p->sorted_pairs(), p->sorted_contacts());
    }
    times.digest = found.digest();
    return times;
}

}  // namespace aabblab
