export module aabb.local_detection:triangle_policy;

import aabb.geometry;
import aabb.policy;
import aabb.std;

export namespace aabb {

/// Decides whether two closed triangles share a point. One that is always right may say `static constexpr bool filtered
/// = true`: where many pairs come at once, a filter may then decide on most of them.
template <class R>
concept TrianglePolicy = Strategy<R> && requires(const R policy, const triangle3f& s, const triangle3f& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A triangle test that also takes doubles as they are.
template <class R>
concept DoubleTrianglePolicy = TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A triangle test that also constructs what two triangles have in common, those of floats taken in double.
template <class R>
concept ConstructingTrianglePolicy =
    TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
        { policy.intersection(s, t) } -> std::same_as<triangle_intersection>;
    };

}  // namespace aabb
