/// The geometry of a hit: the intersection of two triangles.
export module aabb.triangle.intersection;

export import aabb.geometry;

export namespace aabb {

/// The intersection of two closed triangles. Kind and number of corners are exact for all finite triangles. Zero-area
/// triangles count as segments or points: a segment that pierces a triangle shares one point with it. Coordinates are
/// rounded:
///
/// A corner that is not a corner of either triangle is where an edge from a to b crosses the other's plane or edge,
/// from which a and b have signed distances proportional to determinants p and q of opposite signs. These are computed
/// exactly and rounded once, p (1 + δ) with |δ| <= 1.001 u, u = 2^-53. The corner is a + (b - a) t with t = p / (p -
/// q), a the nearer end. p - q has no cancellation, so that t has a relative error below 4.1 u, b - a one u and the
/// product another: 6.2 u of |b - a| t, where t <= 1/2; the last sum rounds once more. On each axis the error is at
/// most 4 u |b - a| + u |corner|, plus the smallest denormal for underflow. A corner of a triangle is exact.
/// @throws input_error as `require_ieee_arithmetic`.
[[nodiscard]] triangle_intersection intersection_of(const triangle3d& s, const triangle3d& t);
[[nodiscard]] inline triangle_intersection intersection_of(const triangle3f& s, const triangle3f& t) {
    return intersection_of(in_double(s), in_double(t));
}

/// The same for triangles of meshes at poses of full rank, in world coordinates R v + t. Kind and number of corners are
/// exact for vertices and poses as they are given. Corners of the triangles are rounded to double here, by at most 2 u
/// of a coordinate, which adds to the error of the other corners.
[[nodiscard]] triangle_intersection intersection_of(const pose_pair& poses, const triangle3d& s, const triangle3d& t);

/// The kind of that intersection alone, which takes less time.
[[nodiscard]] intersection_kind intersection_kind_of(const pose_pair& poses, const triangle3d& s, const triangle3d& t);

}  // namespace aabb
