/// Distances: pairs of boxes and of triangles that are nearer than a given distance, exactly, and the distance of two
/// meshes. The rest of the room is internal.
export module aabb.distance;

export import aabb.distance.box_gap;
export import aabb.distance.grown_stage;
export import aabb.distance.mesh_distance;
export import aabb.distance.triangle_distance;
export import aabb.distance.within_detection;
