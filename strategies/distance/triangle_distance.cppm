/// Distances of triangles of meshes at poses.
export module aabb.distance.triangle_distance;

export import aabb.geometry;
import aabb.distance.exact_distance;
import aabb.distance.rounded_triangles;
import aabb.std;
import aabb.triangle.orientation_test;

export namespace aabb {

/// Whether two closed triangles share a point, exactly.
[[nodiscard]] inline bool triangles_meet(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept {
    // Equal poses are one invertible map of both triangles, which keeps whether they intersect.
    return poses.a == poses.b ? orientation_test<orientations>::intersects(s, t)
                              : orientation_test<posed_orientations>::intersects(poses, s, t);
}

/// Whether two closed triangles have points at a distance of at most d, in integers.
[[nodiscard]] inline bool are_within_unrounded(const pose_pair& poses, const triangle3d& s, const triangle3d& t,
                                               double d) noexcept {
    return triangles_meet(poses, s, t) || (d > 0 && disjoint_triangles(poses, s, t).are_within(d));
}

/// Whether two closed triangles have points at a distance of at most d, in real arithmetic: corners lie at R v + t, for
/// vertices and poses as they are given. Triangles that intersect have distance 0; zero-area ones are segments or
/// points. Rounded bounds decide first (`rounded_pairs`), then exact integers (`disjoint_triangles`). The caller must
/// have called `require_ieee_arithmetic`.
/// @param poses of full rank
/// @param d finite and not negative
[[nodiscard]] inline bool are_within(const pose_pair& poses, const triangle3d& s, const triangle3d& t,
                                     double d) noexcept {
    const std::optional<bool> known = rounded_triangles(poses, s, t).are_within(d);
    return known ? *known : are_within_unrounded(poses, s, t, d);
}
[[nodiscard]] inline bool are_within(const triangle3d& s, const triangle3d& t, double d) noexcept {
    return are_within(pose_pair{}, s, t, d);
}

/// The distance of two triangles between bounds that are certain, and points at which it is attained up to rounding.
struct measured_distance {
    double lower = 0, upper = 0;
    double value = 0;        ///< between them
    vec3d p{}, q{};          ///< in the world
    double point_error = 0;  ///< of the points: from their triangles, and of the distance between them
};

/// Measures the distance of two triangles. Where rounded bounds cannot exclude that the triangles intersect, or are
/// wide as for long triangles that almost meet, and where numbers are too large or too small for them, exact arithmetic
/// decides. Beyond the range of double, the distance and points are infinite.
/// @param most if the distance is certainly not less, `upper` may be infinite, and only `lower` be set besides
[[nodiscard]] measured_distance measured(const pose_pair& poses, const triangle3d& s, const triangle3d& t, double most);

}  // namespace aabb
