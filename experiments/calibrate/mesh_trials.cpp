module aabblab.calibrate;

import :trial;
import aabb.counters;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabblab.trials;
import aabblab.scenes;

namespace aabblab {

namespace {

/// Two meshes, one of which passes through the other.
observation seen_of(const scene_choice& choice, const std::string& build, aabb::instrumentation counted) {
    aabb::composition c;
    c[aabb::strategy_kind::build] = {build, {}};
    return observe(choice, contender_of(c, true), {.counted = counted});
}

void add_trial(std::vector<trial>& all, const scene_choice& choice, bool held_out, const std::string& build,
               cost_group group) {
    all.push_back({choice.kind + " " + settings_text(choice), held_out,
                   [=] {
                       const observation seen = seen_of(choice, build, aabb::instrumentation::counters);
                       const auto triangles = static_cast<double>(outlook_of(scene_play(choice)).triangles);
                       const auto visits = static_cast<double>(seen.work[aabb::work::node_visits]);
                       return std::vector{piece{group, {triangles}}, piece{cost_group::queries, {visits}}};
                   },
                   [=] {
                       const observation seen = seen_of(choice, build, aabb::instrumentation::none);
                       return std::vector{1e6 * seen.build.cpu_ms,
                                          1e6 * (seen.first.detect.cpu_ms + seen.rest.detect.cpu_ms)};
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
