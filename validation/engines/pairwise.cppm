module aabb.engines:pairwise;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;

namespace aabb {

/// Finds pairs of triangles whose boxes overlap: triangle i of `a` and t of `b` as {i, t}, in any order.
using candidate_search = std::vector<index_pair>(std::span<const box> a, std::span<const box> b);
/// By CGAL's intersection of box sequences.
candidate_search candidates_by_cgal;

/// Decides on two triangles in one frame.
using triangle_decision = bool(const triangle3f&, const triangle3f&);

/// An engine that takes B's triangles into A's frame (`relative_pose`), finds candidates by boxes and decides them.
std::unique_ptr<local_stage> make_pairwise_engine(candidate_search& search, triangle_decision& decide);

}  // namespace aabb
