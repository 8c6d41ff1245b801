export module aabb.triangle.exact;

import aabb.local_detection;
import aabb.std;
import aabb.triangle.intersection;
import aabb.triangle.orientation_test;

export namespace aabb {

/// `orientation_test` with exact signs: exact for all finite triangles of floats or doubles, including zero-area ones.
/// Outside of a query, the caller must call `require_ieee_arithmetic` first.
/// When to use: wherever a wrong result matters; it costs little more than an inexact test.
struct exact_triangle : orientation_test<orientations> {
    static constexpr std::string_view name = "exact";
    static constexpr std::string_view summary =
        "exact for any finite triangles, zero-area ones included: orientation signs, filtered in double";
    static constexpr bool filtered = true;

    using orientation_test<orientations>::intersects;
    /// The same for an image of `t` with an error on each axis; nothing if the error could change the result.
    [[nodiscard]] static std::optional<bool> intersects_if_certain(const triangle3f& s, const triangle3f& t,
                                                                   const vec3f& error_of_t) noexcept {
        return orientation_test<filtered_orientations<false>>::intersects_if_certain(s, t, error_of_t);
    }
    /// The same at poses, as they are given: `posed_orientations`.
    [[nodiscard]] static bool intersects(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept {
        return orientation_test<posed_orientations>::intersects(poses, s, t);
    }

    [[nodiscard]] static triangle_intersection intersection(const triangle3d& s, const triangle3d& t) {
        return intersection_of(s, t);
    }
};

static_assert(DoubleTrianglePolicy<exact_triangle> && PosedTrianglePolicy<exact_triangle> &&
              ConstructingTrianglePolicy<exact_triangle>);

}  // namespace aabb
