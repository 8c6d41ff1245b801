module;
#include <array>
#include <limits>

/// Signs of orientations of points, exact for any finite doubles: −0, denormals, the largest and the smallest together;
/// in the arithmetic that `require_ieee_arithmetic` accepts.
export module aabb.geometry:predicates;

import :triangle;
import :vec3;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// Sign (-1, 0, 1) of det(b - a, c - a, d - a): the side of the plane through a, b and c on which d lies. Zero when the
/// four lie in one plane. Slow; `orientations` asks it when rounded arithmetic cannot tell.
[[nodiscard]] int exact_side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept;

/// Sign of the component `axis` of (b - a) × (c - a): the way that a, b, c turn when seen along that axis.
[[nodiscard]] int exact_turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept;

/// A number whose exponent may lie beyond that of a double: mantissa 2^exponent, |mantissa| in [1/2, 1), or both 0.
struct scaled_double {
    double mantissa;
    int exponent;
};

/// The determinant of `exact_side`, and the component of `exact_turn`, within 1.001 · 2^-53 of their value.
[[nodiscard]] scaled_double exact_volume(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept;
[[nodiscard]] scaled_double exact_area(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept;

/// The same signs, fast, for points that lie in one box: computed in double, and again exactly where the result lies
/// within its own rounding error. The bound of that error is one number for the whole box (a semi-static filter, Meyer
/// and Pion, "FPG: a code generator for fast and certified geometric predicates", 2008).
///
/// Bounds, with u = 2^-53 and E the extent of the box on an axis. A difference of coordinates is at most E and carries
/// one rounding, a factor (1 + δ) with |δ| <= u, even where the coordinates were floats.
/// - Turn, two terms: each carries the roundings of two differences, a product and the last subtraction. The error is
///   at most 2 ((1 + u)^4 - 1) E E, below 8.1 u E E.
/// - Side, six terms: four roundings as above; one for the third difference, one for the product with it, at most two
///   for the sum of three: 6 ((1 + u)^8 - 1) E E E, below 48.1 u E E E.
/// E itself and the products of the bound are rounded at most six times: less than 0.9 u more. Extents between 2^-200
/// and 2^200 keep overflow away, and what underflow can add, less than 2^-870, is far below u E E E >= 2^-653: one more
/// u. Other extents make the bound infinite or NaN, so that everything is computed exactly; floats never get there. An
/// extent of zero makes the bound zero, and the computed zero is exact.
class orientations {
public:
    /// All points asked for lie in the closed box from `low` to `high`.
    constexpr orientations(const vec3d& low, const vec3d& high) noexcept : extent_(high - low) {
        for (int k = 0; k < 3; ++k)
            if (extent_[k] != 0 && !(extent_[k] >= 0x1p-200 && extent_[k] <= 0x1p200))
                extent_[k] = std::numeric_limits<double>::infinity();
        side_error_ = 50 * unit * extent_[0] * extent_[1] * extent_[2];
    }

    /// As `exact_side`.
    [[nodiscard]] inline int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) const noexcept {
        const int sign = certain_sign(dot(cross(b - a, c - a), d - a), side_error_);
        return sign != 0 || side_error_ == 0 ? sign : exact_side(a, b, c, d);
    }

    /// The sides of the plane of `t` on which the corners of `s` lie.
    [[nodiscard]] inline std::array<int, 3> sides(const triangle3d& s, const triangle3d& t) const noexcept {
        const vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
        const int first = certain_sign(dot(normal, s[0] - t[0]), side_error_);
        const int second = certain_sign(dot(normal, s[1] - t[0]), side_error_);
        const int third = certain_sign(dot(normal, s[2] - t[0]), side_error_);
        if (first * second * third != 0 || side_error_ == 0) return {first, second, third};
        return {first != 0 ? first : exact_side(t[0], t[1], t[2], s[0]),
                second != 0 ? second : exact_side(t[0], t[1], t[2], s[1]),
                third != 0 ? third : exact_side(t[0], t[1], t[2], s[2])};
    }

    /// As `exact_turn`.
    [[nodiscard]] inline int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) const noexcept {
        const int x = (axis + 1) % 3;
        const int y = (axis + 2) % 3;
        const double computed = (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
        const double error = 10 * unit * extent_[x] * extent_[y];
        const int sign = certain_sign(computed, error);
        return sign != 0 || error == 0 ? sign : exact_turn(a, b, c, axis);
    }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    /// Zero where the error may be larger. Without branches: signs cannot be predicted.
    [[nodiscard]] static inline int certain_sign(double computed, double error) noexcept {
        return static_cast<int>(computed > error) - static_cast<int>(computed < -error);
    }

    vec3d extent_;
    double side_error_;
};

}  // namespace aabb
