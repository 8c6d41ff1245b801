/// Concepts of scene kinds. A kind has a name, a summary and parameters like a strategy, and is constructed from its
/// configuration, meshes unless it has boxes, and a seed. A kind that reads a file opens the one of its configuration.
module aabblab.scenes:kind;

import aabb.pipeline;
import aabblab.files;
import :scene_choice;

namespace aabblab {

template <class S>
concept BoxScene = aabb::Configurable<S> && std::derived_from<S, aabb::box_scene> &&
                   std::constructible_from<S, const aabb::config_of<S>&, std::uint64_t>;

/// `default_meshes` are names for `make_mesh`; `most_meshes` limits their number.
template <class S>
concept MeshScene =
    aabb::Configurable<S> && std::derived_from<S, aabb::mesh_scene> &&
    std::constructible_from<S, const aabb::config_of<S>&, std::vector<aabb::mesh>, std::uint64_t> && requires {
        S::default_meshes;
        { S::most_meshes } -> std::convertible_to<std::size_t>;
    };

/// A kind that reads the `file` of its configuration.
template <class S>
concept ReadsFile = aabb::Configurable<S> && requires(const aabb::config_of<S>& config) {
    { config.file } -> std::convertible_to<std::string>;
};
/// Its file determines the boxes of every frame.
template <class S>
concept BoxFileScene = ReadsFile<S> && requires(const aabb::config_of<S>& config) {
    { S::open(config) } -> std::same_as<std::unique_ptr<aabb::box_scene>>;
};
/// Its file determines the poses of the given meshes in every frame.
template <class S>
concept MeshFileScene = ReadsFile<S> && requires(const aabb::config_of<S>& config, std::vector<aabb::mesh> meshes) {
    { S::open(config, std::move(meshes)) } -> std::same_as<std::unique_ptr<aabb::mesh_scene>>;
};

/// A kind and the function that makes its scenes: of boxes or of meshes; the other function is null.
struct scene_kind {
    scene_info info;
    std::unique_ptr<aabb::box_scene> (*make_boxes)(const scene_choice&) = nullptr;
    std::unique_ptr<aabb::mesh_scene> (*make_meshes)(const scene_choice&) = nullptr;
};

/// All kinds, in the order of CMakeLists.txt.
[[nodiscard]] std::span<const scene_kind> kinds();

[[nodiscard]] std::vector<aabb::mesh> meshes_named(const scene_choice& choice, std::span<const std::string> names,
                                                   std::size_t most);

/// The configuration of a scene, with its file's path resolved: here, or in the folder of the config.
template <ReadsFile S>
[[nodiscard]] aabb::config_of<S> with_file(const scene_choice& choice) {
    aabb::config_of<S> config = aabb::configured<S>(choice.settings);
    config.file = resolve_file(config.file, choice.folder).string();
    return config;
}

/// Describes kind S and how its scenes are made: of boxes or meshes, from settings and seed, or from a file.
template <class S>
[[nodiscard]] scene_kind kind_of() {
    scene_kind kind{{std::string(S::name), std::string(S::summary), MeshScene<S> || MeshFileScene<S>, ReadsFile<S>,
                     aabb::parameters_of<S>()}};
    if constexpr (BoxScene<S>) {
        kind.make_boxes = [](const scene_choice& choice) -> std::unique_ptr<aabb::box_scene> {
            return std::make_unique<S>(aabb::configured<S>(choice.settings), *choice.seed);
        };
    } else if constexpr (BoxFileScene<S>) {
        kind.make_boxes = [](const scene_choice& choice) { return S::open(with_file<S>(choice)); };
    } else if constexpr (MeshFileScene<S>) {
        kind.make_meshes = [](const scene_choice& choice) {
            constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
            return S::open(with_file<S>(choice), meshes_named(choice, choice.meshes, most));
        };
    } else {
        static_assert(MeshScene<S>, "a scene has boxes or meshes");
        kind.make_meshes = [](const scene_choice& choice) -> std::unique_ptr<aabb::mesh_scene> {
            const aabb::config_of<S> config = aabb::configured<S>(choice.settings);
            std::vector<std::string> names = choice.meshes;
            if (names.empty()) names.assign(S::default_meshes.begin(), S::default_meshes.end());
            return std::make_unique<S>(config, meshes_named(choice, names, S::most_meshes), *choice.seed);
        };
    }
    return kind;
}

}  // namespace aabblab
