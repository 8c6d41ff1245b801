export module aabb.pipeline:scene_parts;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// What both stages see of a scene whose objects a global search has divided (`global_stage::divide`). Global search
/// sees pieces: parts of objects, and objects that are whole, numbered in the order of the objects. Local detection
/// sees models: meshes, of parts and whole ones.
class scene_parts {
public:
    scene_parts() = default;
    scene_parts(const scene_parts&) = delete;
    scene_parts& operator=(const scene_parts&) = delete;
    virtual ~scene_parts() = default;

    std::vector<index_pair> found;  ///< pairs of pieces that a search found, then by candidate

    [[nodiscard]] virtual std::uint32_t pieces() const noexcept = 0;
    /// Of an object, from the first one to behind the last one.
    [[nodiscard]] virtual std::pair<std::uint32_t, std::uint32_t> pieces_of(std::uint32_t object) const noexcept = 0;

    [[nodiscard]] virtual std::uint32_t models() const noexcept = 0;
    /// Stays where it is as long as this does.
    [[nodiscard]] virtual const mesh& mesh_of(std::uint32_t model) const noexcept = 0;
    [[nodiscard]] virtual bool deforms(std::uint32_t model) const = 0;

    /// After vertices of meshes that deform have moved.
    /// @throws input_error when a mesh is no longer valid or of as many triangles.
    virtual void follow() = 0;
    /// @param poses one an object of the scene
    /// @throws input_error as `posed_boxes`.
    virtual void place(std::span<const pose> poses) = 0;
    /// In the world, by piece.
    [[nodiscard]] virtual std::span<const box> boxes() const noexcept = 0;

    /// Of the pairs that were found, drops those of one object, and appends the objects of each of the others.
    virtual void name_objects(std::vector<index_pair>& objects) = 0;
    [[nodiscard]] virtual index_pair models_of(index_pair pieces) const noexcept = 0;
    /// Pairs of triangles of two models become those of the scene's meshes.
    virtual void name_triangles(index_pair models, std::span<index_pair> triangles) const noexcept = 0;

    [[nodiscard]] virtual std::size_t bytes() const noexcept = 0;
};

/// Stands in their place where nothing is ever divided: what is asked of parts is left out when it is compiled.
struct no_scene_parts {
    constexpr explicit operator bool() const noexcept { return false; }
    scene_parts* operator->() const noexcept { __builtin_unreachable(); }
};

}  // namespace aabb
