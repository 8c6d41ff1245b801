/// Nearest points of two triangles in rounded arithmetic, and bounds of their distance that are certain.
export module aabb.distance.rounded_triangles;

export import aabb.geometry;
import aabb.simd;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb::detail {

// A comparison of doubles is one bit, one of eight doubles has a bit per lane.
[[nodiscard]] inline std::uint32_t bits_where(bool holds) noexcept {
    return holds ? 1 : 0;
}
template <class Flags>
[[nodiscard]] inline std::uint32_t bits_where(Flags flags) noexcept {
    return simd::bits_of_eight(flags);
}

}  // namespace aabb::detail

export namespace aabb {

/// Points of two triangles, and directions in which to separate these: along the segment between the points, and along
/// the normal of the features on which they lie.
template <class Number>
struct near_points {
    vec3<Number> p{}, q{};
    vec3<Number> normal{};  ///< n = u × v of two edges, or of the face's edges; 0 for a corner and an edge
    Number squared = Number{} + std::numeric_limits<double>::infinity();  ///< of the distance between the points

    /// Replaces the points by nearer ones; NaN is never nearer.
    /// @param excluded infinite where the points do not count, else 0
    inline void take(const vec3<Number>& of_s, const vec3<Number>& of_t, const vec3<Number>& of_features,
                     const Number& excluded) noexcept {
        const vec3<Number> between = of_s - of_t;
        const Number length = dot(between, between) + excluded;
        const auto is_nearer = length < squared;
        for (int k = 0; k < 3; ++k) {
            p[k] = is_nearer ? of_s[k] : p[k];
            q[k] = is_nearer ? of_t[k] : q[k];
            normal[k] = is_nearer ? of_features[k] : normal[k];
        }
        squared = is_nearer ? length : squared;
    }
};

/// Two triangles of meshes at poses, or eight pairs of triangles, rounded to double relative to a corner of the first.
/// Whatever the nearest points are that rounded arithmetic yields, two facts about them bound the true distance D, and
/// no algorithm that is less accurate makes the bounds wrong:
/// - Two points of the triangles are no nearer than D: D <= |p - q|.
/// - For any direction n, D >= h / |n|, where h is the least n·a over the corners a of one triangle, minus the
///   greatest n·b over those of the other.
///
/// Errors, with u = 2^-53: Let W be the sum, over the axes, of the greatest magnitude of a rounded coordinate, and E
/// that of the error bounds of coordinates in the world (0 for vertices without poses). A coordinate relative to a
/// corner is rounded once more, by u of itself. Points that move by at most u W + E move each triangle, and thus D, by
/// as much: 2 u W + 2 E for both. (That the corner is rounded itself moves both triangles alike.)
/// - Upper bound: p = a + β b + γ c, for rounded edges b, c, is off by at most 6 u of the greatest coordinate on each
///   axis (two for the edges, two for the products, one for each sum), and β + γ <= 1 by u, which is 2 u more: 8 u W,
///   and 16 u W for both points. Their difference, and the length of that, round by 4 u of at most 2 W. In all 26 u W.
/// - Lower bound: each product n·a is off by 3 u |n| W, two by 6 u |n| W, and their difference rounds by 2 u |n| W. The
///   length and the quotient round by 4 u of at most 2 W: 16 u W, and 18 u W with the above.
/// 32 u W + 2.25 E covers both, the rounding of a sum with it, and terms of second order. W between 2^-200 and 2^200,
/// and directions with a component of at least 2^-450, keep underflow, below 2^-1070 in a product, far below u W |n|;
/// what overflows is infinite or NaN, and decides nothing.
/// @tparam Number double, or a vector of eight doubles, one per pair
template <class Number>
class rounded_pairs {
public:
    rounded_pairs(const pose_pair& poses, const triangle3<Number>& s, const triangle3<Number>& t) noexcept {
        if (poses.a == pose{} && poses.b == pose{}) {
            s_ = s;
            t_ = t;
            subtract_origin(/*error=*/Number{});
            return;
        }
        vec3<Number> magnitudes{};
        const vec3d between = poses.b.translation - poses.a.translation;
        for (int i = 0; i < 3; ++i) {
            s_[i] = placed(poses.a, {}, s[i], magnitudes);
            t_[i] = placed(poses.b, between, t[i], magnitudes);
        }
        subtract_origin(4.25 * unit * (magnitudes[0] + magnitudes[1] + magnitudes[2]) + 0x1p-1068);
    }

