export module aabb.pipeline:posed_boxes;

import aabb.geometry;
import aabb.std;
import :scene;

export namespace aabb {

/// Refuses what is not one rigid pose for each object of the scene.
/// @throws input_error that says how many there are, or names the first object whose pose is not rigid.
void require_poses(const mesh_scene& scene, std::span<const pose> poses);

/// The objects of a scene of meshes as global search sees them: their boxes in the world, frame by frame.
class posed_boxes {
public:
    /// @param scene must outlive this; its meshes are valid (`require_valid`)
    explicit posed_boxes(const mesh_scene& scene);

    /// Takes a frame: follows the meshes that deform, which must still be valid, and places every object.
    /// @param poses one an object
    /// @throws input_error as `require_poses`, and on an object beyond the range of float, by its number.
    void update(std::span<const pose> poses);

    /// Of the frame, by object.
    [[nodiscard]] std::span<const box> boxes() const noexcept { return boxes_; }
    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    const mesh_scene& scene_;
    std::vector<box> mesh_bounds_;
    std::vector<box> boxes_;
};

}  // namespace aabb
