export module aabb.triangle.interval_test;

export import aabb.local_detection;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The distance from a plane, scaled by the length of its normal, below which a corner counts as lying in the plane.
enum class epsilon_choice : std::uint8_t {
    absolute,  ///< 1e-6, as in the original: too large for small triangles
    none,      ///< 0
    scaled     ///< 1e-6 times the pair's longest extent and the length of the normal
};

/// How the ends of two intervals are compared.
enum class division_choice : std::uint8_t {
    yes,  ///< by quotients, as in the paper
    no    ///< by products with all denominators, as in the author's later code; they overflow and underflow sooner
};

struct interval_config {
    epsilon_choice epsilon = epsilon_choice::absolute;
    division_choice division = division_choice::yes;
};

inline constexpr std::tuple interval_parameters{
    choice_parameter{"epsilon", &interval_config::epsilon,
                     std::array<std::string_view, 3>{"absolute", "none", "scaled"},
                     "distances that count as zero: below 1e-6 as in the original, none, or below 1e-6 of the "
                     "pair's extent"},
    choice_parameter{"division", &interval_config::division, std::array<std::string_view, 2>{"yes", "no"},
                     "whether ends of intervals are compared as quotients, or as products with all denominators"}};

/// Möller's interval test ("A fast triangle-triangle intersection test", 1997) in the arithmetic of Real. It reproduces
/// the original's order of summation, its choice of axis in ties, and its results after underflow and overflow.
template <class Real>
class interval_test {
public:
    static constexpr bool exact = false;

    using config = interval_config;
    static constexpr auto parameters = interval_parameters;

    interval_test() = default;
    explicit interval_test(const config& c) : config_(c) {}

    /// Whether the intervals in which the triangles cut the common line of their planes overlap.
    [[nodiscard]] bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) const noexcept {
        const vec3<Real> normal_t = cross(t[1] - t[0], t[2] - t[0]);
        const std::array<Real, 3> s_to_t = distances(s, t[0], normal_t, zero_below(s, t, normal_t));
        if (on_one_side(s_to_t)) return false;
        const vec3<Real> normal_s = cross(s[1] - s[0], s[2] - s[0]);
        const std::array<Real, 3> t_to_s = distances(t, s[0], normal_s, zero_below(s, t, normal_s));
        if (on_one_side(t_to_s)) return false;
        if (s_to_t == std::array<Real, 3>{} || t_to_s == std::array<Real, 3>{})
            return coplanar_intersects(s, t, normal_s);
        // Both triangles cut the common line of the planes; their intervals are compared on the line's dominant axis.
        const int axis = largest(cross(normal_s, normal_t));
        const cut_edges of_s(s, s_to_t, axis);
        const cut_edges of_t(t, t_to_s, axis);
        const auto [s_low, s_high] =
            config_.division == division_choice::yes ? of_s.quotients() : of_s.products(of_t.denominators());
        const auto [t_low, t_high] =
            config_.division == division_choice::yes ? of_t.quotients() : of_t.products(of_s.denominators());
        return !(s_high < t_low || t_high < s_low);  // not `>=`: after an overflow to NaN the original accepts
    }

