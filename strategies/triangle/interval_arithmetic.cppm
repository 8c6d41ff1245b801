export module aabb.triangle.interval_arithmetic;

import aabb.local_detection;
import aabb.std;
import aabb.triangle.orientation_test;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb::detail {

/// An interval that contains the exact value. Rounding stays to nearest: ends move outward by at least the error.
struct interval {
    double low;
    double high;

    friend inline interval operator+(const interval& p, const interval& q) noexcept {
        return widened(p.low + q.low, p.high + q.high);
    }
    friend inline interval operator-(const interval& p, const interval& q) noexcept {
        return widened(p.low - q.high, p.high - q.low);
    }
    /// Encloses the products of all numbers in the two intervals.
    friend inline interval operator*(const interval& p, const interval& q) noexcept {
        if (p.is_zero() || q.is_zero()) return {0, 0};
        const double a = p.low * q.low;
        const double b = p.low * q.high;
        const double c = p.high * q.low;
        const double d = p.high * q.high;
        // After an overflow a product may be NaN, which `min` and `max` would hide.
        if (const double sum = a + b + c + d; std::isnan(sum)) return {sum, sum};
        constexpr double underflow = std::numeric_limits<double>::denorm_min();  // more than a denormal product's error
        return widened(std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d)), underflow);
    }
    [[nodiscard]] inline bool is_zero() const noexcept { return low == 0 && high == 0; }

private:
    /// Half a unit in the last place is at most half an epsilon of the result. Denormal sums are exact; a denormal
    /// product has an error of up to half the smallest denormal.
    [[nodiscard]] static inline interval widened(double low, double high, double underflow = 0) noexcept {
        const auto beyond = [&](double x) { return std::abs(x) * std::numeric_limits<double>::epsilon() + underflow; };
        return {low - beyond(low), high + beyond(high)};
    }
};

using interval3 = std::array<interval, 3>;

[[nodiscard]] inline interval3 operator-(const interval3& p, const interval3& q) noexcept {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
[[nodiscard]] inline interval3 cross(const interval3& p, const interval3& q) noexcept {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
[[nodiscard]] inline interval dot(const interval3& p, const interval3& q) noexcept {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/// Corners whose coordinates are doubles.
struct given_corners {
    given_corners(const triangle3d& s, const triangle3d& t, const lanes<double>&, const lanes<double>&) noexcept
        : s_(s), t_(t) {}

    [[nodiscard]] const triangle3d& s() const noexcept { return s_; }
    [[nodiscard]] const triangle3d& t() const noexcept { return t_; }
    [[nodiscard]] inline interval3 operator()(const vec3d& p) const noexcept {
        return {{{p[0], p[0]}, {p[1], p[1]}, {p[2], p[2]}}};
    }
    [[nodiscard]] int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
        return exact_side(a, b, c, d);
    }
    [[nodiscard]] int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
        return exact_turn(a, b, c, axis);
    }

private:
    const triangle3d& s_;
    const triangle3d& t_;
};

/// Corners R v + t of meshes at poses, whose coordinates are intervals; exact signs are those of `posed_orientations`.
struct posed_corners : posed_orientations {
    posed_corners(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept
        : posed_orientations(poses, s, t) {
        const auto in_world = [](const pose& p, const vec3d& v, std::size_t k) {
            const auto number = [](double x) { return interval{x, x}; };
            const double* const r = &p.rotation[3 * k];
            return number(r[0]) * number(v[0]) + number(r[1]) * number(v[1]) + number(r[2]) * number(v[2]) +
                   number(p.translation[static_cast<int>(k)]);
        };
        for (int i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                world_[static_cast<std::size_t>(i)][k] = in_world(poses.a, s[i], k);
                world_[static_cast<std::size_t>(3 + i)][k] = in_world(poses.b, t[i], k);
            }
    }

    [[nodiscard]] inline interval3 operator()(const vec3d& p) const noexcept {
        return world_[static_cast<std::size_t>(index_of(p))];
    }

private:
    std::array<interval3, 6> world_{};
};

/// Signs by interval arithmetic.
/// @tparam Corners the corners as intervals, with the exact signs
/// @tparam Exact whether an undecided sign is computed exactly
template <class Corners, bool Exact>
class interval_signs {
public:
    template <class... Given>
    explicit interval_signs(const Given&... given) noexcept : corners_(given...) {}

    [[nodiscard]] const triangle3d& s() const noexcept { return corners_.s(); }
    [[nodiscard]] const triangle3d& t() const noexcept { return corners_.t(); }
    [[nodiscard]] bool are_apart() const noexcept { return corners_.are_apart(); }
    [[nodiscard]] bool are_equal(const vec3d& p, const vec3d& q) const noexcept
        requires requires(Corners corners) { corners.are_equal(p, q); }
    {
        return corners_.are_equal(p, q);
    }
    [[nodiscard]] bool boxes_are_disjoint() noexcept
        requires requires(Corners corners) { corners.boxes_are_disjoint(); }
    {
        return corners_.boxes_are_disjoint();
    }

    [[nodiscard]] inline bool part(corner_sides& s_to_t, corner_sides& t_to_s) noexcept {
        s_to_t = sides(s(), t());
        if (s_to_t.on_one_side()) return true;
        t_to_s = sides(t(), s());
        return t_to_s.on_one_side();
    }

    [[nodiscard]] inline int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
        const interval3 origin = corners_(a);
        return sign(dot(cross(corners_(b) - origin, corners_(c) - origin), corners_(d) - origin),
                    [&] { return corners_.side(a, b, c, d); });
    }
    [[nodiscard]] inline int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
        const auto x = static_cast<std::size_t>((axis + 1) % 3), y = static_cast<std::size_t>((axis + 2) % 3);
        const interval3 p = corners_(b) - corners_(a), q = corners_(c) - corners_(a);
        return sign(p[x] * q[y] - p[y] * q[x], [&] { return corners_.turn(a, b, c, axis); });
    }

    [[nodiscard]] inline bool in_order(const vec3d& s0, const vec3d& s1, const vec3d& s2, const vec3d& t0,
                                       const vec3d& t1, const vec3d& t2) noexcept {
        return side(s0, s1, t0, t1) <= 0 && side(s0, s2, t0, t2) >= 0;
    }
    [[nodiscard]] inline bool beyond(const vec3d& a, const vec3d& b, int own, const triangle3d& t, int axis) noexcept {
        const int first = turn(a, b, t[0], axis);
        return first != 0 && first != own && turn(a, b, t[1], axis) == first && turn(a, b, t[2], axis) == first;
    }

    [[nodiscard]] inline bool unsure() const noexcept { return unsure_; }

private:
    /// The sides of the plane of `t` on which the corners of `s` lie.
    [[nodiscard]] inline corner_sides sides(const triangle3d& s, const triangle3d& t) noexcept {
        const interval3 origin = corners_(t[0]);
        const interval3 normal = cross(corners_(t[1]) - origin, corners_(t[2]) - origin);
        const auto of = [&](const vec3d& p) {
            return sign(dot(normal, corners_(p) - origin), [&] { return corners_.side(t[0], t[1], t[2], p); });
        };
        // Braced lists are evaluated from left to right.
        return corner_sides(std::array{of(s[0]), of(s[1]), of(s[2])});
    }

    /// The sign of all numbers in the interval. If they differ, the exact sign; without `Exact` 0, from then on unsure.
    template <class Compute>
    [[nodiscard]] inline int sign(const interval& value, Compute compute_exactly) noexcept {
        if (value.low > 0) return 1;
        if (value.high < 0) return -1;
        if (value.is_zero()) return 0;
        if constexpr (Exact)
            return compute_exactly();
        else
            unsure_ = true;
        return 0;
    }

    Corners corners_;
    bool unsure_ = false;
};

}  // namespace aabb::detail

