/// Exact orientation predicates for all finite doubles, including −0, denormals and mixed magnitudes, in the arithmetic
/// that `require_ieee_arithmetic` accepts.
export module aabb.geometry:predicates;

import aabb.std;
import :points;
import :product_sum;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The sides of a plane on which the corners of a triangle lie; bit i stands for corner i.
struct corner_sides {
    unsigned above = 0;  ///< positive
    unsigned below = 0;  ///< negative

    constexpr corner_sides() = default;
    constexpr corner_sides(unsigned positive, unsigned negative) noexcept : above(positive), below(negative) {}
    constexpr explicit corner_sides(const std::array<int, 3>& signs) noexcept {
        for (unsigned i = 0; i < 3; ++i) {
            above |= static_cast<unsigned>(signs[i] > 0) << i;
            below |= static_cast<unsigned>(signs[i] < 0) << i;
        }
    }

    [[nodiscard]] constexpr bool on_one_side() const noexcept { return above == 7 || below == 7; }
    [[nodiscard]] constexpr bool on_plane() const noexcept { return (above | below) == 0; }
    [[nodiscard]] constexpr bool all_off_plane() const noexcept { return (above | below) == 7; }
    [[nodiscard]] constexpr int operator[](int corner) const noexcept {
        return static_cast<int>(above >> corner & 1) - static_cast<int>(below >> corner & 1);
    }
};

/// The sign (-1, 0, 1) of det(b - a, c - a, d - a): the side of the plane through a, b and c on which d lies, 0 for
/// coplanar points. Slow; `orientations` falls back to it if rounded arithmetic cannot decide.
[[nodiscard]] int exact_side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept;

/// The sides of the plane of `t` on which the corners of `s` lie, as by `exact_side`.
[[nodiscard]] corner_sides exact_sides(const triangle3d& s, const triangle3d& t) noexcept;

/// The sign of the component `axis` of (b - a) × (c - a): the orientation of a, b, c projected along that axis.
[[nodiscard]] int exact_turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept;

/// Whether all coordinates are multiples of a unit on their axis such that the extent is less than 2^16 units. False
/// for extents whose products would leave the range of double, and for coordinates that are too large to decide.
[[nodiscard]] bool are_on_lattice(const triangle3d& s, const triangle3d& t, const vec3d& extent) noexcept;

