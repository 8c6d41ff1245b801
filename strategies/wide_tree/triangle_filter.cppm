export module aabb.wide_tree.triangle_filter;

import aabb.geometry;
import aabb.simd;
import aabb.std;

#pragma clang fp reassociate(off) reciprocal(off)  // fused multiply-adds are allowed: error bounds include them

export namespace aabb {

/// Two masks of pairs: those that intersect, and those that the filter cannot decide.
struct filtered_pairs {
    std::uint32_t hits;
    std::uint32_t undecided;
};

/// A floating-point filter: tests one vector of pairs of triangles in float and leaves those to an exact test whose
/// signs rounding could change. The signs of eight orientations decide (Devillers and Guigue, "Faster triangle-triangle
/// intersection tests", INRIA RR-4488, 2002). Triangles with a common corner are hits.
///
/// The error of a determinant is that of `determinant_errors`, with u = 2^-24 and the extents X, Y and Z, which are
/// enlarged by 16 u: then the product of two overflows before a component of a normal does, so that the error is
/// infinite or NaN and the pair stays undecided. Underflow adds at most 20 times 2^-150 of a factor X, Y, Z or 1.
class triangle_filter {
public:
    /// Decides pairs by the signs of eight orientations: the corners of each triangle against the plane of the other,
    /// and two pairs of edges. Pairs with a sign that rounding could change stay undecided.
    /// @param a,b the first of nine rows at a distance of `stride`: row 3 c + k has axis k of corner c
    /// @param error_of_b how far, along each axis, a corner of B may be from its place
    [[nodiscard]] static inline filtered_pairs decide(const float* a, const float* b, std::size_t stride,
                                                      const float* error_of_b) noexcept {
#pragma clang fp contract(fast)
        corners s = load(a, stride);
        corners t = load(b, stride);
        const float e = error_of_b[0], f = error_of_b[1], g = error_of_b[2];
        const simd::floats x = (extent_of(s, t, 0) + 2 * e) * (1 + 0x1p-20F);
        const simd::floats y = (extent_of(s, t, 1) + 2 * f) * (1 + 0x1p-20F);
        const simd::floats z = (extent_of(s, t, 2) + 2 * g) * (1 + 0x1p-20F);
        constexpr auto rounding = static_cast<float>(determinant_errors::rounding_of_side * 0x1p-24);
        constexpr auto displacement = static_cast<float>(determinant_errors::displacement_of_side);
        const error_bound error(rounding * (x * y * z) + displacement * (e * (y * z) + f * (x * z) + g * (x * y)) +
                                0x1p-140F * (x + y + z + 1));

        const point s_normal = cross(s[1] - s[0], s[2] - s[0]);
        const sides of_t =
            error.signs_of(dot(s_normal, t[0] - s[0]), dot(s_normal, t[1] - s[0]), dot(s_normal, t[2] - s[0]));
        const point t_normal = cross(t[1] - t[0], t[2] - t[0]);
        const sides of_s =
            error.signs_of(dot(t_normal, s[0] - t[0]), dot(t_normal, s[1] - t[0]), dot(t_normal, s[2] - t[0]));
        const simd::flags separated = of_t.all_above() | of_t.all_below() | of_s.all_above() | of_s.all_below();
        const simd::flags certain = of_t.certain() & of_s.certain();

        const simd::flags t_apex_above = rotate_to_apex(t, of_t.above);
        const simd::flags s_apex_above = rotate_to_apex(s, of_s.above);
        // Reorders corners so that each apex lies above the other triangle.
        swap_where(~s_apex_above, t[1], t[2]);
        swap_where(~t_apex_above, s[1], s[2]);
        const point between = t[0] - s[0];
        const simd::floats first = dot(cross(s[1] - s[0], between), t[1] - s[0]);
        const simd::floats second = dot(cross(s[2] - s[0], t[2] - s[0]), between);
        const simd::flags beyond = error.above(first) | error.above(second);
        const simd::flags crossing = error.below(first) & error.below(second);
        const std::uint32_t hits = simd::bits(~separated & certain & crossing);
        const std::uint32_t undecided = simd::bits(~separated & ~(certain & (beyond | crossing)));
        // Corners that are equal only as rounded need not be the same point.
        if (undecided == 0 || e + f + g > 0) return {.hits = hits, .undecided = undecided};
        const std::uint32_t touching = undecided & simd::bits(share_corner(s, t));
        return {.hits = hits | touching, .undecided = undecided & ~touching};
    }

private:
    struct point {
        std::array<simd::floats, 3> at;

        [[gnu::always_inline]] friend inline point operator-(const point& p, const point& q) noexcept {
            return {{p.at[0] - q.at[0], p.at[1] - q.at[1], p.at[2] - q.at[2]}};
        }
    };
    using corners = std::array<point, 3>;

