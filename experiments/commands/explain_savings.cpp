#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "output.hpp"

// Imports, so it comes last.
#include "explain_savings.hpp"

import aabb.policy;
import aabb.registry;
import aabblab.numbers;
import aabblab.play;
import aabblab.race;
import aabblab.scenes;
import aabblab.tables;

namespace aabblab {

namespace {

constexpr std::size_t most_frames = 40;
constexpr std::size_t repeats = 3;
/// With more objects, what sorts or sweeps all of them slowly would take minutes.
constexpr std::size_t most_objects_of_any = 20'000;

struct cost {
    double build_ms = std::numeric_limits<double>::infinity();
    double frame_ms = std::numeric_limits<double>::infinity();  ///< after frame 0, a mean; of frame 0 if it is alone
    std::uint64_t bytes = 0;
};

/// The least of some repeats.
cost cost_of(const scene_choice& choice, const contender& who) {
    cost least;
    for (std::size_t i = 0; i < repeats; ++i) {
        const race_time time = time_frames(choice, who, most_frames);
        least.build_ms = std::min(least.build_ms, time.build_ms);
        least.frame_ms = std::min(least.frame_ms, time.frames > 1 ? time.steady_ms() : time.first_ms);
        least.bytes = time.bytes;
    }
    return least;
}

/// Compositions that differ in this kind only, that make sense in the scene and are exact.
std::vector<aabb::composition> others(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<aabb::composition> all;
    for (const aabb::strategy_info& info : aabb::strategies(kind)) {
        if (info.name == selected[kind].name) continue;
        aabb::composition c = selected;
        c[kind] = {info.name, {}};
        if (refusal_of(c, info_of(kind).stage).empty() && is_exact(c, info_of(kind).stage) &&
            (meshes || needs_meshes(c).empty()))
            all.push_back(c);
    }
    return all;
}

std::vector<std::string> cells_of(const std::string& kind, const std::string& name, const cost& each,
                                  const cost& selected) {
    return {kind,
            name,
            fmt::format("{:.4g}", each.frame_ms),
            fmt::format("{:.2f}", each.frame_ms / selected.frame_ms),
            fmt::format("{:.3g}", each.build_ms),
            grouped(each.bytes)};
}

}  // namespace

void print_savings(const scene_choice& choice, const aabb::composition& selected) {
    const scene_play scene(choice);
    const bool meshes = scene.meshes() != nullptr;
    const bool any = scene.objects() <= most_objects_of_any;
    const cost chosen = cost_of(choice, contender_of(selected, meshes));
    table t{{{"kind", false}, {"in its place", false}, {"ms a frame"}, {"times"}, {"build ms"}, {"bytes"}}, {}};
    t.rows.push_back(cells_of("", "as selected", chosen, chosen));
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (!meshes && info_of(kind).stage == aabb::stage::local_detection) continue;
        if (!any && !info_of(kind).apart) continue;
        for (const aabb::composition& c : others(selected, kind, meshes))
            t.rows.push_back(
                cells_of(std::string(name_of(kind)), c[kind].name, cost_of(choice, contender_of(c, meshes)), chosen));
    }
    print(fmt::format(
        "  what each choice saves: one kind at a time in another way, the least of {} plays of {} frames at most\n",
        repeats, most_frames));
    print(to_text(t, output_width()));
    if (!any)
        print(fmt::format("  with more than {} objects only kinds that stand apart are tried in other ways\n",
                          most_objects_of_any));
}

}  // namespace aabblab