/// The determinant of `exact_side` and the component of `exact_turn`, within 1.001 · 2^-53 of their value.
[[nodiscard]] scaled_double exact_volume(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept;
[[nodiscard]] scaled_double exact_area(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept;

/// Error bounds of the determinants of `exact_side` and `exact_turn` computed in rounded arithmetic, as factors of the
/// extents E of the points' box on the axes and of the unit roundoff u. Only an error that gives a wrong sign matters.
///
/// A turn is p_x q_y - p_y q_x for two differences p, q of points. Four differences, off by u E at most, change it by
/// u E E each, as the two rounded products do. The last subtraction keeps the sign: 6 u E E in all.
///
/// A side is n · r for n = p × q and a third difference r. A difference is multiplied by twice the area of a projected
/// triangle of points, at most E E: nine differences change the side by u E E E each. So does each of the nine products
/// and differences in n, and each product with r. With a wrong sign the side itself is within the error, so that the
/// first two products add up to the third, negated: their sum rounds by u E E E, and the last sum keeps the sign: 22 u
/// E E E in all. Half a u more covers terms of second order and the rounding of E and the bounds.
///
/// If coordinates are off by at most b, E is the computed extent W plus 2 b. Both determinants are linear in the
/// coordinates on one axis. A side changes by at most b times the sum, over four points, of twice the projected area of
/// the triangle of the others: 4 b E E for each axis. A turn changes by b times the edges' lengths along the other
/// axis: 2 b E. What rounds is of the size of W: with it, 22.5 u E E E leaves 45 u b E E for each axis, more than 11
/// roundings of the term 4 b E E and of the first sum, which may now differ from the third product by that term.
namespace determinant_errors {
inline constexpr double rounding_of_turn = 6.5, rounding_of_side = 22.5;
inline constexpr double displacement_of_turn = 2, displacement_of_side = 4;
}  // namespace determinant_errors

/// Filtered predicates for the corners of two triangles: computed in double, and exactly only if the result lies within
/// its rounding error. The error bound is one number for all corners (a semi-static filter, Meyer and Pion, "FPG: a
/// code generator for fast and certified geometric predicates", 2008).
///
/// The bounds are those of `determinant_errors`. Extents between 2^-200 and 2^200 cannot overflow, and the contribution
/// of underflow, less than 2^-870, is far below u E E E >= 2^-653. Other extents make the bound infinite or NaN, so
/// that everything is computed exactly; floats never have such extents. An extent of zero makes the bound zero, and the
/// computed zero is exact.
///
/// If the filter fails, all coordinates may lie on a lattice: multiples of a unit on their axis such that E is less
/// than 2^16 units. Then differences are integers below 2^16, components of the normal below 2^33, and the sums of a
/// volume below 3 · 2^49, so nothing was rounded and the bound is zero.
/// @tparam IsExact whether coordinates are exact, and signs that the filter leaves uncertain are computed exactly
template <bool IsExact>
class filtered_orientations {
public:
    /// All queried points must be corners of `s` or `t`, which outlive this object and lie in the box `low` to `high`.
    /// @param error of the coordinates on each axis; 0 if they are exact
    inline filtered_orientations(const triangle3d& s, const triangle3d& t, const lanes<double>& low,
                                 const lanes<double>& high, const vec3d& error = {}) noexcept
        : s_(s), t_(t) {
        lanes<double> width = high - low;
        if constexpr (!IsExact) width += 2 * coordinates(error);
        const auto in_range = (width == 0) | ((width >= 0x1p-200) & (width <= 0x1p200));
        // Beyond that range the bounds become infinite, so that everything is computed exactly.
        const lanes<double> extent = in_range ? width : lanes<double>{} + std::numeric_limits<double>::infinity();
        extent_ = {extent[0], extent[1], extent[2]};
        side_error_ = determinant_errors::rounding_of_side * unit * extent[0] * extent[1] * extent[2];
        if constexpr (!IsExact)
            for (int k = 0; k < 3; ++k) {
                const int x = (k + 1) % 3, y = (k + 2) % 3;
                side_error_ += determinant_errors::displacement_of_side * error[k] * extent[x] * extent[y];
                displacement_of_turn_[k] =
                    determinant_errors::displacement_of_turn * (error[x] * extent[y] + error[y] * extent[x]);
            }
    }

    /// The sides of the other's plane on which each triangle's corners lie. Some may stay undecided if the others prove
    /// that the triangles are disjoint.
    /// @returns whether one triangle lies strictly on one side of the other's plane
    [[nodiscard]] inline bool part(corner_sides& s_to_t, corner_sides& t_to_s) noexcept {
        const lanes<double> of_s = volumes(s_, t_);
        const lanes<double> of_t = volumes(t_, s_);
        s_to_t = certain_signs(of_s, side_error_);
        t_to_s = certain_signs(of_t, side_error_);
        if (s_to_t.on_one_side() || t_to_s.on_one_side()) return true;
        if ((s_to_t.all_off_plane() && t_to_s.all_off_plane()) || side_error_ == 0) [[likely]]
            return false;
        if constexpr (!IsExact) {
            unsure_ = true;
            return false;
        }
        if (on_lattice()) {
            s_to_t = certain_signs(of_s, 0);
            t_to_s = certain_signs(of_t, 0);
        } else {
            if (!s_to_t.all_off_plane()) s_to_t = exact_sides(s_, t_);
            if (s_to_t.on_one_side()) return true;
            if (!t_to_s.all_off_plane()) t_to_s = exact_sides(t_, s_);
        }
        return s_to_t.on_one_side() || t_to_s.on_one_side();
    }

    /// The result of `exact_side`, filtered.
    [[nodiscard]] inline int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
        const double computed = volume(a, b, c, d);
        const int sign = certain_sign(computed, side_error_);
        if (sign != 0 || side_error_ == 0) [[likely]]
            return sign;
        if constexpr (!IsExact) {
            unsure_ = true;
            return 0;
        }
        return on_lattice() ? certain_sign(computed, 0) : exact_side(a, b, c, d);
    }

    /// Whether side(s0, s1, t0, t1) <= 0 and side(s0, s2, t0, t2) >= 0. Computes both: a branch is hard to predict.
    [[nodiscard]] inline bool in_order(const vec3d& s0, const vec3d& s1, const vec3d& s2, const vec3d& t0,
                                       const vec3d& t1, const vec3d& t2) noexcept {
        const int first = certain_sign(volume(s0, s1, t0, t1), side_error_);
        const int second = certain_sign(volume(s0, s2, t0, t2), side_error_);
        if (first * second != 0 || side_error_ == 0) [[likely]]
            return std::max(first, -second) <= 0;
        return side(s0, s1, t0, t1) <= 0 && side(s0, s2, t0, t2) >= 0;
    }

    /// The result of `exact_turn`, which is called only if double leaves the sign uncertain and there is no lattice.
    [[nodiscard]] inline int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const double computed = (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
        const double error = turn_error(x, y);
        const int sign = certain_sign(computed, error);
        if (sign != 0 || error == 0) return sign;
        if constexpr (!IsExact) {
            unsure_ = true;
            return 0;
        }
        return on_lattice() ? certain_sign(computed, 0) : exact_turn(a, b, c, axis);
    }

    /// Whether, projected along an axis, the line ab has all corners of `t` strictly on one side, and on the other
    /// side, or on the line itself, the triangle with the edge ab. `own` is the orientation of that triangle.
    [[nodiscard]] inline bool beyond(const vec3d& a, const vec3d& b, int own, const triangle3d& t, int axis) noexcept {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const lanes<double> computed =
            (b[x] - a[x]) * (corners_along(t, y) - a[y]) - (b[y] - a[y]) * (corners_along(t, x) - a[x]);
        const double error = turn_error(x, y);
        corner_sides turns = certain_signs(computed, error);
        if (!turns.all_off_plane() && error != 0) {
            if (turns.above != 0 && turns.below != 0) return false;
            if constexpr (!IsExact) {
                unsure_ = true;
                return false;
            }
            if (on_lattice())
                turns = certain_signs(computed, 0);
            else
                turns = corner_sides(
                    {exact_turn(a, b, t[0], axis), exact_turn(a, b, t[1], axis), exact_turn(a, b, t[2], axis)});
        }
        return (own <= 0 && turns.above == 7) || (own >= 0 && turns.below == 7);
    }

    /// Whether a sign could not be decided so far.
    [[nodiscard]] bool unsure() const noexcept
        requires(!IsExact)
    {
        return unsure_;
    }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    /// Zero if the error may exceed the value. Branch-free, since signs are hard to predict.
    [[nodiscard]] static inline int certain_sign(double computed, double error) noexcept {
        return static_cast<int>(computed > error) - static_cast<int>(computed < -error);
    }
    [[nodiscard]] static inline corner_sides certain_signs(const lanes<double>& computed, double error) noexcept {
        return {bits(computed > error), bits(computed < -error)};
    }

    [[nodiscard]] static inline double volume(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
        return dot(cross(b - a, c - a), d - a);
    }

    /// The volumes of the corners of `s` over the plane of `t`.
    [[nodiscard]] static inline lanes<double> volumes(const triangle3d& s, const triangle3d& t) noexcept {
        const vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
        const auto along = [&](int k) { return normal[k] * (corners_along(s, k) - t[0][k]); };
        return along(0) + along(1) + along(2);
    }

    [[nodiscard]] inline double turn_error(int x, int y) const noexcept {
        const double rounding = determinant_errors::rounding_of_turn * unit * extent_[x] * extent_[y];
        if constexpr (!IsExact) return displacement_of_turn_[3 - x - y] + rounding;
        return is_lattice_ ? 0 : rounding;
    }

    /// Evaluated lazily if the filter fails, and only once.
    [[nodiscard]] inline bool on_lattice() noexcept {
        if (is_lattice_known_) return is_lattice_;
        is_lattice_known_ = true;
        is_lattice_ = are_on_lattice(s_, t_, extent_);
        if (is_lattice_) side_error_ = 0;
        return is_lattice_;
    }

    const triangle3d& s_;
    const triangle3d& t_;
    vec3d extent_;
    double side_error_;
    bool is_lattice_known_ = false;
    bool is_lattice_ = false;
    bool unsure_ = false;           // only for coordinates with errors, as is the next
    vec3d displacement_of_turn_{};  // by the axis of projection
};

using orientations = filtered_orientations<true>;

}  // namespace aabb