export namespace aabb {

/// The fallback if an interval contains zero, so that the sign is undecided.
enum class fallback_choice : std::uint8_t {
    exact,      ///< the sign is computed exactly
    intersects  ///< the triangles count as intersecting
};

/// `orientation_test` with signs by interval arithmetic, which needs no error bound derived by hand. It is exact with
/// `fallback=exact`; with `fallback=intersects` it has no false negatives, but false positives where rounding leaves a
/// near miss undecided. When to use: to compare the cost of a dynamic and a semi-static filter; as a conservative test.
class interval_arithmetic_triangle {
public:
    static constexpr std::string_view name = "interval_arithmetic";
    static constexpr std::string_view summary =
        "orientation signs by interval arithmetic: exact, or with false positives but no false negatives";

    struct config {
        fallback_choice fallback = fallback_choice::exact;

        [[nodiscard]] constexpr bool is_exact() const noexcept { return fallback == fallback_choice::exact; }
    };
    static constexpr std::tuple parameters{
        choice_parameter{"fallback", &config::fallback, std::array<std::string_view, 2>{"exact", "intersects"},
                         "result if an interval contains zero: the exact sign, or that the triangles intersect"}};

    interval_arithmetic_triangle() = default;
    explicit interval_arithmetic_triangle(const config& c) : fallback_(c.fallback) {}

    template <class Real>
    [[nodiscard]] inline bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) const noexcept {
        return intersect_by<detail::given_corners>(s, t);
    }
    /// The same at poses, as they are given.
    [[nodiscard]] bool intersects(const pose_pair& poses, const triangle3d& s, const triangle3d& t) const noexcept {
        return intersect_by<detail::posed_corners>(poses, s, t);
    }

private:
    template <class Corners, class... Given>
    [[nodiscard]] inline bool intersect_by(const Given&... given) const noexcept {
        if (fallback_ == fallback_choice::exact)
            return orientation_test<detail::interval_signs<Corners, true>>::intersects(given...);
        return orientation_test<detail::interval_signs<Corners, false>>::intersects(given...);
    }

    fallback_choice fallback_ = fallback_choice::exact;
};

static_assert(DoubleTrianglePolicy<interval_arithmetic_triangle> && PosedTrianglePolicy<interval_arithmetic_triangle>);

}  // namespace aabb