    /// Pairs whose distance is certainly at most d, and pairs whose distance is certainly greater: a bit per pair.
    struct decision {
        std::uint32_t within;
        std::uint32_t farther;
    };
    [[nodiscard]] decision decide(double d) const noexcept {
        // Most triangles that are farther are so by their boxes, or seen along the normal of either, and many that are
        // not are so by their corners.
        std::uint32_t open = in_range_ & ~detail::bits_where(gap_of_boxes() - tolerance_ > d);
        for (const triangle3<Number>* const of : {&s_, &t_})
            if (open != 0) open &= ~are_beyond(cross((*of)[1] - (*of)[0], (*of)[2] - (*of)[0]), d);
        std::uint32_t within = 0;
        if (open != 0) within = open & detail::bits_where(distance_of_corners() + tolerance_ <= d);
        open &= ~within;
        if (open != 0) {
            const near_points<Number> nearest = nearest_points();
            within |= open & detail::bits_where(upper_bound(nearest) <= d);
            open &= ~within;
            if (open != 0) open &= ~(are_beyond(nearest.p - nearest.q, d) | are_beyond(nearest.normal, d));
        }
        return {.within = within, .farther = in_range_ & ~(within | open)};
    }

    /// Whether the distance of the only pair is at most d; nothing if rounding could change the result.
    [[nodiscard]] std::optional<bool> are_within(double d) const noexcept
        requires std::same_as<Number, double>
    {
        const auto [within, farther] = decide(d);
        return (within | farther) != 0 ? std::optional(within != 0) : std::nullopt;
    }

    /// False if numbers are so large or small that the bounds could be wrong.
    [[nodiscard]] bool in_range() const noexcept { return in_range_ != 0; }

    /// The bounds; `lower_bound` is negative if the direction separates nothing.
    [[nodiscard]] inline Number upper_bound(const near_points<Number>& nearest) const noexcept {
        return __builtin_elementwise_sqrt(nearest.squared) + tolerance_;
    }
    [[nodiscard]] inline Number lower_bound(const vec3<Number>& direction) const noexcept {
        const Number greatest =
            greater(greater(magnitude(direction[0]), magnitude(direction[1])), magnitude(direction[2]));
        const range along_s = range_along(s_, direction), along_t = range_along(t_, direction);
        const Number gap = greater(along_s.low - along_t.high, along_t.low - along_s.high);
        const Number bound = gap / __builtin_elementwise_sqrt(dot(direction, direction)) - tolerance_;
        return greatest >= 0x1p-450 ? bound : Number{} - 1.0;
    }

    /// The nearest points, up to rounding, of triangles that are disjoint: those of two edges, or of a corner and a
    /// face. Of triangles that intersect, some points.
    [[nodiscard]] inline near_points<Number> nearest_points() const noexcept {
        near_points<Number> nearest{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) of_edges({s_[i], s_[(i + 1) % 3]}, {t_[j], t_[(j + 1) % 3]}, nearest);
        for (int i = 0; i < 3; ++i) {
            of_corner_and_face(s_[i], t_, /*corner_is_of_s=*/true, nearest);
            of_corner_and_face(t_[i], s_, /*corner_is_of_s=*/false, nearest);
        }
        return nearest;
    }

    /// What coordinates are relative to, in the world: this point, and with poses the translation of the first besides.
    [[nodiscard]] const vec3<Number>& origin() const noexcept { return origin_; }
    [[nodiscard]] const Number& tolerance() const noexcept { return tolerance_; }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    struct edge {
        const vec3<Number>& from;
        const vec3<Number>& to;
    };
    struct range {
        Number low, high;
    };

    [[nodiscard]] static inline Number magnitude(const Number& x) noexcept { return __builtin_elementwise_abs(x); }
    [[nodiscard]] static inline Number lesser(const Number& x, const Number& y) noexcept {
        return __builtin_elementwise_min(x, y);
    }
    [[nodiscard]] static inline Number greater(const Number& x, const Number& y) noexcept {
        return __builtin_elementwise_max(x, y);
    }

    /// R v + t in double. Errors of coordinates are bounded as derived for `posed_orientations`.
    /// @param magnitudes raised to the sum of the terms' magnitudes on each axis
    [[nodiscard]] static inline vec3<Number> placed(const pose& at, const vec3d& translation, const vec3<Number>& v,
                                                    vec3<Number>& magnitudes) noexcept {
        vec3<Number> world{};
        for (int k = 0; k < 3; ++k) {
            const auto row = static_cast<std::size_t>(3 * k);
            const Number x = at.rotation[row] * v[0], y = at.rotation[row + 1] * v[1], z = at.rotation[row + 2] * v[2];
            world[k] = x + y + z + translation[k];
            magnitudes[k] =
                greater(magnitudes[k], magnitude(x) + magnitude(y) + magnitude(z) + std::abs(translation[k]));
        }
        return world;
    }

    /// Makes coordinates relative to a corner.
    /// @param error bounds that of a corner, summed over the axes
    inline void subtract_origin(const Number& error) noexcept {
        origin_ = s_[0];
        Number width{};
        for (int k = 0; k < 3; ++k) {
            Number greatest{};
            for (int i = 0; i < 3; ++i) {
                s_[i][k] -= origin_[k];
                t_[i][k] -= origin_[k];
                greatest = greater(greatest, greater(magnitude(s_[i][k]), magnitude(t_[i][k])));
            }
            width += greatest;
        }
        tolerance_ = 32 * unit * width + 2.25 * error;
        // After an overflow of a coordinate, its error bound is infinite; without poses, `width` is, or is NaN.
        in_range_ = detail::bits_where(width >= 0x1p-200) & detail::bits_where(width <= 0x1p200) &
                    detail::bits_where(tolerance_ <= 0x1p200);
    }

