export module aabblab.scenes:scene_choice;

import aabb.policy;
import aabb.std;

export namespace aabblab {

/// A kind of scene as `aabblab list` shows it. Its parameters have names, defaults and limits like a strategy's.
struct scene_info {
    std::string name;  ///< "brownian", "lattice"; "mesh_pair", "mesh_swarm"
    std::string summary;
    bool has_meshes;
    bool plays_file;  ///< the one that its parameter `file` names, as it is: the scene has no seed
    std::vector<aabb::parameter_info> parameters;
};

/// A scene wanted: its kind, settings that differ from the defaults, a seed where it has one. Meshes are files or
/// generated shapes: "icosphere", "torus_knot:triangles=20000", "noise_sphere".
struct scene_choice {
    std::string kind;
    std::vector<aabb::setting> settings;  ///< "objects", "frames", "displacement", … as text
    std::vector<std::string> meshes;
    std::optional<std::uint64_t> seed = 1;  ///< empty where the kind plays a file
    /// Where files are looked for that are not found as they are named: the folder of the config. What the scene is
    /// does not depend on from where the config was read, so it is neither compared nor stored.
    std::filesystem::path folder = {};

private:
    [[nodiscard]] auto identity() const { return std::tie(kind, settings, meshes, seed); }

public:
    friend auto operator<=>(const scene_choice& s, const scene_choice& t) { return s.identity() <=> t.identity(); }
    friend bool operator==(const scene_choice& s, const scene_choice& t) { return s.identity() == t.identity(); }
};

/// The file of that name: as given, else in `folder`.
/// @throws aabb::input_error where it is in neither.
[[nodiscard]] std::filesystem::path found_file(const std::filesystem::path& name, const std::filesystem::path& folder);

/// The same for all scenes that differ in their seed only.
[[nodiscard]] inline scene_choice whatever_seed(scene_choice scene) {
    scene.seed.reset();
    return scene;
}

/// What a scene is beside its kind and its seed, to be read: "objects=1000 frames=20 meshes=elephant.off+torus_knot".
[[nodiscard]] std::string settings_text(const scene_choice& scene);
/// The same with "seed=1" behind, where the scene has a seed.
[[nodiscard]] std::string parameters_text(const scene_choice& scene);

}  // namespace aabblab