    /// The certain signs of three orientations.
    struct sides {
        std::array<simd::flags, 3> above;
        std::array<simd::flags, 3> below;

        [[nodiscard, gnu::always_inline]] inline simd::flags all_above() const noexcept {
            return above[0] & above[1] & above[2];
        }
        [[nodiscard, gnu::always_inline]] inline simd::flags all_below() const noexcept {
            return below[0] & below[1] & below[2];
        }
        [[nodiscard, gnu::always_inline]] inline simd::flags certain() const noexcept {
            return (above[0] | below[0]) & (above[1] | below[1]) & (above[2] | below[2]);
        }
    };

    /// A bound of the rounding error: signs of greater magnitudes are certain.
    class error_bound {
    public:
        explicit inline error_bound(simd::floats most) noexcept : most_(most) {}
        [[nodiscard, gnu::always_inline]] inline simd::flags above(simd::floats v) const noexcept { return v > most_; }
        [[nodiscard, gnu::always_inline]] inline simd::flags below(simd::floats v) const noexcept { return v < -most_; }
        [[nodiscard, gnu::always_inline]] inline sides signs_of(simd::floats p, simd::floats q,
                                                                simd::floats r) const noexcept {
            return {{above(p), above(q), above(r)}, {below(p), below(q), below(r)}};
        }

    private:
        simd::floats most_;
    };

    [[nodiscard, gnu::always_inline]] static inline corners load(const float* from, std::size_t stride) noexcept {
        corners t;
        for (std::size_t row = 0; row < 9; ++row)
            std::memcpy(&t[row / 3].at[row % 3], from + row * stride, sizeof(simd::floats));
        return t;
    }

    [[nodiscard, gnu::always_inline]] static inline point cross(const point& p, const point& q) noexcept {
#pragma clang fp contract(fast)
        return {{p.at[1] * q.at[2] - p.at[2] * q.at[1], p.at[2] * q.at[0] - p.at[0] * q.at[2],
                 p.at[0] * q.at[1] - p.at[1] * q.at[0]}};
    }
    [[nodiscard, gnu::always_inline]] static inline simd::floats dot(const point& p, const point& q) noexcept {
#pragma clang fp contract(fast)
        return p.at[0] * q.at[0] + p.at[1] * q.at[1] + p.at[2] * q.at[2];
    }

    /// Adjacent triangles of a mesh share a corner and therefore intersect.
    [[nodiscard, gnu::always_inline]] static inline simd::flags share_corner(const corners& s,
                                                                             const corners& t) noexcept {
        simd::flags any{};
        for (const point& p : s)
            for (const point& q : t) any |= (p.at[0] == q.at[0]) & (p.at[1] == q.at[1]) & (p.at[2] == q.at[2]);
        return any;
    }

    /// The extent of both triangles together on axis k, which bounds the differences of their coordinates.
    [[nodiscard, gnu::always_inline]] static inline simd::floats extent_of(const corners& s, const corners& t,
                                                                           std::size_t k) noexcept {
        const auto lesser = [](simd::floats p, simd::floats q) { return p < q ? p : q; };
        const auto greater = [](simd::floats p, simd::floats q) { return p > q ? p : q; };
        const simd::floats low = lesser(lesser(lesser(s[0].at[k], s[1].at[k]), lesser(s[2].at[k], t[0].at[k])),
                                        lesser(t[1].at[k], t[2].at[k]));
        const simd::floats high = greater(greater(greater(s[0].at[k], s[1].at[k]), greater(s[2].at[k], t[0].at[k])),
                                          greater(t[1].at[k], t[2].at[k]));
        return high - low;
    }

    [[nodiscard, gnu::always_inline]] static inline point select(simd::flags mask, const point& p,
                                                                 const point& q) noexcept {
        return {{mask ? p.at[0] : q.at[0], mask ? p.at[1] : q.at[1], mask ? p.at[2] : q.at[2]}};
    }
    [[gnu::always_inline]] static inline void swap_where(simd::flags mask, point& p, point& q) noexcept {
        const point before = p;
        p = select(mask, q, p);
        q = select(mask, before, q);
    }

    /// Rotates the triangle until corner 0, its apex, is alone on its side of the other's plane.
    /// @returns whether it is above
    [[nodiscard, gnu::always_inline]] static inline simd::flags rotate_to_apex(
        corners& t, const std::array<simd::flags, 3>& above) noexcept {
        const simd::flags is_1 = (above[0] ^ above[1]) & ~(above[0] ^ above[2]);
        const simd::flags is_2 = ~(above[0] ^ above[1]) & (above[0] ^ above[2]);
        const corners before = t;
        for (std::size_t c = 0; c < 3; ++c)
            t[c] = select(is_2, before[(c + 2) % 3], select(is_1, before[(c + 1) % 3], before[c]));
        return is_2 ? above[2] : is_1 ? above[1] : above[0];
    }
};

}  // namespace aabb
