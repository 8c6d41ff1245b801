export module aabb.triangle.orientation_test;

export import aabb.geometry;
import aabb.std;

export namespace aabb {

/// Do two closed triangles share a point, zero-area ones included? The signs of at most eight orientations decide
/// (Devillers and Guigue, "Faster triangle-triangle intersection tests", INRIA RR-4488, 2002).
/// @tparam Signs computes the signs: constructed from the triangles and the lowest and highest corner of their box,
/// with `part`, `side`, `in_order`, `turn` and `beyond` as in `orientations`. The test is exact if the signs are. A
/// type that may fail to decide a sign returns 0 and has `unsure()`, true from then on; such pairs count as hits.
template <class Signs>
class orientation_test {
public:
    /// Compares the boxes and the corners first, and only then computes orientations, in double.
    template <class Real>
    [[nodiscard]] static inline bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        const auto [s_low, s_high] = range(s);
        const auto [t_low, t_high] = range(t);
        if (bits((s_low > t_high) | (t_low > s_high)) != 0) return false;
        if (share_a_corner(s, t)) return true;
        const triangle3d s_in_double = in_double(s);
        const triangle3d t_in_double = in_double(t);
        Signs signs(s_in_double, t_in_double, __builtin_convertvector(lesser(s_low, t_low), lanes<double>),
                    __builtin_convertvector(greater(s_high, t_high), lanes<double>));
        return near_intersects(s_in_double, t_in_double, signs);
    }

    /// Tests triangles whose second is known only up to an error on each axis.
    /// @returns nothing if that error could change the result
    [[nodiscard]] static inline std::optional<bool> intersects_if_certain(const triangle3f& s, const triangle3f& t,
                                                                          const vec3f& error_of_t) noexcept {
        const triangle3d s_in_double = in_double(s);
        const triangle3d t_in_double = in_double(t);
        const auto [s_low, s_high] = range(s_in_double);
        const auto [t_low, t_high] = range(t_in_double);
        const vec3d error{error_of_t[0], error_of_t[1], error_of_t[2]};
        // The differences of floats have a relative error of 2^-53.
        const lanes<double> beyond = coordinates(error) * (1 + 0x1p-50);
        if (bits((s_low - t_high > beyond) | (t_low - s_high > beyond)) != 0) return false;
        Signs signs(s_in_double, t_in_double, lesser(s_low, t_low), greater(s_high, t_high), error);
        // A sign that the error could change counts as a hit, so only hits may be uncertain.
        if (!near_intersects(s_in_double, t_in_double, signs)) return false;
        return signs.unsure() ? std::nullopt : std::optional(true);
    }

    /// Tests triangles of meshes at poses, in world coordinates: `Signs` is constructed from both and has their
    /// corners.
    [[nodiscard]] static inline bool intersects(const pose_pair& poses, const triangle3d& s,
                                                const triangle3d& t) noexcept
        requires std::constructible_from<Signs, const pose_pair&, const triangle3d&, const triangle3d&>
    {
        Signs signs(poses, s, t);
        return !signs.are_apart() && near_intersects(signs.s(), signs.t(), signs);
    }

private:
    using sides = corner_sides;

    template <class Lanes>
    [[nodiscard]] static inline Lanes lesser(const Lanes& p, const Lanes& q) noexcept {
        return p < q ? p : q;
    }
    template <class Lanes>
    [[nodiscard]] static inline Lanes greater(const Lanes& p, const Lanes& q) noexcept {
        return p > q ? p : q;
    }

    /// The lowest and the highest corner of the triangle's box.
    template <class Real>
    [[nodiscard]] static inline std::pair<lanes<Real>, lanes<Real>> range(const triangle3<Real>& t) noexcept {
        const lanes<Real> p = coordinates(t[0]);
        const lanes<Real> q = coordinates(t[1]);
        const lanes<Real> r = coordinates(t[2]);
        return {lesser(lesser(p, q), r), greater(greater(p, q), r)};
    }

    template <class Real>
    [[nodiscard]] static inline bool share_a_corner(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (bits(coordinates(s[i]) == coordinates(t[j])) == 7) return true;
        return false;
    }

    /// Tests triangles whose boxes overlap. A sign that could not be decided counts as a hit.
    [[nodiscard]] static inline bool near_intersects(const triangle3d& s, const triangle3d& t, Signs& signs) noexcept {
        sides s_to_t, t_to_s;
        if (signs.part(s_to_t, t_to_s)) return false;
        const bool crossing = crossing_intersects(s, s_to_t, t, t_to_s, signs);
        if constexpr (requires { signs.unsure(); })
            return crossing || signs.unsure();
        else
            return crossing;
    }

    /// Tests two triangles; neither lies strictly on one side of the other's plane.
    [[nodiscard]] static inline bool crossing_intersects(const triangle3d& s, const sides& s_to_t, const triangle3d& t,
                                                         const sides& t_to_s, Signs& signs) noexcept {
        // All sides are zero if the triangles are coplanar, or if the other one has zero area and thus no plane. A
        // nonzero side proves that the other triangle has a plane.
        const bool s_on_t = s_to_t.on_plane();
        const bool t_on_s = t_to_s.on_plane();
        if (s_on_t && t_on_s) return flat_intersects(signs, s, t);
        if (t_on_s) return line_meets(signs, s, s_to_t, t);
        if (s_on_t) return line_meets(signs, t, t_to_s, s);
        return intervals_meet(signs, s, s_to_t, t, t_to_s);
    }

