#include "command_parser.hpp"

import aabb.pipeline;
import aabb.registry;
import aabblab.files;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.picture;
import aabblab.trials;
import aabblab.progress;
import aabblab.scenes;

namespace aabblab {

namespace {

struct scene_request {
    std::string kind;
    std::map<std::string, std::optional<std::string>> settings;  ///< by the parameter's name
    std::vector<std::string> meshes;
    std::optional<std::string> seed, out, motion, picture;
};

/// A mesh scene as input of the broad phase: the world boxes of its objects. Optionally writes their poses.
class world_boxes final : public aabb::box_scene {
public:
    /// @param out receives the poses; null if they are not written
    world_boxes(const scene_choice& scene, motion_file* out) : scene_(scene), motion_(out), world_(*scene_.meshes()) {
        if (scene_.meshes()->reacts())
            finder_.emplace(candidate_of(aabb::composition(), /*meshes=*/true), scene_, aabb::instrumentation::none);
    }

    [[nodiscard]] const aabb::mesh_scene& meshes() const { return *scene_.meshes(); }
    [[nodiscard]] std::size_t objects() const override { return scene_.objects(); }
    [[nodiscard]] std::size_t frames() const override { return scene_.frames(); }
    /// Places the objects of the next frame. A scene that reacts gets the contacts of this frame, to make the one
    /// after.
    bool next(std::vector<aabb::box>& boxes) override {
        if (!scene_.next()) return false;
        if (motion_) motion_->add(scene_.poses());
        scene_.place(world_);
        if (finder_) {
            finder_->update();
            finder_->search();
            finder_->detect();
            scene_.take_results(finder_->sorted_pairs(), finder_->sorted_contacts());
        }
        boxes.assign(world_.boxes().begin(), world_.boxes().end());
        return true;
    }

private:
    scene_frames scene_;
    motion_file* motion_;
    aabb::posed_boxes world_;
    std::optional<stage_runner> finder_;  // finds the contacts to which the scene reacts
};

/// Passes a scene on, and records what its picture and the report of its displacement need.
class observed_scene final : public aabb::box_scene {
public:
    explicit observed_scene(std::unique_ptr<aabb::box_scene> scene)
        : scene_(std::move(scene)), observations_(scene_->objects(), scene_->frames()) {}

