module;
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

export module aabb.triangle.moller;

import aabb;

export namespace aabb {

/// Möller's interval test ("A fast triangle-triangle intersection test", 1997), in float, with the absolute epsilon of
/// the original: signed distances (scaled by the normal's length) below 1e-6 count as zero. Inexact: on small triangles
/// the epsilon takes near misses for coplanar hits. When to use: as the baseline it is. So that it errs as the original
/// does, sums keep its order, ties its choice of axis, and products that underflow or overflow its answers.
struct moller_triangle {
    static constexpr std::string_view name = "moller";
    static constexpr std::string_view summary =
        "Möller's interval test in float with its absolute epsilon: inexact, the classic baseline";
    static constexpr bool exact = false;

    [[nodiscard]] static bool intersects(const triangle3f& s, const triangle3f& t) noexcept {
        const vec3f normal_t = cross(t[1] - t[0], t[2] - t[0]);
        const std::array<float, 3> s_to_t = distances(s, t[0], normal_t);
        if (on_one_side(s_to_t)) return false;
        const vec3f normal_s = cross(s[1] - s[0], s[2] - s[0]);
        const std::array<float, 3> t_to_s = distances(t, s[0], normal_s);
        if (on_one_side(t_to_s)) return false;
        if (s_to_t == std::array{0.0F, 0.0F, 0.0F} || t_to_s == std::array{0.0F, 0.0F, 0.0F})
            return coplanar_intersects(s, t, normal_s);
        // Both triangles cut the line of the two planes; the test compares their intervals on the axis along which the
        // line runs furthest.
        const int axis = largest(cross(normal_s, normal_t));
        const auto [s_low, s_high] = interval(s, s_to_t, axis);
        const auto [t_low, t_high] = interval(t, t_to_s, axis);
        return !(s_high < t_low || t_high < s_low);  // not `>=`: after an overflow to NaN the original says yes
    }

private:
    static constexpr double epsilon = 1e-6;  // not float, which lies a little lower

    [[nodiscard]] static std::array<float, 3> distances(const triangle3f& s, const vec3f& on_plane,
                                                        const vec3f& normal) noexcept {
        const float offset = -dot(normal, on_plane);
        std::array<float, 3> d{};
        for (int i = 0; i < 3; ++i) {
            const float distance = dot(normal, s[i]) + offset;
            d[static_cast<std::size_t>(i)] = std::abs(distance) < epsilon ? 0 : distance;
        }
        return d;
    }

    [[nodiscard]] static bool on_one_side(const std::array<float, 3>& d) noexcept {
        return (d[0] > 0 && d[1] > 0 && d[2] > 0) || (d[0] < 0 && d[1] < 0 && d[2] < 0);
    }

    [[nodiscard]] static int largest(const vec3f& v) noexcept {
        int k = std::abs(v[1]) > std::abs(v[0]) ? 1 : 0;
        return std::abs(v[2]) > std::abs(v[k]) ? 2 : k;
    }

    /// Where the triangle cuts the line of the planes, in the coordinate `axis`. `d` are the distances of the corners
    /// from the other plane: not all zero, not all of one sign.
    [[nodiscard]] static std::pair<float, float> interval(const triangle3f& s, const std::array<float, 3>& d,
                                                          int axis) noexcept {
        // The corner that the plane cuts off from the other two.
        int alone = 0;
        if (d[0] * d[1] > 0)
            alone = 2;
        else if (d[0] * d[2] > 0)
            alone = 1;
        else if (d[1] * d[2] > 0 || d[0] != 0)
            alone = 0;
        else
            alone = d[1] != 0 ? 1 : 2;
        const auto at = [&](int i) { return s[i][axis]; };
        const auto distance = [&](int i) { return d[static_cast<std::size_t>(i)]; };
        const auto cut = [&](int other) {
            return at(alone) + (at(other) - at(alone)) * distance(alone) / (distance(alone) - distance(other));
        };
        const float p = cut(alone == 0 ? 1 : 0);
        const float q = cut(alone == 2 ? 1 : 2);
        return p > q ? std::pair{q, p} : std::pair{p, q};
    }

    /// Both triangles in the plane of the normal: edges against edges, then each triangle's corner in the other, on the
    /// axis plane in which their area is largest.
    [[nodiscard]] static bool coplanar_intersects(const triangle3f& s, const triangle3f& t,
                                                  const vec3f& normal) noexcept {
        // Of equal components the original drops the later axis, but y rather than z.
        const vec3f length{std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
        const int rest = length[2] > length[1] ? 2 : 1;
        const int dropped = length[0] > length[1] ? (length[0] > length[2] ? 0 : 2) : rest;
        const int x = dropped == 0 ? 1 : 0;
        const int y = dropped == 2 ? 1 : 2;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (edges_cross(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3], x, y)) return true;
        return corner_inside(s[0], t, x, y) || corner_inside(t[0], s, x, y);
    }

    [[nodiscard]] static bool edges_cross(const vec3f& p, const vec3f& p_end, const vec3f& q, const vec3f& q_end, int x,
                                          int y) noexcept {
        const float ax = p_end[x] - p[x];
        const float ay = p_end[y] - p[y];
        const float bx = q[x] - q_end[x];
        const float by = q[y] - q_end[y];
        const float cx = p[x] - q[x];
        const float cy = p[y] - q[y];
        const float f = ay * bx - ax * by;
        const float d = by * cx - bx * cy;
        const float e = ax * cy - ay * cx;
        if (f > 0) return d >= 0 && d <= f && e >= 0 && e <= f;
        return f < 0 && d <= 0 && d >= f && e <= 0 && e >= f;
    }

    /// Strictly inside, by the lines of the edges. The products of small triangles underflow, and the answer is no.
    [[nodiscard]] static bool corner_inside(const vec3f& p, const triangle3f& t, int x, int y) noexcept {
        std::array<float, 3> side{};
        for (int i = 0; i < 3; ++i) {
            const vec3f& from = t[i];
            const vec3f& to = t[(i + 1) % 3];
            const float a = to[y] - from[y];
            const float b = -(to[x] - from[x]);
            const float c = -a * from[x] - b * from[y];
            side[static_cast<std::size_t>(i)] = a * p[x] + b * p[y] + c;
        }
        return side[0] * side[1] > 0 && side[0] * side[2] > 0;
    }
};

static_assert(TrianglePolicy<moller_triangle>);

}  // namespace aabb
