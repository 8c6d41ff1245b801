/// The geometry of a hit: what two triangles have in common, not only whether.
export module aabb.triangle.intersection;

export import aabb.geometry;

export namespace aabb {

/// What two closed triangles have in common. Kind and number of corners are exact for any finite triangles, zero-area
/// ones included, which are the segments and points that they are: a segment through a triangle has a point in common
/// with it. Coordinates are rounded:
///
/// A corner that is none of the triangles' is where an edge from a to b meets the other's plane or edge, of which a and
/// b lie at signed distances proportional to determinants p and q of opposite signs. These are computed exactly and
/// rounded once, p (1 + δ) with |δ| <= 1.001 u, u = 2^-53. Then a + (b - a) t with t = p / (p - q), a the nearer end:
/// p - q adds what has one sign, so t carries less than 4.1 u, the difference b - a one u and the product another: 6.2
/// u of |b - a| t, where t <= 1/2; the last sum rounds once more. On each axis the error is at most 4 u |b - a| + u
/// |corner|, and the smallest denormal for what underflows.
/// @throws input_error as `require_ieee_arithmetic`.
[[nodiscard]] triangle_intersection intersection_of(const triangle3d& s, const triangle3d& t);
[[nodiscard]] inline triangle_intersection intersection_of(const triangle3f& s, const triangle3f& t) {
    return intersection_of(in_double(s), in_double(t));
}

}  // namespace aabb