    /// The corner that the other plane separates from the other two corners, and whether it is on the negative side.
    struct apex {
        std::uint8_t corner;
        bool negative;
    };

    /// Indexed by 8 above + below. An apex is either alone on its side of the plane, or on the plane with both other
    /// corners on one side. Rows with three equal sides are not used.
    static constexpr std::array<apex, 64> apices = [] {
        std::array<apex, 64> rows{};
        for (unsigned row = 0; row < 64; ++row) {
            const sides d{row / 8, row % 8};
            for (int i = 0; i < 3; ++i)
                for (const int up : {1, -1}) {
                    const int own = up * d[i];
                    const int p = up * d[(i + 1) % 3];
                    const int q = up * d[(i + 2) % 3];
                    if ((own > 0 && p <= 0 && q <= 0) || (own == 0 && p < 0 && q < 0))
                        rows[row] = {static_cast<std::uint8_t>(i), up < 0};
                }
        }
        return rows;
    }();

    [[nodiscard]] static inline apex apex_of(const sides& d) noexcept { return apices[8 * d.above + d.below]; }

    /// Each triangle cuts the common line of the planes in an interval between the edges at its apex. With each
    /// triangle flipped so that the other's apex lies above it, the intervals run in opposite directions, and two
    /// orientations compare their ends.
    [[nodiscard]] static inline bool intervals_meet(Signs& signs, const triangle3d& s, const sides& s_to_t,
                                                    const triangle3d& t, const sides& t_to_s) noexcept {
        const apex of_s = apex_of(s_to_t);
        const apex of_t = apex_of(t_to_s);
        const auto ends = [](const triangle3d& of, int from, bool turned) {
            const vec3d& p = of[(from + 1) % 3];
            const vec3d& q = of[(from + 2) % 3];
            return turned ? std::pair<const vec3d&, const vec3d&>(q, p) : std::pair<const vec3d&, const vec3d&>(p, q);
        };
        const vec3d& s0 = s[of_s.corner];
        const vec3d& t0 = t[of_t.corner];
        const auto [s1, s2] = ends(s, of_s.corner, of_t.negative);
        const auto [t1, t2] = ends(t, of_t.corner, of_s.negative);
        return signs.in_order(s0, s1, s2, t0, t1, t2);
    }

    /// `s` has zero area and crosses the plane of `t` in a point. Is it in `t`: does it pass all edges on one side?
    [[nodiscard]] static inline bool line_meets(Signs& signs, const triangle3d& s, const sides& s_to_t,
                                                const triangle3d& t) noexcept {
        const int other = s_to_t[0] != s_to_t[1] ? 1 : 2;  // a corner on another side than corner 0
        bool left = false, right = false;
        for (int i = 0; i < 3; ++i) {
            const int passing = signs.side(s[0], s[other], t[i], t[(i + 1) % 3]);
            left |= passing > 0;
            right |= passing < 0;
        }
        return !(left && right);
    }

    /// Tests coplanar triangles, or two of zero area. In a projection along an axis, disjoint convex sets are separated
    /// by the line of an edge, or they are collinear and their boxes are disjoint. Sets with disjoint projections are
    /// disjoint; sets that intersect in a projection in which their plane is not edge-on do intersect.
    [[nodiscard]] static inline bool flat_intersects(Signs& signs, const triangle3d& s, const triangle3d& t) noexcept {
        // Not known yet for corners that are rounded.
        if constexpr (requires { signs.boxes_are_disjoint(); })
            if (signs.boxes_are_disjoint()) return false;
        for (int axis = 0; axis < 3; ++axis) {
            const int s_turn = signs.turn(s[0], s[1], s[2], axis);
            const int t_turn = signs.turn(t[0], t[1], t[2], axis);
            if (s_turn != 0 || t_turn != 0)
                return !edge_separates(signs, s, s_turn, t, axis) && !edge_separates(signs, t, t_turn, s, axis);
        }
        // Two segments or points. If they are coplanar, do they intersect in all three projections?
        const auto end_of = [&](const triangle3d& u) -> const vec3d& {
            // Different corners may be rounded to the same point.
            if constexpr (requires { signs.are_equal(u[0], u[1]); })
                return signs.are_equal(u[0], u[1]) ? u[2] : u[1];
            else
                return u[0] == u[1] ? u[2] : u[1];
        };
        const vec3d& s_end = end_of(s);
        const vec3d& t_end = end_of(t);
        if (signs.side(s[0], s_end, t[0], t_end) != 0) return false;
        for (int axis = 0; axis < 3; ++axis)
            if (signs.beyond(s[0], s_end, /*own=*/0, t, axis) || signs.beyond(t[0], t_end, /*own=*/0, s, axis))
                return false;
        return true;
    }

    /// Does the line of an edge of `s` have `s` on one side and `t` strictly on the other? `turn` is the sign of `s`.
    [[nodiscard]] static inline bool edge_separates(Signs& signs, const triangle3d& s, int turn, const triangle3d& t,
                                                    int axis) noexcept {
        for (int i = 0; i < 3; ++i)
            if (signs.beyond(s[i], s[(i + 1) % 3], turn, t, axis)) return true;
        return false;
    }
};

}  // namespace aabb
