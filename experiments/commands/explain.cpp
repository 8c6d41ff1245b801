#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

#include "experiments.hpp"

import aabb;
import aabb.registry;
import aabb.validation;
import aabblab.configs;
import aabblab.play;
import aabblab.scenes;

namespace aabblab {

namespace {

void print_parts(std::string_view stage, const std::string& made_of, const std::vector<aabb::part_bytes>& parts) {
    print(fmt::format("    {}{}{}\n", stage, made_of.empty() ? "" : ": ", made_of));
    for (const aabb::part_bytes& part : parts) print(fmt::format("      {:<12}{:>12} bytes\n", part.part, part.bytes));
}

/// Two frames, so that buffers have grown and what is kept between frames is there.
void explain_contender(const scene_choice& choice, const contender& who) {
    scene_play scene(choice);
    player p(who, scene, aabb::instrumentation::none);
    play(scene, p, [](const played_frame&) {}, 2);
    const contender_name& name = who.name;
    print("  " + text_of(name) + "\n");
    const std::string global =
        name.sort.empty() ? name.engine : name.sort + " + " + name.partition + " + " + name.sweep;
    print_parts("global search", global, p.global_bytes());
    print_parts(scene.meshes() ? "between stages" : "found pairs", "", {{"buffers", p.buffer_bytes()}});
    if (scene.meshes())
        print_parts("local detection", name.tree.empty() ? name.engine : name.tree + " + " + name.triangle,
                    p.local_bytes());
    print("    left out\n");
    for (const std::string& sentence : p.left_out()) print("      " + sentence + "\n");
    if (name.split_large == "off") print("      no split_large: large objects are searched whole\n");
}

/// Parts of the config that a scene has no use for.
void explain_unused(const experiment& e, const scene_choice& scene) {
    for (const aabb::engine_info& engine : aabb::engines())
        for (const std::string& name : e.engines)
            if (name == engine.name && !contender_of(engine, has_meshes(scene)))
                print("  " + name + " has no part in this scene: it searches no boxes\n");
    if (!has_meshes(scene)) print("  tree and triangle have no part in this scene: it has no meshes\n");
}

void explain(const std::string& config) {
    const experiment e = open_experiment(config, false);
    for (const scene_choice& scene : e.scenes) {
        print(scene.kind + " (" + visible(parameters_text(scene)) + ")\n");
        explain_unused(e, scene);
        for (const contender& who : contenders_for(e, scene)) explain_contender(scene, who);
        print("\n");
    }
}

}  // namespace

void add_explain(CLI::App& program, int&) {
    auto* command = program.add_subcommand(
        "explain", "Which composition each scene of an experiment gets, its bytes, and what is left out");
    auto config = std::make_shared<std::string>();
    command->add_option("CONFIG", *config, "Config of the experiment (.toml)")->required()->type_name("");
    command->callback([config] { explain(*config); });
}

}  // namespace aabblab
