/// Exact orientation predicates for the corners of two triangles in world coordinates: a corner is R v + t in real
/// arithmetic, for a vertex v of a mesh and a pose as they are given.
export module aabb.geometry:posed_orientations;

import aabb.std;
import :points;
import :pose;
import :predicates;
import :product_sum;
import :wide_integer;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The poses of two meshes.
struct pose_pair {
    pose a;
    pose b;
};

/// A corner in world coordinates, before anything is rounded.
struct posed_point {
    const vec3d* vertex;
    const pose* at;
};

/// A number rounded to double.
struct rounded_coordinate {
    double value;
    bool is_exact;
};

/// The corners of two triangles in world coordinates, as integers of a common unit: exact for all finite vertices and
/// poses. Four widths are enough: the least for meshes of floats and common poses, the third if vertices or poses span
/// the whole range of double, the greatest if both do.
class exact_corners {
public:
    explicit exact_corners(const std::array<posed_point, 6>& points) noexcept;

    /// The sign of the determinant of `exact_side` of four corners, by index.
    [[nodiscard]] int side(int a, int b, int c, int d) const noexcept;
    /// Whether the boxes of the two triangles share no point.
    [[nodiscard]] bool boxes_are_disjoint() const noexcept;
    /// The sign of `exact_turn` of three corners, by index.
    [[nodiscard]] int turn(int a, int b, int c, int axis) const noexcept;
    /// The sign of a - b on an axis.
    [[nodiscard]] int order(int a, int b, int axis) const noexcept;

    /// The determinants of `side` and `turn` in one common unit, within 1.001 · 2^-53 of their value.
    [[nodiscard]] scaled_double volume(int a, int b, int c, int d) const noexcept;
    [[nodiscard]] scaled_double area(int a, int b, int c, int axis) const noexcept;
    /// A coordinate of a corner, with a relative error of at most 2^-52.
    [[nodiscard]] rounded_coordinate coordinate(int corner, int axis) const noexcept;

private:
    template <std::size_t Limbs>
    using corners_of = std::array<vec3<wide_integer<Limbs>>, 6>;

    std::variant<corners_of<3>, corners_of<8>, corners_of<20>, corners_of<68>> corners_;
    int unit_ = 0;  // the exponent of the integers' unit
};

/// Filtered predicates, as `orientations`, for corners in world coordinates: computed in double, relative to the
/// translation of the first pose, and in integers if the result lies within its error.
///
/// Error of a coordinate: three products, three sums and the rounded difference of the translations round any term at
/// most four times. So 4 u of the sum of the terms' magnitudes bounds it, u = 2^-53, and a quarter of a u more covers
/// the rounding of this sum and of the bounds made of it; 2^-1070 covers underflow. After an overflow the bound is
/// infinite or NaN. The difference of two coordinates is off by twice that, and its own rounding keeps the sign. The
/// bounds of determinants are those of `determinant_errors`.
class posed_orientations {
public:
    /// @param s,t vertices of a mesh at `poses.a` and of one at `poses.b`; all outlive this object
    posed_orientations(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept
        : given_{{{&s[0], &poses.a},
                  {&s[1], &poses.a},
                  {&s[2], &poses.a},
                  {&t[0], &poses.b},
                  {&t[1], &poses.b},
                  {&t[2], &poses.b}}} {
        const vec3d between = poses.b.translation - poses.a.translation;
        lanes<double> error{};
        const motion of_a(poses.a, {}), of_b(poses.b, between);
        for (int i = 0; i < 3; ++i) {
            s_[i] = of_a(s[i], error);
            t_[i] = of_b(t[i], error);
        }
        const auto [low, high] = range(s_, t_);
        const lanes<double> width = high - low + 2 * error;
        const auto in_range = (width >= 0x1p-200) & (width <= 0x1p200);
        // Beyond that range, or after an overflow, everything is computed exactly.
        const lanes<double> d = in_range ? width : lanes<double>{} + std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const int x = (k + 1) % 3, y = (k + 2) % 3;
            error_[k] = error[k];
            side_error_ += determinant_errors::displacement_of_side * error[k] * d[x] * d[y];
            turn_error_[k] = determinant_errors::displacement_of_turn * (error[x] * d[y] + error[y] * d[x]) +
                             determinant_errors::rounding_of_turn * unit * d[x] * d[y];
        }
        side_error_ += determinant_errors::rounding_of_side * unit * d[0] * d[1] * d[2];
    }

    /// The triangles in world coordinates, rounded; predicates take references to their corners.
    [[nodiscard]] const triangle3d& s() const noexcept { return s_; }
    [[nodiscard]] const triangle3d& t() const noexcept { return t_; }

    /// The index of a corner of `s()`, or 3 more than that of one of `t()`.
    [[nodiscard]] int index_of(const vec3d& corner) const noexcept {
        for (int i = 0; i < 3; ++i) {
            if (&corner == &s_[i]) return i;
            if (&corner == &t_[i]) return 3 + i;
        }
        __builtin_unreachable();
    }

    /// Whether the boxes of the triangles are certainly disjoint.
    [[nodiscard]] bool are_apart() const noexcept {
        bool apart = false;
        for (int k = 0; k < 3; ++k) {
            const auto [s_low, s_high] = std::minmax({s_[0][k], s_[1][k], s_[2][k]});
            const auto [t_low, t_high] = std::minmax({t_[0][k], t_[1][k], t_[2][k]});
            const double gap = std::max(t_low - s_high, s_low - t_high);
            apart |= gap > 2 * error_[k];
        }
        return apart;
    }

