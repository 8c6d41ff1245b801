export module aabb.pipeline:scene_parts;

import aabb.std;
import :scene;

export namespace aabb {

/// Refuses what is not one rigid pose for each object of the scene.
/// @throws input_error that says how many there are, or names the first object whose pose is not rigid.
void require_poses(const mesh_scene& scene, std::span<const pose> poses) {
    if (poses.size() != scene.mesh_of.size())
        throw input_error("the scene has " + std::to_string(scene.mesh_of.size()) + " objects, but the frame has " +
                          std::to_string(poses.size()) + " poses");
    for (std::size_t object = 0; object < poses.size(); ++object) {
        try {
            require_rigid(poses[object]);
        } catch (const input_error& error) {
            throw input_error("object " + std::to_string(object) + ": " + error.what());
        }
    }
}

/// The box in the world of an object, or of a part of it.
/// @throws input_error where it lies beyond the range of float.
[[nodiscard]] box posed_box(const box& local, const pose& at, std::size_t object) {
    const box world = world_bounds(local, at);
    if (!is_valid(world)) throw input_error("object " + std::to_string(object) + " lies beyond the range of float");
    return world;
}

/// The objects of a scene of meshes as global search sees them: their boxes in the world, frame by frame.
class posed_boxes {
public:
    /// @param scene must outlive this; its meshes are valid (`require_valid`)
    explicit posed_boxes(const mesh_scene& scene) : scene_(scene), boxes_(scene.mesh_of.size()) {
        for (const mesh& m : scene.meshes) mesh_bounds_.push_back(bounds_of(m));
    }

    /// Takes a frame: follows the meshes that deform, which must still be valid, and places every object.
    /// @param poses one an object
    /// @throws input_error as `require_poses`, and on an object beyond the range of float, by its number.
    void update(std::span<const pose> poses) {
        require_poses(scene_, poses);
        for (std::uint32_t m = 0; m < mesh_bounds_.size(); ++m)
            if (scene_.deforms(m)) mesh_bounds_[m] = bounds_of(scene_.meshes[m]);
        for (std::size_t object = 0; object < poses.size(); ++object)
            boxes_[object] = posed_box(mesh_bounds_[scene_.mesh_of[object]], poses[object], object);
    }

    /// Of the frame, by object.
    [[nodiscard]] std::span<const box> boxes() const noexcept { return boxes_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(mesh_bounds_, boxes_); }

private:
    const mesh_scene& scene_;
    std::vector<box> mesh_bounds_;
    std::vector<box> boxes_;
};

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
