#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

import aabb;
import aabblab.files;
import aabblab.progress;
import aabblab.scenes;

namespace aabblab {

namespace {

struct scene_request {
    std::string kind;
    std::map<std::string, std::optional<std::string>> settings;  ///< by the parameter's name
    std::vector<std::string> meshes;
    std::string seed = "1";
    std::string out;
};

/// A scene of meshes as global search sees it: the world boxes of its objects.
class world_boxes final : public aabb::box_scene {
public:
    explicit world_boxes(std::unique_ptr<aabb::mesh_scene> scene) : scene_(std::move(scene)) {
        for (const aabb::mesh& m : scene_->meshes) bounds_.push_back(aabb::bounds_of(m));
    }

    [[nodiscard]] std::size_t objects() const override { return scene_->mesh_of.size(); }
    [[nodiscard]] std::size_t frames() const override { return scene_->frames(); }
    bool next(std::vector<aabb::box>& boxes) override {
        if (!scene_->next(poses_)) return false;
        boxes.clear();
        for (std::size_t object = 0; object < poses_.size(); ++object)
            boxes.push_back(aabb::world_bounds(bounds_[scene_->mesh_of[object]], poses_[object]));
        aabb::require_valid(boxes);
        return true;
    }

private:
    std::unique_ptr<aabb::mesh_scene> scene_;
    std::vector<aabb::box> bounds_;  // by mesh
    std::vector<aabb::pose> poses_;
};

std::uint64_t parse_seed(const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc{} || end != text.data() + text.size())
        throw aabb::input_error("--seed must be a whole number from 0 to 18446744073709551615, not '" + text + "'");
    return seed;
}

std::unique_ptr<aabb::box_scene> make_scene(const scene_choice& choice) {
    const auto kinds = scene_kinds();
    const auto kind = std::ranges::find(kinds, choice.kind, &scene_info::name);
    if (kind == kinds.end()) throw aabb::input_error(aabb::unknown_name("scene", choice.kind, scene_names()));
    if (kind->has_meshes) return std::make_unique<world_boxes>(make_mesh_scene(choice));
    return make_box_scene(choice);
}

void write_scene(const scene_request& request) {
    scene_choice choice{request.kind, {}, request.meshes, parse_seed(request.seed)};
    for (const auto& [name, value] : request.settings)
        if (value) choice.settings.push_back({name, *value});
    const std::unique_ptr<aabb::box_scene> scene = make_scene(choice);
    {
        progress shown("frames written", scene->frames());
        write_recording(*scene, request.kind, fmt::format("aabblab, seed {}", choice.seed), request.out,
                        [&](std::size_t done) { shown.at(done); });
    }
    print(fmt::format("wrote {}: {} objects, {} frames\n", request.out, scene->objects(), scene->frames()));
}

/// `--cell_size,--cell-size` of the parameter cell_size; `--n` is short for the number of objects.
std::string option_names(const std::string& parameter) {
    std::string names = "--" + parameter;
    std::string dashed = names;
    std::ranges::replace(dashed, '_', '-');
    if (dashed != names) names += "," + dashed;
    return parameter == "objects" ? "--n," + names : names;
}

/// One option for each parameter of any kind of scene, which refuses those it does not have.
void add_parameters(CLI::App& command, scene_request& request) {
    std::map<std::string, std::string> helps;
    for (const scene_info& kind : scene_kinds())
        for (const aabb::parameter_info& p : kind.parameters) {
            std::string& help = helps[p.name];
            help += fmt::format("{}{} (default {})", help.empty() ? "Of " : ", ", kind.name, p.fallback);
        }
    for (const auto& [name, help] : helps)
        command.add_option(option_names(name), request.settings[name], help)->type_name("V");
    command.footer("aabblab list tells what these parameters mean and may be.");
}

}  // namespace

void add_scene(CLI::App& program, int&) {
    auto* command = program.add_subcommand("scene", "Write a generated scene as a recording of boxes");
    auto request = std::make_shared<scene_request>();
    std::string names;
    for (const std::string& name : scene_names()) names += (names.empty() ? "" : ", ") + name;
    command->add_option("NAME", request->kind, "One of " + names)->required()->type_name("");
    add_parameters(*command, *request);
    command->add_option("--mesh", request->meshes, "Mesh file or shape, for scenes of meshes; may be repeated")
        ->allow_extra_args(false)
        ->type_name("MESH");
    command->add_option("--seed", request->seed, "Whole number: the same seed gives the same scene (default 1)")
        ->type_name("S");
    command->add_option("--out", request->out, "The recording to write (.aabbs)")->required()->type_name("FILE");
    command->callback([request] { write_scene(*request); });
}

}  // namespace aabblab
