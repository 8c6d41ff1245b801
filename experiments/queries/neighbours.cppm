/// Pairs of triangles of a mesh that share a vertex.
module aabblab.queries:neighbours;

import aabb.geometry;
import aabb.std;

namespace aabblab {

/// How many vertices of one triangle lie where one of the other does.
[[nodiscard]] std::uint32_t shared_vertices(const aabb::mesh& m, aabb::index_pair pair);

/// Whether any does.
[[nodiscard]] bool share_vertex(const aabb::mesh& m, aabb::index_pair pair);

/// Merges all pairs a < b of triangles that share a vertex into others. They are found in the mesh one triangle at a
/// time, so that never more than those of one are held.
/// @param others sorted pairs that share no vertex
/// @param take gets the pairs of each triangle in turn, sorted
/// @returns how many pairs share a vertex
std::uint64_t for_each_with_neighbours(const aabb::mesh& m, std::span<const aabb::index_pair> others,
                                       const std::function<void(std::span<const aabb::index_pair>)>& take);

}  // namespace aabblab
