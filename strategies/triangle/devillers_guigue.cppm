export module aabb.triangle.devillers_guigue;

import aabb.std;
import aabb.triangle.precision;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The test by Devillers and Guigue ("Faster triangle-triangle intersection tests", INRIA RR-4488, 2002) with
/// orientations in plain double, as it is commonly used, or float. Inexact: rounding decides signs near zero, and
/// zero-area triangles get no special treatment. When to use: as the fastest well-known test beside `exact`.
class devillers_guigue_triangle : public test_in_precision<precision_choice::float64> {
public:
    using test_in_precision::test_in_precision;

    static constexpr std::string_view name = "devillers_guigue";
    static constexpr std::string_view summary =
        "Devillers and Guigue's orientation signs in plain arithmetic: inexact, the fast baseline";

    template <class Real>
    [[nodiscard]] inline bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) const noexcept {
        return in_precision(s, t,
                            [](const auto& first, const auto& second) { return triangles_intersect(first, second); });
    }

private:
    /// Whether the intervals in which the triangles cut the common line of their planes overlap.
    template <class Real>
    [[nodiscard]] static inline bool triangles_intersect(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        const std::array<Real, 3> s_to_t = heights(s, t);
        if (on_one_side(s_to_t)) return false;
        const std::array<Real, 3> t_to_s = heights(t, s);
        if (on_one_side(t_to_s)) return false;
        if (s_to_t == std::array<Real, 3>{}) return coplanar_intersects(s, t);
        triangle3<Real> u = s;
        triangle3<Real> v = t;
        const bool flip_t = rotate_to_apex(u, s_to_t);
        const bool flip_s = rotate_to_apex(v, t_to_s);
        // Now each apex lies above the other triangle, so that the intervals on the common line start at the edge to
        // corner 1 of one triangle and end at the edge to corner 2 of the other.
        if (flip_t) v = {v[0], v[2], v[1]};
        if (flip_s) u = {u[0], u[2], u[1]};
        return side(u[0], u[1], v[0], v[1]) <= 0 && side(u[0], u[2], v[2], v[0]) <= 0;
    }

    template <class Real>
    [[nodiscard]] static inline Real side(const vec3<Real>& a, const vec3<Real>& b, const vec3<Real>& c,
                                          const vec3<Real>& d) noexcept {
        return dot(cross(b - a, c - a), d - a);
    }

    /// Signed distances of the corners of `s` from the plane of `t`, times the length of its normal.
    template <class Real>
    [[nodiscard]] static inline std::array<Real, 3> heights(const triangle3<Real>& s,
                                                            const triangle3<Real>& t) noexcept {
        const vec3<Real> normal = cross(t[0] - t[2], t[1] - t[2]);
        return {dot(normal, s[0] - t[2]), dot(normal, s[1] - t[2]), dot(normal, s[2] - t[2])};
    }

    template <class Real>
    [[nodiscard]] static inline bool on_one_side(const std::array<Real, 3>& d) noexcept {
        return d[0] * d[1] > 0 && d[0] * d[2] > 0;
    }

    /// Projects to the axis plane in which `s` has the largest area. The triangles are disjoint if one lies strictly
    /// beyond the line of an edge of the other.
    template <class Real>
    [[nodiscard]] static inline bool coplanar_intersects(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        const vec3<Real> normal = cross(s[1] - s[0], s[2] - s[0]);
        int dropped = std::abs(normal[1]) > std::abs(normal[0]) ? 1 : 0;
        if (std::abs(normal[2]) > std::abs(normal[dropped])) dropped = 2;
        return !any_edge_separates(s, t, dropped) && !any_edge_separates(t, s, dropped);
    }

    /// Whether `t` lies strictly beyond the line of an edge of `s` in the axis plane without the axis `dropped`.
    template <class Real>
    [[nodiscard]] static inline bool any_edge_separates(const triangle3<Real>& s, const triangle3<Real>& t,
                                                        int dropped) noexcept {
        const int x = (dropped + 1) % 3, y = (dropped + 2) % 3;
        const auto turn = [&](const vec3<Real>& a, const vec3<Real>& b, const vec3<Real>& c) {
            return (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
        };
        const Real inside = turn(s[0], s[1], s[2]);
        for (int i = 0; i < 3; ++i) {
            const vec3<Real>& from = s[i];
            const vec3<Real>& to = s[(i + 1) % 3];
            if (turn(from, to, t[0]) * inside < 0 && turn(from, to, t[1]) * inside < 0 &&
                turn(from, to, t[2]) * inside < 0)
                return true;
        }
        return false;
    }
};

static_assert(DoubleTrianglePolicy<devillers_guigue_triangle>);

}  // namespace aabb
