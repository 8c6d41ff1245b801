export module aabb.triangle.separating_axes;

import aabb.std;
import aabb.triangle.precision;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The separating axis test (Gottschalk, Lin and Manocha, "OBBTree", 1996; Ericson, "Real-Time Collision Detection",
/// 2005, section 5.2.10) on 17 axes: the normals, the cross products of edges and, for coplanar triangles, the normals
/// of edges. Inexact: rounded projections decide whether triangles touch. When to use: to compare with most engines.
class separating_axes_triangle : public test_in_precision<precision_choice::float32> {
public:
    using test_in_precision::test_in_precision;

    static constexpr std::string_view name = "separating_axes";
    static constexpr std::string_view summary =
        "projections on the 17 axes that can separate two triangles: inexact, what most engines use";

    template <class Real>
    [[nodiscard]] inline bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) const noexcept {
        return in_precision(s, t,
                            [](const auto& first, const auto& second) { return triangles_intersect(first, second); });
    }

private:
    /// Whether none of the 17 axes separates the triangles: normals, cross products of edges, and normals of edges.
    template <class Real>
    [[nodiscard]] static inline bool triangles_intersect(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        const auto edges_of = [](const triangle3<Real>& of) {
            return std::array{of[1] - of[0], of[2] - of[1], of[0] - of[2]};
        };
        const auto edges_s = edges_of(s);
        const auto edges_t = edges_of(t);
        const vec3<Real> normal_s = cross(edges_s[0], edges_s[1]);
        const vec3<Real> normal_t = cross(edges_t[0], edges_t[1]);
        const auto separates = [&](const vec3<Real>& axis) { return axis_separates(s, t, axis); };
        if (separates(normal_s) || separates(normal_t)) return false;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j)
                if (separates(cross(edges_s[i], edges_t[j]))) return false;
            if (separates(cross(normal_s, edges_s[i])) || separates(cross(normal_t, edges_t[i]))) return false;
        }
        return true;
    }

    /// Whether the axis separates the triangles; an axis of length zero never does.
    template <class Real>
    [[nodiscard]] static inline bool axis_separates(const triangle3<Real>& s, const triangle3<Real>& t,
                                                    const vec3<Real>& axis) noexcept {
        // Relative to a corner of `s`, which avoids cancellation far from the origin.
        const auto projection = [&](const triangle3<Real>& of) {
            return std::minmax({dot(axis, of[0] - s[0]), dot(axis, of[1] - s[0]), dot(axis, of[2] - s[0])});
        };
        const auto [s_low, s_high] = projection(s);
        const auto [t_low, t_high] = projection(t);
        return s_high < t_low || t_high < s_low;
    }
};

static_assert(DoubleTrianglePolicy<separating_axes_triangle>);

}  // namespace aabb
