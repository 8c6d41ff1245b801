module;
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

module aabblab.calibrate;

import :trial;
import aabb.counters;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabblab.play;
import aabblab.scenes;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Two meshes, one of which passes through the other.
struct mesh_seen {
    double build_ns = 0;
    double query_ns = 0;
    double triangles = 0;
    double visits = 0;
};

mesh_seen seen_of(const scene_choice& choice, const std::string& build, aabb::instrumentation counted) {
    aabb::composition c;
    c[aabb::strategy_kind::build] = {build, {}};
    scene_play scene(choice);
    mesh_seen seen;
    std::optional<player> p;
    seen.build_ns = 1e6 * elapsed_in([&] { p.emplace(contender_of(c, true), scene, counted); }).cpu_ms;
    play(scene, *p, [&](const played_frame& frame) { seen.query_ns += 1e6 * frame.detect.cpu_ms; });
    seen.triangles = static_cast<double>(outlook_of(scene).triangles);
    seen.visits = static_cast<double>(p->counters()[aabb::work::node_visits]);
    return seen;
}

void add_trial(std::vector<trial>& all, const scene_choice& choice, bool held_out, const std::string& build,
               cost_group group) {
    all.push_back({choice.kind + " " + settings_text(choice), held_out,
                   [=] {
                       const mesh_seen seen = seen_of(choice, build, aabb::instrumentation::counters);
                       return std::vector{piece{group, {seen.triangles}}, piece{cost_group::queries, {seen.visits}}};
                   },
                   [=] {
                       const mesh_seen seen = seen_of(choice, build, aabb::instrumentation::none);
                       return std::vector{seen.build_ns, seen.query_ns};
                   }});
}

void add_trials(std::vector<trial>& all, const std::string& standing, const std::string& passing, std::size_t triangles,
                bool held_out) {
    const std::string of = ":triangles=" + std::to_string(triangles);
    const scene_choice choice{"mesh_pair", {{"frames", "10"}}, {standing + of, passing + of}};
    add_trial(all, choice, held_out, "median", cost_group::median);
    add_trial(all, choice, held_out, "sah", cost_group::sah);
}

}  // namespace

std::vector<trial> mesh_trials(calibration_size size) {
    using sizes = std::vector<std::size_t>;
    const bool quick = size == calibration_size::quick;
    std::vector<trial> all;
    for (const std::size_t triangles : quick ? sizes{3000, 20'000} : sizes{3000, 20'000, 80'000}) {
        add_trials(all, "noise_sphere", "torus_knot", triangles, false);
        add_trials(all, "icosphere", "noise_sphere", triangles, false);
    }
    for (const std::size_t triangles : quick ? sizes{8000} : sizes{8000, 40'000})
        add_trials(all, "torus_knot", "icosphere", triangles, true);
    return all;
}

}  // namespace aabblab
