module aabb.pipeline;

import aabb.base;
import aabb.geometry;

namespace aabb {

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

posed_boxes::posed_boxes(const mesh_scene& scene) : scene_(scene), boxes_(scene.mesh_of.size()) {
    for (const mesh& m : scene.meshes) mesh_bounds_.push_back(bounds_of(m));
}

void posed_boxes::update(std::span<const pose> poses) {
    require_poses(scene_, poses);
    for (std::uint32_t m = 0; m < mesh_bounds_.size(); ++m)
        if (scene_.deforms(m)) mesh_bounds_[m] = bounds_of(scene_.meshes[m]);
    for (std::size_t object = 0; object < poses.size(); ++object) {
        boxes_[object] = world_bounds(mesh_bounds_[scene_.mesh_of[object]], poses[object]);
        if (!is_valid(boxes_[object]))
            throw input_error("object " + std::to_string(object) + " lies beyond the range of float");
    }
}

std::size_t posed_boxes::bytes() const noexcept {
    return bytes_of(mesh_bounds_) + bytes_of(boxes_);
}

}  // namespace aabb
