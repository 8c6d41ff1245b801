module aabblab.scenes;

import :kind;
import :random;

namespace aabblab {

namespace {

const scene_kind& kind_named(const std::string& name) {
    const auto kind = std::ranges::find(kinds(), name, [](const scene_kind& k) { return k.info.name; });
    if (kind == kinds().end())
        throw aabb::input_error(aabb::unknown_name("scene", name, scene_names(), "aabblab list scenes"));
    return *kind;
}

/// The scene without its filter, which the kinds do not know.
scene_choice without_filter(scene_choice choice) {
    std::erase_if(choice.settings, [](const aabb::setting& s) {
        return std::ranges::find(filter_settings, s.name) != filter_settings.end();
    });
    return choice;
}

void require_seed(const scene_info& info, const scene_choice& choice) {
    if (info.reads_file && choice.seed) throw aabb::input_error(info.name + " reads a file, so it has no seed");
    if (!info.reads_file && !choice.seed) throw aabb::input_error(info.name + " needs a seed");
}

}  // namespace

/// The names, summaries and parameters of all kinds of scenes.
std::span<const scene_info> scene_kinds() {
    static const std::vector<scene_info> infos = [] {
        std::vector<scene_info> list;
        for (const scene_kind& k : kinds()) list.push_back(k.info);
        return list;
    }();
    return infos;
}

const scene_info& scene_named(const std::string& kind) {
    return kind_named(kind).info;
}

bool has_meshes(const scene_choice& scene) {
    const auto info = std::ranges::find(scene_kinds(), scene.kind, &scene_info::name);
    return info != scene_kinds().end() && info->has_meshes;
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const scene_kind& k : kinds()) names.push_back(k.info.name);
    return names;
}

/// The edge of a cube (square, segment) with an equal share of the world for each object; flat axes do not count.
double mean_spacing(const aabb::vec3d& sides, std::size_t objects) {
    double volume = 1;
    int axes = 0;
    for (const double side : sides.at)
        if (side > 0) {
            volume *= side;
            ++axes;
        }
    if (axes == 0 || objects == 0) return 0;
    return edge_of(volume / static_cast<double>(objects), axes);
}

/// Identifies a scene but for its kind and seed: "objects=1000 frames=20 meshes=elephant.off+torus_knot".
std::string settings_text(const scene_choice& scene) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
    for (const aabb::setting& s : scene.settings) add(s.name + "=" + s.value);
    std::string meshes;
    for (const std::string& mesh : scene.meshes) meshes += (meshes.empty() ? "" : "+") + mesh;
    if (!meshes.empty()) add("meshes=" + meshes);
    return text;
}

std::string parameters_text(const scene_choice& scene) {
    std::string settings = settings_text(scene);
    if (!scene.seed) return settings;
    return settings + (settings.empty() ? "" : " ") + "seed=" + std::to_string(*scene.seed);
}

std::unique_ptr<aabb::box_scene> make_box_scene(const scene_choice& choice) {
    const scene_kind& kind = kind_named(choice.kind);
    if (kind.make_boxes == nullptr) throw aabb::input_error(choice.kind + " is a scene of meshes, not of boxes");
    if (!choice.meshes.empty()) throw aabb::input_error(choice.kind + " is a scene of boxes and takes no meshes");
    require_seed(kind.info, choice);
    return kind.make_boxes(without_filter(choice));
}

std::unique_ptr<aabb::mesh_scene> make_mesh_scene(const scene_choice& choice) {
    const scene_kind& kind = kind_named(choice.kind);
    if (kind.make_meshes == nullptr) throw aabb::input_error(choice.kind + " is a scene of boxes, not of meshes");
    require_seed(kind.info, choice);
    return kind.make_meshes(without_filter(choice));
}

}  // namespace aabblab
