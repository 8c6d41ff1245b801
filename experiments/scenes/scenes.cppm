/// Scenes by name: boxes or meshes that move, the same for the same seed on every machine, or as a file says.
export module aabblab.scenes;

import aabb.pipeline;
import aabb.std;
import aabblab.files;
export import :dropped_world;
export import :pair_classes;
export import :scene_choice;
export import :spacing;

export namespace aabblab {

[[nodiscard]] std::span<const scene_info> scene_kinds();
/// @throws aabb::input_error on an unknown kind, with the nearest one.
[[nodiscard]] const scene_info& scene_named(const std::string& kind);
[[nodiscard]] bool has_meshes(const scene_choice& scene);
[[nodiscard]] std::vector<std::string> scene_names();

/// @throws aabb::input_error on an unknown kind, parameter or value, on meshes for a scene of boxes, on a seed where
/// there is none and the other way round, and on a file that cannot be played.
[[nodiscard]] std::unique_ptr<aabb::box_scene> make_box_scene(const scene_choice& choice);
[[nodiscard]] std::unique_ptr<aabb::mesh_scene> make_mesh_scene(const scene_choice& choice);

/// Whether a mesh has this name: a file, as given, in `folder` or in the data folder, or a shape.
[[nodiscard]] bool is_mesh(std::string_view name, const std::filesystem::path& folder);
/// The name before ":order=BUILD", if that stands there: that of a file or a shape.
[[nodiscard]] std::string_view name_without_order(std::string_view name, const std::filesystem::path& folder = {});
/// The mesh of that name, looked for in this order. With ":order=BUILD" behind it, or ",order=BUILD" among a shape's
/// parameters, its triangles stand in the order of the leaves that this build makes.
/// @throws aabb::input_error on a name that is neither a file nor a shape, or no build, with the nearest one.
[[nodiscard]] loaded_mesh make_mesh(std::string_view name, const std::filesystem::path& folder = {});

/// A generated mesh as `aabblab list` shows it.
struct shape_info {
    std::string name;  ///< "icosphere", "torus_knot", "noise_sphere", "square", "slivers"
    std::string summary;
    std::vector<aabb::parameter_info> parameters;
};
[[nodiscard]] std::span<const shape_info> shapes();

/// Where `aabblab data` puts real meshes: AABBLAB_DATA in the environment, else experiments/data of the source tree.
[[nodiscard]] std::filesystem::path data_folder();

}  // namespace aabblab