private:
    /// Distances below this count as zero. It is a double, because the float nearest to 1e-6 is less than 1e-6.
    [[nodiscard]] double zero_below(const triangle3<Real>& s, const triangle3<Real>& t,
                                    const vec3<Real>& normal) const noexcept {
        constexpr double epsilon = 1e-6;
        switch (config_.epsilon) {
            case epsilon_choice::absolute: return epsilon;
            case epsilon_choice::none: return 0;
            case epsilon_choice::scaled: break;
        }
        double extent = 0;
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(
                {double{s[0][k]}, double{s[1][k]}, double{s[2][k]}, double{t[0][k]}, double{t[1][k]}, double{t[2][k]}});
            extent = std::max(extent, high - low);
        }
        return epsilon * extent * std::sqrt(double{dot(normal, normal)});
    }

    /// Signed distances of the corners from a plane, times the length of its normal; those below the limit become 0.
    /// @param on_plane a point of the plane
    [[nodiscard]] static std::array<Real, 3> distances(const triangle3<Real>& s, const vec3<Real>& on_plane,
                                                       const vec3<Real>& normal, double zero_below) noexcept {
        const Real offset = -dot(normal, on_plane);
        std::array<Real, 3> d{};
        for (int i = 0; i < 3; ++i) {
            const Real distance = dot(normal, s[i]) + offset;
            d[static_cast<std::size_t>(i)] = std::abs(distance) < zero_below ? 0 : distance;
        }
        return d;
    }

    [[nodiscard]] static bool on_one_side(const std::array<Real, 3>& d) noexcept {
        return (d[0] > 0 && d[1] > 0 && d[2] > 0) || (d[0] < 0 && d[1] < 0 && d[2] < 0);
    }
    [[nodiscard]] static int largest(const vec3<Real>& v) noexcept {
        int k = std::abs(v[1]) > std::abs(v[0]) ? 1 : 0;
        return std::abs(v[2]) > std::abs(v[k]) ? 2 : k;
    }

    /// The two edges of a triangle that the common line cuts, projected to `axis`.
    class cut_edges {
    public:
        /// @param d the signed distances of the corners from the other plane, not all zero and not all of one sign
        cut_edges(const triangle3<Real>& s, const std::array<Real, 3>& d, int axis) noexcept {
            // The corner that the plane separates from the others, as in the original also if corners lie on it.
            int alone = 0;
            if (d[0] * d[1] > 0)
                alone = 2;
            else if (d[0] * d[2] > 0)
                alone = 1;
            else if (!(d[1] * d[2] > 0 || d[0] != 0))
                alone = d[1] != 0 ? 1 : 2;
            from_ = s[alone][axis];
            const auto edge_to = [&](int other) {
                const Real distance = d[static_cast<std::size_t>(alone)];
                return edge{(s[other][axis] - from_) * distance, distance - d[static_cast<std::size_t>(other)]};
            };
            first_ = edge_to(alone == 0 ? 1 : 0);
            second_ = edge_to(alone == 2 ? 1 : 2);
        }

        /// The ends of the interval, the lower one first.
        [[nodiscard]] std::pair<Real, Real> quotients() const noexcept {
            return ordered(from_ + first_.numerator / first_.denominator,
                           from_ + second_.numerator / second_.denominator);
        }

        [[nodiscard]] Real denominators() const noexcept { return first_.denominator * second_.denominator; }

        /// The ends times both own denominators and `factor`, the other triangle's denominators.
        [[nodiscard]] std::pair<Real, Real> products(Real factor) const noexcept {
            const Real shared = from_ * (denominators() * factor);
            return ordered(shared + first_.numerator * second_.denominator * factor,
                           shared + second_.numerator * first_.denominator * factor);
        }

    private:
        struct edge {
            Real numerator;
            Real denominator;
        };

        [[nodiscard]] static std::pair<Real, Real> ordered(Real p, Real q) noexcept {
            return p > q ? std::pair{q, p} : std::pair{p, q};
        }

        Real from_{};
        edge first_{};
        edge second_{};
    };

    /// Tests coplanar triangles in the axis plane in which their area is largest: edges against edges, then a corner of
    /// each triangle against the other triangle.
    [[nodiscard]] static bool coplanar_intersects(const triangle3<Real>& s, const triangle3<Real>& t,
                                                  const vec3<Real>& normal) noexcept {
        // Möller's published code, reproduced here, drops the later axis in ties, but y rather than z.
        const vec3<Real> length{std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
        const int y_or_z = length[2] > length[1] ? 2 : 1;
        const int dropped = length[0] > length[1] ? (length[0] > length[2] ? 0 : 2) : y_or_z;
        const int x = dropped == 0 ? 1 : 0, y = dropped == 2 ? 1 : 2;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (edges_cross(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3], x, y)) return true;
        return corner_is_inside(s[0], t, x, y) || corner_is_inside(t[0], s, x, y);
    }

    /// Whether two segments in the axis plane intersect, by Cramer's rule for their parameters d / f and e / f.
    [[nodiscard]] static bool edges_cross(const vec3<Real>& p, const vec3<Real>& p_end, const vec3<Real>& q,
                                          const vec3<Real>& q_end, int x, int y) noexcept {
        const Real ax = p_end[x] - p[x];
        const Real ay = p_end[y] - p[y];
        const Real bx = q[x] - q_end[x];
        const Real by = q[y] - q_end[y];
        const Real cx = p[x] - q[x];
        const Real cy = p[y] - q[y];
        const Real f = ay * bx - ax * by;
        const Real d = by * cx - bx * cy;
        const Real e = ax * cy - ay * cx;
        if (f > 0) return d >= 0 && d <= f && e >= 0 && e <= f;
        return f < 0 && d <= 0 && d >= f && e <= 0 && e >= f;
    }

    /// Whether p is strictly inside all edges. For tiny triangles the products underflow, and the result is no.
    [[nodiscard]] static bool corner_is_inside(const vec3<Real>& p, const triangle3<Real>& t, int x, int y) noexcept {
        std::array<Real, 3> side{};
        for (int i = 0; i < 3; ++i) {
            const vec3<Real>& from = t[i];
            const vec3<Real>& to = t[(i + 1) % 3];
            const Real a = to[y] - from[y];
            const Real b = -(to[x] - from[x]);
            const Real c = -a * from[x] - b * from[y];
            side[static_cast<std::size_t>(i)] = a * p[x] + b * p[y] + c;
        }
        return side[0] * side[1] > 0 && side[0] * side[2] > 0;
    }

    config config_;
};

}  // namespace aabb
