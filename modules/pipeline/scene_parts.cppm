export module aabb.pipeline:scene_parts;

import aabb.std;
import :scene;

export namespace aabb {

/// Requires one pose per object of the scene, each an invertible affine map.
/// @throws input_error with both numbers, or with the first object whose pose is singular
void require_poses(const mesh_scene& scene, std::span<const pose> poses) {
    if (poses.size() != scene.mesh_of.size())
        throw input_error("the scene has " + std::to_string(scene.mesh_of.size()) + " objects, but the frame has " +
                          std::to_string(poses.size()) + " poses");
    for (std::size_t object = 0; object < poses.size(); ++object) {
        try {
            require_full_rank(poses[object]);
        } catch (const input_error& error) {
            throw input_error("object " + std::to_string(object) + ": " + error.what());
        }
    }
}

/// The world box of an object or of a part of it.
/// @param local box of the floats, in this frame
/// @throws input_error if it lies beyond the range of float
[[nodiscard]] box posed_box(const box& local, const vertex_frame& frame, const pose& at, std::size_t object) {
    const box world = world_bounds(local, at, frame);
    if (!is_valid(world)) throw input_error("object " + std::to_string(object) + " lies beyond the range of float");
    return world;
}

/// The world boxes of a scene of meshes in the current frame, for the broad phase.
class posed_boxes {
public:
    /// @param scene must outlive this object and have valid meshes (`require_valid`)
    explicit posed_boxes(const mesh_scene& scene) : scene_(scene), boxes_(scene.mesh_of.size()) {
        for (const mesh& m : scene.meshes) mesh_bounds_.push_back(bounds_of(m));
    }

    /// Computes the world box of each object from its mesh's box and its pose. The box of a deforming mesh is computed
    /// anew; such a mesh must still be valid.
    /// @throws input_error as `require_poses`, and on an object beyond the range of float, with its number
    void update(std::span<const pose> poses) {
        require_poses(scene_, poses);
        for (std::uint32_t m = 0; m < mesh_bounds_.size(); ++m)
            if (scene_.deforms(m)) mesh_bounds_[m] = bounds_of(scene_.meshes[m]);
        for (std::size_t object = 0; object < poses.size(); ++object) {
            const std::uint32_t m = scene_.mesh_of[object];
            boxes_[object] = posed_box(mesh_bounds_[m], scene_.meshes[m].frame, poses[object], object);
        }
    }

    /// The boxes of the current frame, by object.
    [[nodiscard]] std::span<const box> boxes() const noexcept { return boxes_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(mesh_bounds_, boxes_); }

private:
    const mesh_scene& scene_;
    std::vector<box> mesh_bounds_;
    std::vector<box> boxes_;
};

/// A scene whose objects the broad phase has divided (`global_stage::divide`). The broad phase sees pieces, which are
/// parts of objects or whole objects, numbered in the order of the objects. The narrow phase sees models, which are
/// the meshes of parts and of whole objects.
class scene_parts : public kept_in_place {
public:
    std::vector<index_pair> piece_pairs;  ///< overlapping pieces; after `append_objects`, one per candidate

    [[nodiscard]] virtual std::uint32_t pieces() const noexcept = 0;
    /// The half-open range of an object's pieces.
    [[nodiscard]] virtual std::pair<std::uint32_t, std::uint32_t> pieces_of(std::uint32_t object) const noexcept = 0;

    [[nodiscard]] virtual std::uint32_t models() const noexcept = 0;
    /// The reference stays valid for the lifetime of this object.
    [[nodiscard]] virtual const mesh& mesh_of(std::uint32_t model) const noexcept = 0;
    [[nodiscard]] virtual bool deforms(std::uint32_t model) const = 0;

    /// Updates the parts after vertices of deforming meshes have moved.
    /// @throws input_error if a mesh is invalid or its number of triangles has changed
    virtual void follow() = 0;
    /// @param poses one per object of the scene
    /// @throws input_error as `posed_boxes`
    virtual void place(std::span<const pose> poses) = 0;
    /// World boxes by piece.
    [[nodiscard]] virtual std::span<const box> boxes() const noexcept = 0;

    /// Removes the pairs of pieces of the same object, and appends the objects of each remaining pair.
    virtual void append_objects(std::vector<index_pair>& objects) = 0;
    [[nodiscard]] virtual index_pair models_of(index_pair pieces) const noexcept = 0;
    /// Converts triangle indices of two models to those of the scene's meshes.
    virtual void map_triangles(index_pair models, std::span<index_pair> triangles) const noexcept = 0;

    [[nodiscard]] virtual std::size_t bytes() const noexcept = 0;
};

/// Replaces `scene_parts` in pipelines that never divide objects, so that the code for parts is eliminated.
struct no_scene_parts {
    constexpr explicit operator bool() const noexcept { return false; }
    scene_parts* operator->() const noexcept { __builtin_unreachable(); }
};

}  // namespace aabb