    [[nodiscard]] std::size_t objects() const override { return scene_->objects(); }
    [[nodiscard]] std::size_t frames() const override { return scene_->frames(); }
    bool next(std::vector<aabb::box>& boxes) override {
        if (!scene_->next(boxes)) return false;
        observations_.add_frame(boxes, scene_->present());
        return true;
    }
    [[nodiscard]] std::span<const aabb::boxd> in_double() const override { return scene_->in_double(); }
    [[nodiscard]] std::span<const std::uint8_t> present() const override { return scene_->present(); }
    [[nodiscard]] const picture_data& observations() const { return observations_; }

private:
    std::unique_ptr<aabb::box_scene> scene_;
    picture_data observations_;
};

/// The seed option, else 1 if the kind has a seed.
std::optional<std::uint64_t> seed_of(const scene_request& request, const scene_info& kind) {
    if (!request.seed) return kind.reads_file ? std::nullopt : std::optional<std::uint64_t>(1);
    return parse_whole(*request.seed, 0, std::numeric_limits<std::uint64_t>::max(),
                       "--seed must be a whole number from 0 to 18446744073709551615");
}

/// Rejects scenes that poses alone do not describe: their meshes deform, or the parameter `normalise` scales them.
void require_poses_suffice(const scene_info& kind, const scene_choice& choice, const aabb::mesh_scene& scene) {
    for (std::uint32_t m = 0; m < scene.meshes.size(); ++m)
        if (scene.deforms(m))
            throw aabb::input_error(kind.name +
                                    " deforms its meshes, which the poses that --motion writes do not describe");
    if (std::ranges::find(kind.parameters, "normalise", &aabb::parameter_info::name) == kind.parameters.end()) return;
    const auto scaled = std::ranges::find(choice.settings, "normalise", &aabb::setting::name);
    if (scaled == choice.settings.end() || scaled->value != "no")
        throw aabb::input_error("--motion writes poses of unscaled meshes, so give --normalise no with it");
}

/// Creates a scene of boxes, or the world boxes of a scene of meshes.
/// @param motion receives the poses of the meshes; null if they are not written
std::unique_ptr<aabb::box_scene> make_scene(const scene_info& kind, const scene_choice& choice, motion_file* motion) {
    if (!kind.has_meshes && motion)
        throw aabb::input_error(kind.name + " is a scene of boxes, which have no poses to write with --motion");
    if (!kind.has_meshes) return make_box_scene(choice);
    auto scene = std::make_unique<world_boxes>(choice, motion);
    if (motion) require_poses_suffice(kind, choice, scene->meshes());
    return scene;
}

/// Every parameter of the scene with its value, chosen or default, for the heading of the picture.
std::string all_parameters(const scene_info& kind, const scene_choice& choice) {
    scene_choice whole = choice;
    whole.settings.clear();
    for (const aabb::parameter_info& p : kind.parameters) {
        const auto chosen = std::ranges::find(choice.settings, p.name, &aabb::setting::name);
        whole.settings.push_back({p.name, chosen == choice.settings.end() ? p.fallback : chosen->value});
    }
    return parameters_text(whole);
}

/// Requires the usual extension, which other programs rely on, unless the file is a pipe or a device.
void require_extension(const std::string& option, const std::optional<std::string>& file, const std::string& ending,
                       const std::string& what) {
    if (!file) return;
    const std::filesystem::path extension = std::filesystem::path(*file).extension();
    if (!extension.empty() && extension != ending)
        throw aabb::input_error(option + " must end in " + ending + ", not '" + *file + "': it writes " + what);
}

/// Rejects requests without outputs, outputs that would overwrite an input or each other, and wrong extensions.
void require_outputs(const scene_request& request) {
    std::vector<std::pair<std::string, std::string>> outputs;  // an option and its file
    if (request.out) outputs.emplace_back("--out", *request.out);
    if (request.motion) outputs.emplace_back("--motion", *request.motion);
    if (request.picture) outputs.emplace_back("--picture", *request.picture);
    const auto input = request.settings.find("file");
    for (const auto& [option, file] : outputs) {
        require_no_mesh(file, request.meshes);
        if (input != request.settings.end() && input->second) require_other_file(file, *input->second);
    }
    if (outputs.empty()) throw aabb::input_error("scene: expected --out, --motion or --picture, a file to write");
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (std::size_t j = i + 1; j < outputs.size(); ++j)
            require_two_files(outputs[i].first, outputs[i].second, outputs[j].first, outputs[j].second);
    require_extension("--out", request.out, ".aabbs",
                      "a recording; aabblab pairs writes the pairs of a recording as CSV");
    require_extension("--picture", request.picture, ".svg", "a picture");
}

/// Runs a scene once and writes all outputs from it: a recording of boxes, the poses of meshes, a picture.
void write_scene(const scene_request& request) {
    require_outputs(request);
    const scene_info& kind = scene_named(request.kind);
    scene_choice choice{request.kind, /*settings=*/{}, request.meshes, seed_of(request, kind)};
    for (const auto& [name, value] : request.settings)
        if (value) choice.settings.push_back({name, *value});
    // Outputs are opened before the scene runs, so that an error is reported without delay and leaves no files.
    std::optional<motion_file> motion;
    if (request.motion) motion.emplace(*request.motion);
    std::optional<output_file> picture;
    if (request.picture) picture.emplace(*request.picture);
    observed_scene scene(make_scene(kind, choice, motion ? &*motion : nullptr));
    note_left_out(choice.meshes);
    {
        progress shown("frames", scene.frames());
        if (request.out) {
            const std::string type = choice.seed ? fmt::format("aabblab, seed {}", *choice.seed) : "aabblab";
            write_recording(scene, request.kind, type, *request.out, [&](std::size_t done) { shown.update(done); });
        } else {
            std::vector<aabb::box> boxes;
            for (std::size_t done = 1; scene.next(boxes); ++done) shown.update(done);
        }
    }
    const std::string size = counted(scene.objects(), "object") + ", " + counted(scene.frames(), "frame");
    if (request.out) print(fmt::format("wrote {}: {}\n", visible(*request.out), size));
    if (motion) {
        motion->commit();
        print(fmt::format("wrote {}: {}\n", visible(*request.motion), size));
    }
    if (picture) {
        picture->write(
            picture_of(scene.observations(), {kind.name, kind.summary, visible(all_parameters(kind, choice))}));
        picture->commit();
        print(fmt::format("wrote {}: {}\n", visible(*request.picture), size));
    }
    print(displacement_text(scene.observations()) + "\n");
}

/// The option of a parameter, such as `--cell_size,--cell-size`; `--n` abbreviates the number of objects.
std::string option_names(const std::string& parameter) {
    std::string names = "--" + parameter;
    std::string dashed = names;
    std::ranges::replace(dashed, '_', '-');
    if (dashed != names) names += "," + dashed;
    return parameter == "objects" ? "--n," + names : names;
}

/// Adds an option for each parameter of any kind of scene; a scene rejects parameters that it lacks.
void add_parameters(const command_parser& command, scene_request& request) {
    for (const scene_info& kind : scene_kinds())
        for (const aabb::parameter_info& p : kind.parameters)
            if (const auto [at, is_new] = request.settings.try_emplace(p.name); is_new)
                command.option(option_names(p.name) + " V", &at->second, "").hidden();
    command.footer(
        "`aabblab list scenes` shows all scenes with their parameters. Each parameter is an option, such as --density "
        "0.2; --n means --objects.");
}

}  // namespace

void add_scene(const command_parser& program) {
    const command_parser command = program.add_command(
        "scene", "Generate a scene, and write it as a recording of boxes, a motion file or a picture");
    auto& request = command.set_action(write_scene);
    command.argument("NAME", &request.kind, "A scene that `aabblab list scenes` shows");
    add_parameters(command, request);
    command
        .option("--mesh MESH", &request.meshes,
                "Mesh file (OFF, OBJ, PLY, STL, glTF) or shape, for scenes of meshes; may be repeated")
        .one_value_at_a_time();
    command.option("--seed S", &request.seed, "Whole number: the same seed gives the same scene (default 1)");
    command.option("--out FILE", &request.out, "Recording to write (.aabbs)");
    command.option("--motion FILE", &request.motion, "Motion file to write, for `contacts`: the poses of the meshes");
    command.option("--picture FILE", &request.picture, "Picture to write (.svg): the first and the last frame");
}

}  // namespace aabblab
