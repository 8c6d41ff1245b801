#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

// Import, so they come last.
#include "experiments.hpp"
#include "explain_omissions.hpp"
#include "explain_savings.hpp"
#include "kept_costs.hpp"
#include "scene_arguments.hpp"
#include "wrapped_row.hpp"

import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.selection;
import aabb.validation;
import aabblab.configs;
import aabblab.measures;
import aabblab.numbers;
import aabblab.play;
import aabblab.scenes;
import aabblab.tables;

namespace aabblab {

namespace {

void print_parts(std::string_view stage, const std::string& made_of, const std::vector<aabb::part_bytes>& parts) {
    print(fmt::format("    {}{}{}\n", stage, made_of.empty() ? "" : ": ", made_of));
    for (const aabb::part_bytes& part : parts)
        print(fmt::format("      {:<12}{:>14} bytes\n", part.part, grouped(part.bytes)));
}

void print_wrapped(std::string_view before, const std::string& text) {
    std::istringstream lines(wrapped(text, std::max<std::size_t>(output_width(), 40) - before.size()));
    for (std::string line; std::getline(lines, line);) print(fmt::format("{}{}\n", before, line));
}

void print_sentences(std::string_view of, const std::vector<std::string>& sentences) {
    if (!sentences.empty()) print(fmt::format("    {}\n", of));
    for (const std::string& sentence : sentences) print_wrapped("      ", sentence);
}

/// What the stage is made of.
std::string text_of(const contender_name& name, aabb::stage stage) {
    std::string text;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (const std::string one = info_of(kind).stage == stage ? text_in_line(kind, name[kind]) : ""; !one.empty())
            text += (text.empty() ? "" : " + ") + one;
    return text.empty() ? name.engine : text;
}

/// So that buffers have grown and what is kept between frames is there.
constexpr std::size_t explained_frames = 2;

void explain_contender(const scene_choice& choice, const contender& who) {
    scene_play scene(choice);
    player p(who, scene, aabb::instrumentation::none);
    play(scene, p, [](const played_frame&) {}, explained_frames);
    const contender_name& name = who.name;
    print_wrapped("  ", text_of(name));
    print_parts("global search", text_of(name, aabb::stage::global_search), p.global_bytes());
    print_parts(scene.meshes() ? "between stages" : "found pairs", "", {{"buffers", p.buffer_bytes()}});
    if (scene.meshes()) print_parts("local detection", text_of(name, aabb::stage::local_detection), p.local_bytes());
    print_sentences("planned from what was seen", p.plans());
    print_sentences("left out", omissions_of(name, p.left_out()));
    flush_output();
}

/// Parts of the config that a scene has no use for.
void explain_unused(const experiment& e, const scene_choice& scene) {
    for (const aabb::engine_info& engine : aabb::engines())
        for (const std::string& name : e.engines)
            if (name == engine.name && !contender_of(engine, has_meshes(scene)))
                print("  " + name + " has no part in this scene: it searches no boxes\n");
    for (const external_engine& engine : e.externals)
        if (has_meshes(scene)) print("  " + engine.name + " has no part in this scene: it is given boxes only\n");
    if (has_meshes(scene)) return;
    std::string kinds;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (info_of(kind).stage == aabb::stage::local_detection)
            kinds += (kinds.empty() ? "" : ", ") + std::string(name_of(kind));
    print("  " + kinds + " have no part in this scene: it has no meshes\n");
}

/// What the scene is and what it is like; nothing is said of one that cannot be played.
void explain_measures(const scene_choice& scene) {
    table t{{{"measured", false}, {"", false}}, {}};
    for (const told_measure& one : told(measure_scene(scene))) t.rows.push_back({one.name, one.value});
    print(wrapped(scene.kind + " (" + visible(parameters_text(scene)) + ")") + "\n" + to_text(t, output_width()) +
          "\n");
    flush_output();
}

/// Reasons are broken where they are longer than the output is wide.
void print_selected(const std::vector<aabb::selected_strategy>& selected) {
    std::size_t kinds = std::string_view("selected").size();
    std::size_t choices = 0;
    for (const aabb::selected_strategy& one : selected) {
        kinds = std::max(kinds, name_of(one.kind).size());
        choices = std::max(choices, to_text(one.choice).size());
    }
    const std::size_t before = kinds + 2 + choices + 2;
    const std::size_t room = std::max(output_width(), before + 20) - before;
    table t{{{"selected", false}, {"", false}, {"because", false}}, {}};
    for (const aabb::selected_strategy& one : selected)
        add_wrapped_row(t, {std::string(name_of(one.kind)), to_text(one.choice), one.rule}, 2, room);
    print(to_text(t) + "\n");
}

/// What is selected and why, what comes of it, and what it saves.
/// @returns whether all that was played finds the same
bool explain_automatic(const scene_choice& choice, const aabb::named_strategies& named) {
    const scene_play scene(choice);
    std::vector<aabb::selected_strategy> selected = select_strategies(named, outlook_of(scene));
    const aabb::composition c = composed_of(selected);
    if (!scene.meshes())
        std::erase_if(selected, [](const aabb::selected_strategy& one) {
            return info_of(one.kind).stage == aabb::stage::local_detection;
        });
    print_selected(selected);
    explain_contender(choice, contender_of(c, scene.meshes() != nullptr));
    print("\n");
    return print_savings(choice, c);
}

bool explain_scene(const experiment& e, const scene_choice& scene) {
    explain_measures(scene);
    if (const std::size_t frames = scene_play(scene).frames(); frames > explained_frames)
        print(fmt::format("  bytes are those after {} of {} frames; run tells those after the last\n", explained_frames,
                          grouped(frames)));
    explain_unused(e, scene);
    bool same = true;
    for (const aabb::named_strategies& named : e.automatic) {
        same &= explain_automatic(scene, named);
        print("\n");
    }
    const std::vector<contender> all = contenders_for(e, scene);
    for (const contender& who : all)
        if (!who.name.is_automatic()) explain_contender(scene, who);
    if (all.size() > e.automatic.size()) print("\n");
    return same;
}

void explain_costs() {
    print(wrapped("strategies plan by " + costs_in_force()) + "\n\n");
}

int explain(const std::vector<std::string>& what) {
    if (what.size() == 1 && names_config(what.front())) {
        const experiment e = open_experiment(what.front(), false);
        explain_costs();
        bool same = true;
        for (const scene_choice& scene : e.scenes) same &= explain_scene(e, scene);
        return same ? 0 : 1;
    }
    experiment e;
    e.automatic.emplace_back();
    const scene_choice scene = scene_of_arguments(what);
    // What cannot be made is said before anything else.
    (void)scene_play(scene);
    explain_costs();
    return explain_scene(e, scene) ? 0 : 1;
}

}  // namespace

void add_explain(const command_parser& program, int& status) {
    const command_parser command = program.add_command(
        "explain", "What a scene is like, which composition it gets and why, its bytes, and what is left out");
    auto what = std::make_shared<std::vector<std::string>>();
    command
        .add_option(
            "WHAT", *what,
            std::string("Config of an experiment (.toml), for what it composes; or, for auto: ") + scene_arguments_help)
        .required()
        .type_name("");
    command.callback([what, &status] { status = explain(*what); });
}

}  // namespace aabblab