    /// Pairs whose distance is more than d, as seen along a direction.
    [[nodiscard]] inline std::uint32_t are_beyond(const vec3<Number>& direction, double d) const noexcept {
        return detail::bits_where(lower_bound(direction) > d);
    }

    /// The distance of the triangles' boxes, with errors as `lower_bound` has them.
    [[nodiscard]] inline Number gap_of_boxes() const noexcept {
        Number sum{};
        for (int k = 0; k < 3; ++k) {
            const Number s_low = lesser(lesser(s_[0][k], s_[1][k]), s_[2][k]);
            const Number t_low = lesser(lesser(t_[0][k], t_[1][k]), t_[2][k]);
            const Number s_high = greater(greater(s_[0][k], s_[1][k]), s_[2][k]);
            const Number t_high = greater(greater(t_[0][k], t_[1][k]), t_[2][k]);
            const Number gap = greater(Number{}, greater(s_low - t_high, t_low - s_high));
            sum += gap * gap;
        }
        return __builtin_elementwise_sqrt(sum);
    }

    /// The least distance of two corners.
    [[nodiscard]] inline Number distance_of_corners() const noexcept {
        Number least = Number{} + std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const vec3<Number> between = s_[i] - t_[j];
                least = lesser(least, dot(between, between));
            }
        return __builtin_elementwise_sqrt(least);
    }

    [[nodiscard]] static inline range range_along(const triangle3<Number>& t, const vec3<Number>& direction) noexcept {
        const Number x = dot(direction, t[0]), y = dot(direction, t[1]), z = dot(direction, t[2]);
        return {.low = lesser(lesser(x, y), z), .high = greater(greater(x, y), z)};
    }

    [[nodiscard]] static inline vec3<Number> along(const vec3<Number>& from, const vec3<Number>& by,
                                                   const Number& factor) noexcept {
        return {from[0] + by[0] * factor, from[1] + by[1] * factor, from[2] + by[2] * factor};
    }

    /// A number from 0 to 1; 0 for NaN.
    [[nodiscard]] static inline Number clamped(const Number& x) noexcept {
        return x > 0.0 ? lesser(x, Number{} + 1.0) : Number{};
    }

    /// The nearest points of two edges: those of their lines, clamped to one edge and then to the other (Ericson,
    /// "Real-time collision detection", 2005, section 5.1.9).
    static inline void of_edges(const edge& e, const edge& f, near_points<Number>& nearest) noexcept {
        const vec3<Number> u = e.to - e.from, v = f.to - f.from, w = f.from - e.from;
        const Number uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
        const Number determinant = uu * vv - uv * uv;
        const Number of_e = clamped(determinant > 0.0 ? (uw * vv - vw * uv) / determinant : Number{});
        const Number of_f = vv > 0.0 ? (of_e * uv - vw) / vv : Number{};
        const Number end_of_f = clamped(of_f);
        const Number beside_end = clamped(uu > 0.0 ? (end_of_f * uv + uw) / uu : Number{});
        nearest.take(along(e.from, u, of_f == end_of_f ? of_e : beside_end), along(f.from, v, end_of_f), cross(u, v),
                     /*excluded=*/Number{});
    }

    /// The projection of a corner to the other triangle's plane, if it lies in that triangle.
    static inline void of_corner_and_face(const vec3<Number>& corner, const triangle3<Number>& face,
                                          bool corner_is_of_s, near_points<Number>& nearest) noexcept {
        const vec3<Number> u = face[1] - face[0], v = face[2] - face[0], w = corner - face[0];
        const vec3<Number> n = cross(u, v);
        const Number square = dot(n, n);
        const Number of_u = dot(cross(w, v), n) / square, of_v = dot(cross(u, w), n) / square;
        // Points of a face without area are infinite or NaN, and never nearer.
        const Number least = lesser(lesser(of_u, of_v), 1.0 - (of_u + of_v));
        const Number excluded = least >= 0.0 ? Number{} : Number{} + std::numeric_limits<double>::infinity();
        const vec3<Number> projection = along(along(face[0], u, of_u), v, of_v);
        corner_is_of_s ? nearest.take(corner, projection, n, excluded) : nearest.take(projection, corner, n, excluded);
    }

    triangle3<Number> s_{}, t_{};  // relative to `origin_`
    vec3<Number> origin_{};
    Number tolerance_{};
    std::uint32_t in_range_ = 0;  // a bit per pair
};

using rounded_triangles = rounded_pairs<double>;

}  // namespace aabb
