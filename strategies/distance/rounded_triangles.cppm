/// Nearest points of two triangles in rounded arithmetic, and bounds of their distance that are certain.
export module aabb.distance.rounded_triangles;

export import aabb.geometry;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Points of two triangles, and directions in which to separate these: along the segment between the points, and along
/// the normal of the features on which they lie.
struct near_points {
    vec3d p, q;
    vec3d normal{};  ///< n = u × v of two edges, or of the face's edges; 0 for a corner and an edge
    double squared = std::numeric_limits<double>::infinity();  ///< of the distance between the points

    /// Replaces the points by nearer ones; NaN is never nearer.
    inline void take(const vec3d& of_s, const vec3d& of_t, const vec3d& of_features) noexcept {
        const vec3d between = of_s - of_t;
        if (const double length = dot(between, between); length < squared) *this = {of_s, of_t, of_features, length};
    }
};

/// Two triangles of meshes at poses, rounded to double relative to a corner of the first. Whatever the nearest points
/// are that rounded arithmetic yields, two facts about them bound the true distance D, and no algorithm that is less
/// accurate makes the bounds wrong:
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
class rounded_triangles {
public:
    rounded_triangles(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept {
        if (poses.a == pose{} && poses.b == pose{}) {
            set(s, t, /*error=*/0);
            return;
        }
        vec3d error{};
        const vec3d between = poses.b.translation - poses.a.translation;
        triangle3d of_s{}, of_t{};
        for (int i = 0; i < 3; ++i) {
            of_s[i] = placed(poses.a, {}, s[i], error);
            of_t[i] = placed(poses.b, between, t[i], error);
        }
        set(of_s, of_t, error[0] + error[1] + error[2]);
    }

    /// Whether the distance is at most d; nothing if rounding could change the result.
    [[nodiscard]] std::optional<bool> are_within(double d) const noexcept {
        if (!in_range_) return std::nullopt;
        // Most triangles that are farther are so by their boxes, or seen along the normal of either.
        if (gap_of_boxes() - tolerance_ > d) return false;
        for (const triangle3d* const of : {&s_, &t_})
            if (lower_bound(cross((*of)[1] - (*of)[0], (*of)[2] - (*of)[0])) > d) return false;
        const near_points nearest = nearest_points();
        if (upper_bound(nearest) <= d) return true;
        if (lower_bound(nearest.p - nearest.q) > d || lower_bound(nearest.normal) > d) return false;
        return std::nullopt;
    }

    /// False if numbers are so large or small that the bounds could be wrong.
    [[nodiscard]] bool in_range() const noexcept { return in_range_; }

    /// The bounds; `lower_bound` is negative if the direction separates nothing.
    [[nodiscard]] double upper_bound(const near_points& nearest) const noexcept {
        return std::sqrt(nearest.squared) + tolerance_;
    }
    [[nodiscard]] double lower_bound(const vec3d& direction) const noexcept {
        const double greatest = std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])});
        if (!(greatest >= 0x1p-450)) return -1;
        const auto [s_low, s_high] = range_along(s_, direction);
        const auto [t_low, t_high] = range_along(t_, direction);
        const double gap = std::max(s_low - t_high, t_low - s_high);
        return gap / std::sqrt(dot(direction, direction)) - tolerance_;
    }

    /// The nearest points, up to rounding, of triangles that are disjoint: those of two edges, or of a corner and a
    /// face. Of triangles that intersect, some points.
    [[nodiscard]] near_points nearest_points() const noexcept {
        near_points nearest{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) of_edges({s_[i], s_[(i + 1) % 3]}, {t_[j], t_[(j + 1) % 3]}, nearest);
        for (int i = 0; i < 3; ++i) {
            of_corner_and_face(s_[i], t_, /*corner_is_of_s=*/true, nearest);
            of_corner_and_face(t_[i], s_, /*corner_is_of_s=*/false, nearest);
        }
        return nearest;
    }

    /// What coordinates are relative to, in the world: this point, and with poses the translation of the first besides.
    [[nodiscard]] const vec3d& origin() const noexcept { return origin_; }
    [[nodiscard]] double tolerance() const noexcept { return tolerance_; }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    struct edge {
        const vec3d& from;
        const vec3d& to;
    };

    /// R v + t in double.
    /// @param error raised to the error bound of each coordinate, as derived for `posed_orientations`
    [[nodiscard]] static vec3d placed(const pose& at, const vec3d& translation, const vec3d& v, vec3d& error) noexcept {
        vec3d world{};
        for (int k = 0; k < 3; ++k) {
            const auto row = static_cast<std::size_t>(3 * k);
            const double x = at.rotation[row] * v[0], y = at.rotation[row + 1] * v[1], z = at.rotation[row + 2] * v[2];
            world[k] = x + y + z + translation[k];
            const double bound =
                4.25 * unit * (std::abs(x) + std::abs(y) + std::abs(z) + std::abs(translation[k])) + 0x1p-1070;
            error[k] = std::max(error[k], bound);
        }
        return world;
    }

    void set(const triangle3d& s, const triangle3d& t, double error) noexcept {
        origin_ = s[0];
        double width = 0;
        for (int k = 0; k < 3; ++k) {
            double greatest = 0;
            for (int i = 0; i < 3; ++i) {
                s_[i][k] = s[i][k] - origin_[k];
                t_[i][k] = t[i][k] - origin_[k];
                greatest = std::max({greatest, std::abs(s_[i][k]), std::abs(t_[i][k])});
            }
            width += greatest;
        }
        tolerance_ = 32 * unit * width + 2.25 * error;
        // After an overflow of a coordinate, its error bound is infinite.
        in_range_ = width >= 0x1p-200 && width <= 0x1p200 && tolerance_ <= 0x1p200;
    }

    /// The distance of the triangles' boxes, with errors as `lower_bound` has them.
    [[nodiscard]] double gap_of_boxes() const noexcept {
        vec3d gaps{};
        for (int k = 0; k < 3; ++k) {
            const auto [s_low, s_high] = std::minmax({s_[0][k], s_[1][k], s_[2][k]});
            const auto [t_low, t_high] = std::minmax({t_[0][k], t_[1][k], t_[2][k]});
            gaps[k] = std::max({0.0, s_low - t_high, t_low - s_high});
        }
        return std::sqrt(dot(gaps, gaps));
    }

    [[nodiscard]] static std::pair<double, double> range_along(const triangle3d& t, const vec3d& direction) noexcept {
        return std::minmax({dot(direction, t[0]), dot(direction, t[1]), dot(direction, t[2])});
    }

    [[nodiscard]] static vec3d along(const vec3d& from, const vec3d& by, double factor) noexcept {
        return {from[0] + by[0] * factor, from[1] + by[1] * factor, from[2] + by[2] * factor};
    }

    /// The nearest points of two edges: those of their lines, clamped to one edge and then to the other (Ericson,
    /// "Real-time collision detection", 2005, section 5.1.9).
    static void of_edges(const edge& e, const edge& f, near_points& nearest) noexcept {
        const vec3d u = e.to - e.from, v = f.to - f.from, w = f.from - e.from;
        const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
        const double determinant = uu * vv - uv * uv;
        const auto clamped = [](double x) { return x > 0 ? std::min(x, 1.0) : 0.0; };  // 0 for NaN
        double of_e = clamped(determinant > 0 ? (uw * vv - vw * uv) / determinant : 0);
        double of_f = vv > 0 ? (of_e * uv - vw) / vv : 0;
        if (of_f < 0 || of_f > 1) {
            of_f = clamped(of_f);
            of_e = clamped(uu > 0 ? (of_f * uv + uw) / uu : 0);
        }
        nearest.take(along(e.from, u, of_e), along(f.from, v, of_f), cross(u, v));
    }

    /// The projection of a corner to the other triangle's plane, if it lies in that triangle.
    static void of_corner_and_face(const vec3d& corner, const triangle3d& face, bool corner_is_of_s,
                                   near_points& nearest) noexcept {
        const vec3d u = face[1] - face[0], v = face[2] - face[0], w = corner - face[0];
        const vec3d n = cross(u, v);
        const double square = dot(n, n);
        const double of_u = dot(cross(w, v), n) / square, of_v = dot(cross(u, w), n) / square;
        if (!(of_u >= 0 && of_v >= 0 && of_u + of_v <= 1)) return;  // also if the face has no area
        const vec3d projection = along(along(face[0], u, of_u), v, of_v);
        corner_is_of_s ? nearest.take(corner, projection, n) : nearest.take(projection, corner, n);
    }

    triangle3d s_{}, t_{};  // relative to `origin_`
    vec3d origin_{};
    double tolerance_ = 0;
    bool in_range_ = false;
};

}  // namespace aabb
