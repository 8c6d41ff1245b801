/// Scenes by name: moving boxes or meshes that a seed reproduces on every machine, or that are read from a file.
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

/// @throws aabb::input_error on an unknown kind, parameter or value, extra meshes, an extra or no seed, a bad file.
[[nodiscard]] std::unique_ptr<aabb::box_scene> make_box_scene(const scene_choice& choice);
[[nodiscard]] std::unique_ptr<aabb::mesh_scene> make_mesh_scene(const scene_choice& choice);

/// Whether this is the name of a mesh: a file (as given, in `folder` or in the data folder) or a shape.
[[nodiscard]] bool is_mesh(std::string_view name, const std::filesystem::path& folder);
/// The name of the file or shape, without a suffix ":order=BUILD".
[[nodiscard]] std::string_view name_without_order(std::string_view name, const std::filesystem::path& folder = {});
/// Finds a mesh by name, in the order of `is_mesh`. With the suffix ":order=BUILD", or ",order=BUILD" after parameters
/// of a shape, its triangles are sorted in the order of the leaves of a tree with this build.
/// @throws aabb::input_error on an unknown file, shape or build, with the nearest name.
[[nodiscard]] loaded_mesh make_mesh(std::string_view name, const std::filesystem::path& folder = {});

/// A generated mesh as `aabblab list` shows it.
struct shape_info {
    std::string name;  ///< "icosphere", "torus_knot", "noise_sphere", "square", "slivers"
    std::string summary;
    std::vector<aabb::parameter_info> parameters;
};
[[nodiscard]] std::span<const shape_info> shapes();

/// The folder of downloaded meshes: AABBLAB_DATA in the environment, else experiments/data of the source tree.
[[nodiscard]] std::filesystem::path data_folder();

}  // namespace aabblab
