export module aabblab.scenes:scene_choice;

import aabb.policy;
import aabb.std;

export namespace aabblab {

/// A kind of scene as `aabblab list` shows it, with parameters like those of a strategy.
struct scene_info {
    std::string name;  ///< "brownian", "lattice"; "mesh_pair", "mesh_swarm"
    std::string summary;
    bool has_meshes;
    bool reads_file;  ///< whether it reads its parameter `file`; it then has no seed
    std::vector<aabb::parameter_info> parameters;
};

/// The settings of every kind of scene that name the files of a collision filter: attributes of objects, and pairs that
/// are left out. The filter acts on the search of the scene, not on its frames (`aabblab.filters`).
inline constexpr std::array<std::string_view, 2> filter_settings{"groups", "except"};

/// Identifies a scene: its kind, settings that differ from the defaults, and a seed unless it reads a file. Meshes are
/// files or generated shapes: "icosphere", "torus_knot:triangles=20000", "noise_sphere".
struct scene_choice {
    std::string kind;
    std::vector<aabb::setting> settings;  ///< "objects", "frames", "displacement", … as text
    std::vector<std::string> meshes;
    std::optional<std::uint64_t> seed = 1;  ///< empty if the kind reads a file
    /// The config's folder, a fallback for relative paths. It is no part of the scene, so neither compared nor stored.
    std::filesystem::path folder = {};

private:
    [[nodiscard]] auto identity() const { return std::tie(kind, settings, meshes, seed); }

public:
    friend auto operator<=>(const scene_choice& s, const scene_choice& t) { return s.identity() <=> t.identity(); }
    friend bool operator==(const scene_choice& s, const scene_choice& t) { return s.identity() == t.identity(); }
};

/// The path of a file: as given, else in `folder`.
/// @throws aabb::input_error if neither exists.
[[nodiscard]] std::filesystem::path resolve_file(const std::filesystem::path& name,
                                                 const std::filesystem::path& folder);

/// Identifies all scenes that differ only in their seed.
[[nodiscard]] inline scene_choice without_seed(scene_choice scene) {
    scene.seed.reset();
    return scene;
}

/// The settings and meshes as text: "objects=1000 frames=20 meshes=elephant.off+torus_knot".
[[nodiscard]] std::string settings_text(const scene_choice& scene);
/// Likewise with "seed=1" appended, if the scene has a seed.
[[nodiscard]] std::string parameters_text(const scene_choice& scene);

}  // namespace aabblab