    /// Whether two corners of one triangle are the same point: a map of full rank keeps vertices distinct.
    [[nodiscard]] bool are_equal(const vec3d& p, const vec3d& q) const noexcept {
        const auto vertex = [&](const vec3d& corner) -> const vec3d& {
            return *given_[static_cast<std::size_t>(index_of(corner))].vertex;
        };
        return vertex(p) == vertex(q);
    }

    /// Whether they are disjoint, exactly.
    [[nodiscard]] bool boxes_are_disjoint() noexcept { return exact().boxes_are_disjoint(); }

    /// The same as `orientations::part`.
    [[nodiscard]] bool part(corner_sides& s_to_t, corner_sides& t_to_s) noexcept {
        const std::array<int, 3> of_s = filtered_sides(t_, s_), of_t = filtered_sides(s_, t_);
        s_to_t = corner_sides(of_s);
        t_to_s = corner_sides(of_t);
        if (s_to_t.on_one_side() || t_to_s.on_one_side()) return true;
        s_to_t = decided(of_s, t_, s_);
        if (s_to_t.on_one_side()) return true;
        t_to_s = decided(of_t, s_, t_);
        return t_to_s.on_one_side();
    }

    [[nodiscard]] int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
        const int sign = filtered_side(a, b, c, d);
        return sign != 0 ? sign : exact().side(index_of(a), index_of(b), index_of(c), index_of(d));
    }

    /// The same as `orientations::in_order`.
    [[nodiscard]] bool in_order(const vec3d& s0, const vec3d& s1, const vec3d& s2, const vec3d& t0, const vec3d& t1,
                                const vec3d& t2) noexcept {
        return side(s0, s1, t0, t1) <= 0 && side(s0, s2, t0, t2) >= 0;
    }

    [[nodiscard]] int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const double area = (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
        const int sign = sign_beyond(area, turn_error_[axis]);
        return sign != 0 ? sign : exact().turn(index_of(a), index_of(b), index_of(c), axis);
    }

    /// The sign of a - b on an axis.
    [[nodiscard]] int order(const vec3d& a, const vec3d& b, int axis) noexcept {
        const int sign = sign_beyond(a[axis] - b[axis], 2 * error_[axis]);
        return sign != 0 ? sign : exact().order(index_of(a), index_of(b), axis);
    }

    /// The integers of all corners, computed when they are first needed.
    [[nodiscard]] const exact_corners& exact() noexcept {
        if (!exact_) exact_.emplace(given_);
        return *exact_;
    }

    /// The same as `orientations::beyond`.
    [[nodiscard]] bool beyond(const vec3d& a, const vec3d& b, int own, const triangle3d& t, int axis) noexcept {
        const int first = turn(a, b, t[0], axis);
        return first != 0 && first != own && turn(a, b, t[1], axis) == first && turn(a, b, t[2], axis) == first;
    }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    /// The columns of a pose's matrix, and a translation.
    struct motion {
        std::array<lanes<double>, 3> columns;
        lanes<double> translation;

        motion(const pose& p, const vec3d& by) noexcept : translation(coordinates(by)) {
            for (std::size_t k = 0; k < 3; ++k)
                columns[k] = coordinates(vec3d{p.rotation[k], p.rotation[3 + k], p.rotation[6 + k]});
        }

        /// R v + t in double.
        /// @param error raised to the error bound of each coordinate
        [[nodiscard]] inline vec3d operator()(const vec3d& v, lanes<double>& error) const noexcept {
            const lanes<double> x = columns[0] * v[0], y = columns[1] * v[1], z = columns[2] * v[2];
            const lanes<double> world = x + y + z + translation;
            const auto size = [](const lanes<double>& term) { return __builtin_elementwise_abs(term); };
            const lanes<double> bound = 4.25 * unit * (size(x) + size(y) + size(z) + size(translation)) + 0x1p-1070;
            error = bound <= error ? error : bound;
            return {world[0], world[1], world[2]};
        }
    };

    [[nodiscard]] static std::pair<lanes<double>, lanes<double>> range(const triangle3d& s,
                                                                       const triangle3d& t) noexcept {
        lanes<double> low = coordinates(s[0]), high = low;
        for (const vec3d* p : {&s[1], &s[2], &t[0], &t[1], &t[2]}) {
            const lanes<double> at = coordinates(*p);
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        return {low, high};
    }

    /// Zero if the error may exceed the value, or either is NaN.
    [[nodiscard]] static int sign_beyond(double value, double error) noexcept {
        return static_cast<int>(value > error) - static_cast<int>(value < -error);
    }
    [[nodiscard]] int filtered_side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) const noexcept {
        return sign_beyond(dot(cross(b - a, c - a), d - a), side_error_);
    }
    /// The certain sides of the plane of `of` on which the corners of `t` lie; 0 if uncertain.
    [[nodiscard]] std::array<int, 3> filtered_sides(const triangle3d& of, const triangle3d& t) const noexcept {
        const vec3d normal = cross(of[1] - of[0], of[2] - of[0]);
        const auto side = [&](int i) { return sign_beyond(dot(normal, t[i] - of[0]), side_error_); };
        return {side(0), side(1), side(2)};
    }
    /// Decides the sides that the filter left uncertain.
    [[nodiscard]] corner_sides decided(std::array<int, 3> sides, const triangle3d& of, const triangle3d& t) noexcept {
        for (int i = 0; i < 3; ++i)
            if (int& side = sides[static_cast<std::size_t>(i)]; side == 0)
                side = exact().side(index_of(of[0]), index_of(of[1]), index_of(of[2]), index_of(t[i]));
        return corner_sides(sides);
    }

    std::array<posed_point, 6> given_;
    triangle3d s_{}, t_{};  // in world coordinates relative to the first translation, rounded
    vec3d error_{};         // of their coordinates
    double side_error_ = 0;
    vec3d turn_error_{};
    std::optional<exact_corners> exact_;
};

}  // namespace aabb
