export module aabb.split_mesh;

import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// Into which parts meshes are divided: by mesh, the triangles of each part. Every triangle stands in one of them; a
/// mesh of less than two parts stays whole.
using mesh_division = std::vector<std::vector<std::vector<std::uint32_t>>>;

/// The scene, divided so. A part is a mesh with its own, tighter box, which stands where its object does. So what is
/// shown of meshes holds for parts (`relative_pose`, `world_bounds`): the image of a vertex is the same, and triangles
/// that meet are found.
/// @param scene must outlive the parts; its meshes are valid
[[nodiscard]] std::unique_ptr<scene_parts> divided(const mesh_scene& scene, mesh_division division);

}  // namespace aabb
