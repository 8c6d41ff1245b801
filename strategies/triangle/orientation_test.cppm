module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

export module aabb.triangle.orientation_test;

import aabb.geometry;

export namespace aabb {

/// Do two closed triangles share a point, zero-area ones included? The signs of at most eight orientations decide
/// (Devillers and Guigue, "Faster triangle-triangle intersection tests", INRIA RR-4488, 2002).
/// @tparam Signs how they are found: made from the lowest and the highest corner of a box that holds all points, with
/// `side`, `sides` and `turn` as `orientations` has them. The answer is exact where they are. One that may fail to find
/// a sign returns 0 and has `unsure()`, which is true from then on; what cannot be ruled out then counts as a hit.
template <class Signs>
class orientation_test {
public:
    template <class Real>
    [[nodiscard]] static inline bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        vec3d low;
        vec3d high;
        for (int k = 0; k < 3; ++k) {
            const auto [s_low, s_high] = range(s, k);
            const auto [t_low, t_high] = range(t, k);
            if (s_low > t_high || t_low > s_high) return false;
            low[k] = std::min(s_low, t_low);
            high[k] = std::max(s_high, t_high);
        }
        if (share_a_corner(s, t)) return true;
        Signs signs(low, high);
        return near_intersects(in_double(s), in_double(t), signs);
    }

private:
    using sides = std::array<int, 3>;

    template <class Real>
    [[nodiscard]] static std::pair<Real, Real> range(const triangle3<Real>& t, int axis) noexcept {
        return {std::min(std::min(t[0][axis], t[1][axis]), t[2][axis]),
                std::max(std::max(t[0][axis], t[1][axis]), t[2][axis])};
    }

    template <class Real>
    [[nodiscard]] static inline bool share_a_corner(const triangle3<Real>& s, const triangle3<Real>& t) noexcept {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (s[i] == t[j]) return true;
        return false;
    }

    /// The boxes of `s` and `t` overlap.
    [[nodiscard]] static inline bool near_intersects(const triangle3d& s, const triangle3d& t, Signs& signs) noexcept {
        const sides s_to_t = signs.sides(s, t);
        if (on_one_side(s_to_t)) return false;
        const sides t_to_s = signs.sides(t, s);
        if (on_one_side(t_to_s)) return false;
        const bool found = crossing_intersects(s, s_to_t, t, t_to_s, signs);
        if constexpr (requires { signs.unsure(); })
            return found || signs.unsure();
        else
            return found;
    }

    /// Neither triangle lies strictly on one side of the other's plane.
    [[nodiscard]] static inline bool crossing_intersects(const triangle3d& s, const sides& s_to_t, const triangle3d& t,
                                                         const sides& t_to_s, Signs& signs) noexcept {
        // All sides are zero when the planes are the same, or when the other triangle has no plane: zero area. A side
        // that is not zero proves that the other triangle has one.
        const bool s_on_t = s_to_t == sides{};
        const bool t_on_s = t_to_s == sides{};
        if (s_on_t && t_on_s) return flat_intersects(signs, s, t);
        if (t_on_s) return line_meets(signs, s, s_to_t, t);
        if (s_on_t) return line_meets(signs, t, t_to_s, s);
        return intervals_meet(signs, s, s_to_t, t, t_to_s);
    }

    [[nodiscard]] static inline bool on_one_side(const sides& d) noexcept {
        return (d[0] > 0 && d[1] > 0 && d[2] > 0) || (d[0] < 0 && d[1] < 0 && d[2] < 0);
    }

    /// The corner that the other plane cuts off from the two that follow it in the triangle's order, and whether it is
    /// cut off on the negative side.
    struct apex {
        std::uint8_t corner;
        bool negative;
    };

    /// By 9 d0 + 3 d1 + d2 + 13. An apex either lies off the plane, the others not on its side of it, or on the plane
    /// with the others off it on one side. Rows of sides that are all equal are not used.
    static constexpr std::array<apex, 27> apices = [] {
        std::array<apex, 27> rows{};
        for (int row = 0; row < 27; ++row) {
            const sides d{row / 9 - 1, row / 3 % 3 - 1, row % 3 - 1};
            for (std::size_t i = 0; i < 3; ++i)
                for (const int up : {1, -1}) {
                    const int own = up * d[i];
                    const int p = up * d[(i + 1) % 3];
                    const int q = up * d[(i + 2) % 3];
                    if ((own > 0 && p <= 0 && q <= 0) || (own == 0 && p < 0 && q < 0))
                        rows[static_cast<std::size_t>(row)] = {static_cast<std::uint8_t>(i), up < 0};
                }
        }
        return rows;
    }();

    [[nodiscard]] static inline apex apex_of(const sides& d) noexcept {
        return apices[static_cast<std::size_t>(9 * d[0] + 3 * d[1] + d[2] + 13)];
    }

    /// Both triangles cut the line in which their planes meet, each in an interval between the edges at its apex. With
    /// each triangle turned so that the other's apex lies above it, the intervals run against each other, and two
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
        return signs.side(s0, s1, t0, t1) <= 0 && signs.side(s0, s2, t0, t2) >= 0;
    }

    /// `s` has zero area and reaches the plane of `t`, which it crosses in one point: is that point in `t`?
    [[nodiscard]] static inline bool line_meets(Signs& signs, const triangle3d& s, const sides& s_to_t,
                                                const triangle3d& t) noexcept {
        const int other = s_to_t[0] != s_to_t[1] ? 1 : 2;
        bool left = false;
        bool right = false;
        for (int i = 0; i < 3; ++i) {
            const int passing = signs.side(s[0], s[other], t[i], t[(i + 1) % 3]);
            left |= passing > 0;
            right |= passing < 0;
        }
        return !(left && right);
    }

    /// Both lie in one plane, or both have zero area. Seen along an axis, two convex sets that are apart are separated
    /// by the line of an edge, or lie on one line, where their boxes would be apart. Apart in a view is apart; what
    /// meets in a view in which the common plane is not seen edge-on meets.
    [[nodiscard]] static inline bool flat_intersects(Signs& signs, const triangle3d& s, const triangle3d& t) noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            const int s_turn = signs.turn(s[0], s[1], s[2], axis);
            const int t_turn = signs.turn(t[0], t[1], t[2], axis);
            if (edge_separates(signs, s, s_turn, t, axis) || edge_separates(signs, t, t_turn, s, axis)) return false;
            if (s_turn != 0 || t_turn != 0) return true;
        }
        // Two segments or points that meet in all views: do they lie in one plane?
        const auto second = [](const triangle3d& of) { return of[1] == of[0] ? of[2] : of[1]; };
        return signs.side(s[0], second(s), t[0], second(t)) == 0;
    }

    /// Does the line of an edge of `s` have `s` on one side and `t` strictly on the other? `turn` is that of `s`.
    [[nodiscard]] static inline bool edge_separates(Signs& signs, const triangle3d& s, int turn, const triangle3d& t,
                                                    int axis) noexcept {
        for (int i = 0; i < 3; ++i) {
            const auto side = [&](int j) { return signs.turn(s[i], s[(i + 1) % 3], t[j], axis); };
            const int first = side(0);
            if (first != 0 && first != turn && side(1) == first && side(2) == first) return true;
        }
        return false;
    }
};

}  // namespace aabb
