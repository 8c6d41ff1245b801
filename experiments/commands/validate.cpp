#include "command_parser.hpp"

import aabb.registry;
import aabb.validation;
import aabblab.configs;
import aabblab.measures;
import aabblab.trials;
import aabblab.results;
import aabblab.scenes;
import aabblab.suites;
import aabblab.tables;

namespace aabblab {

namespace {

/// Every composition and engine, in small scenes of every kind that needs no file.
experiment built_in_experiment() {
    experiment e;
    for (const scene_info& info : scene_kinds())
        if (!info.has_meshes && !info.reads_file)
            e.scenes.push_back({info.name, {{"objects", "1000"}, {"frames", "5"}}, /*meshes=*/{}, /*seed=*/1});
    e.scenes.insert(
        e.scenes.end(),
        {{"mesh_pair", {{"frames", "4"}}, {"icosphere:triangles=1280", "torus_knot:triangles=2000"}, /*seed=*/1},
         {"mesh_swarm",
          {{"objects", "40"}, {"frames", "4"}},
          {"icosphere:triangles=320", "torus_knot:triangles=500", "noise_sphere:triangles=400"},
          /*seed=*/1}});
    // Stages are independent, so each broad phase and each narrow phase runs once, not every combination.
    e.compositions = aabb::every_composition(aabb::stage::global_search);
    for (const aabb::composition& c : aabb::every_composition(aabb::stage::local_detection))
        if (std::ranges::find(e.compositions, c) == e.compositions.end()) e.compositions.push_back(c);
    for (const aabb::engine_info& engine : aabb::engines()) e.engines.push_back(engine.name);
    return e;
}

/// "exact", "WRONG", or the number of differences by class.
std::string result_of(const validated_row& v) {
    if (!v.failure.empty()) return "WRONG";
    if (v.differences.empty()) return "exact";
    std::string text = "inexact:";
    for (const difference& d : v.differences)
        text += " " + std::to_string(d.count) + " " + d.what + " (" + d.kind + ")";
    return text;
}

struct validate_request {
    std::optional<std::string> config;
    bool quick = false;
};

int validate(const validate_request& request) {
    outlive_reader();
    if (request.quick && !request.config)
        throw aabb::input_error("--quick applies the quick settings of a config, so it needs CONFIG");
    const experiment e = request.config ? open_experiment(*request.config, request.quick) : built_in_experiment();
    std::size_t wrong = 0;
    for (const scene_choice& scene : e.scenes) {
        const scene_validation result = validate_scene(scene, candidates_for(e, scene));
        print(heading_of(scene) + ", all pairs of " + std::to_string(result.frames) + " frames compared with " +
              result.exact_by + ", digest " + result.digest + "\n\n");
        table t = empty_table({"composition or engine"}, {"pairs", "contacts"}, {"result"});
        for (const validated_row& v : result.candidates) {
            t.rows.push_back({text_of(v.name), std::to_string(v.candidates),
                              v.contacts ? std::to_string(*v.contacts) : "-", result_of(v)});
            if (v.failure.empty()) continue;
            ++wrong;
            note(v.failure);
        }
        print(to_text(t, output_width()) + "\n");
        flush_output();
    }
    print(wrong == 0 ? "Every composition that must be exact is exact.\n" : std::to_string(wrong) + " are wrong.\n");
    return wrong == 0 ? 0 : 1;
}

}  // namespace

void add_validate(const command_parser& program) {
    const command_parser command = program.add_command(
        "validate", "Compare every composition of an experiment, or all possible ones, with the ground truth");
    auto& request = command.set_action(validate);
    command.optional_argument(
        "CONFIG", &request.config,
        "Config of the experiment (.toml); default: every broad phase, narrow phase and engine, on small "
        "generated scenes of most kinds");
    command.flag("--quick", &request.quick, "Apply the quick settings of CONFIG, for a first look");
}

}  // namespace aabblab
