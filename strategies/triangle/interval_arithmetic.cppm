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

    /// Encloses p - q.
    [[nodiscard]] static inline interval difference(double p, double q) noexcept { return widened(p - q, p - q); }

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

[[nodiscard]] inline interval3 difference(const vec3d& p, const vec3d& q) noexcept {
    return {interval::difference(p[0], q[0]), interval::difference(p[1], q[1]), interval::difference(p[2], q[2])};
}
[[nodiscard]] inline interval3 cross(const interval3& p, const interval3& q) noexcept {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
[[nodiscard]] inline interval dot(const interval3& p, const interval3& q) noexcept {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/// Signs by interval arithmetic.
/// @tparam Exact whether an undecided sign is computed exactly
template <bool Exact>
class interval_signs {
public:
    interval_signs(const triangle3d& s, const triangle3d& t, const lanes<double>&, const lanes<double>&) noexcept
        : s_(s), t_(t) {}

    [[nodiscard]] inline bool part(corner_sides& s_to_t, corner_sides& t_to_s) noexcept {
        s_to_t = sides(s_, t_);
        if (s_to_t.on_one_side()) return true;
        t_to_s = sides(t_, s_);
        return t_to_s.on_one_side();
    }

    [[nodiscard]] inline int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
        return sign(dot(cross(difference(b, a), difference(c, a)), difference(d, a)),
                    [&] { return exact_side(a, b, c, d); });
    }
    [[nodiscard]] inline int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const auto across = [](const vec3d& p, const vec3d& q, int k) { return interval::difference(p[k], q[k]); };
        return sign(across(b, a, x) * across(c, a, y) - across(b, a, y) * across(c, a, x),
                    [&] { return exact_turn(a, b, c, axis); });
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
        const interval3 normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
        const auto of = [&](const vec3d& p) {
            return sign(dot(normal, difference(p, t[0])), [&] { return exact_side(t[0], t[1], t[2], p); });
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

    const triangle3d& s_;
    const triangle3d& t_;
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
        if (fallback_ == fallback_choice::exact)
            return orientation_test<detail::interval_signs<true>>::intersects(s, t);
        return orientation_test<detail::interval_signs<false>>::intersects(s, t);
    }

private:
    fallback_choice fallback_ = fallback_choice::exact;
};

static_assert(DoubleTrianglePolicy<interval_arithmetic_triangle>);

}  // namespace aabb
