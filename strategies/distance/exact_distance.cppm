/// Distances of triangles of meshes at poses in exact arithmetic, for pairs that a filter leaves in doubt.
export module aabb.distance.exact_distance;

export import aabb.geometry;
import aabb.std;

export namespace aabb {

/// The least distance of two triangles, squared, and points at which it is attained.
struct nearest_of_triangles {
    scaled_double squared{};  ///< with a relative error of at most 2^-51
    vec3d p{}, q{};  ///< in the world; each coordinate with the same relative error, or off by the least double
};

/// Two disjoint closed triangles, zero-area ones included, in world coordinates R v + t that are not rounded.
///
/// The nearest points of disjoint triangles lie in the interior of two features (corners, edges, faces) whose
/// directions are all perpendicular to the segment between them. If a direction is common to both features, both points
/// can slide along it, at the same distance, until one reaches a smaller feature. This leaves two corners, a corner and
/// an edge, a corner and a face, or two edges that are not parallel; an edge and a face without a common direction span
/// all directions, so they would have to meet. For vectors u, v of the features and w between them, n = u × v, these
/// distances squared are w·w, (w × u)²/u², (w·n)²/n² and (w·n)²/n², where the nearest points of the lines or the plane
/// lie in the features (Ericson, "Real-time collision detection", 2005, sections 5.1.2 to 5.1.9). Features of zero
/// length or area are those of lower dimension, which are among the others.
///
/// All are quotients of integers of one unit, of degree six at most in differences of coordinates.
class disjoint_triangles {
public:
    /// @param poses,s,t must outlive this object
    disjoint_triangles(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept
        : poses_(poses), s_(s), t_(t) {}

    /// Whether their distance is at most d, which is finite and not negative.
    [[nodiscard]] bool are_within(double d) const noexcept;
    /// Their distance squared, and the points of the features that have it.
    [[nodiscard]] nearest_of_triangles nearest() const noexcept;

private:
    const pose_pair& poses_;
    const triangle3d& s_;
    const triangle3d& t_;
};

}  // namespace aabb
