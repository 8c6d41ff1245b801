export module aabb.split_mesh;

import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// A division of meshes into parts: for each mesh, the triangles of each part. Every triangle belongs to one part; a
/// mesh with fewer than two parts stays whole.
using mesh_division = std::vector<std::vector<std::vector<std::uint32_t>>>;

/// Divides the scene. A part is a mesh with its own, tighter box and the pose of its object. A vertex has the same
/// image in the part as in the mesh, so that the guarantees of `relative_pose` and `world_bounds` hold for parts, and
/// no intersecting triangles are missed.
/// @param scene must outlive the parts; its meshes are valid
[[nodiscard]] std::unique_ptr<scene_parts> divided(const mesh_scene& scene, mesh_division division);

}  // namespace aabb
