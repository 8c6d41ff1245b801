export module aabb.geometry:triangle_box;

import aabb.std;
import :box;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb::detail {

/// A triangle and its edges relative to the centre of a box, and half the box's extents.
struct centred_triangle {
    triangle3f corner;
    std::array<vec3f, 3> edge;  // from corner i to corner i + 1
    vec3f half;
};

/// Whether one of the nine cross products of an edge and an axis separates the triangle from the box by over `slack`.
[[nodiscard]] inline bool edge_separates(const centred_triangle& t, float slack) noexcept {
    bool separated = false;
    for (int i = 0; i < 3; ++i) {
        const vec3f& e = t.edge[static_cast<std::size_t>(i)];
        const vec3f& start = t.corner[i];
        const vec3f& opposite = t.corner[(i + 2) % 3];
        for (int k = 0; k < 3; ++k) {
            const int x = (k + 1) % 3, y = (k + 2) % 3;
            const float p = e[y] * start[x] - e[x] * start[y];
            const float q = e[y] * opposite[x] - e[x] * opposite[y];
            const float radius = t.half[x] * std::abs(e[y]) + t.half[y] * std::abs(e[x]) + slack;
            separated |= std::min(p, q) > radius || std::max(p, q) < -radius;
        }
    }
    return separated;
}

}  // namespace aabb::detail

export namespace aabb {

/// Whether a closed triangle and a closed box share a point. A conservative test for culling without false negatives:
/// thirteen separating axes (Akenine-Möller, "Fast 3D triangle-box overlap testing", 2001) in float, with a box grown
/// so that rounding errors cannot separate it from a triangle that it intersects.
///
/// Bounds, with u = 2^-24. Relative to the rounded centre c, the box lies within half extents h (1 + 2u), and each
/// coordinate v' = v - c of a corner has an error of at most 1.01 u V, where V is the greatest |v'| on the axis; so if
/// box and triangle intersect, the triangle of the v' intersects the box of half extents g = h (1 + 2u) + 1.01 u V.
/// - An edge axis compares P, two products of an edge E and a corner, with R = g_x |E_y| + g_y |E_x|. Each has three
///   roundings (edge, product, sum), an error of at most 3.01 u (S + R) with S = V_x |E_y| + V_y |E_x|. This is what R
///   gains if each g grows by 4 u (V + g).
/// - The normal's axis has seven, an error of at most 7.1 u Σ N_k (V_k + g_k), where N is the normal with all its terms
///   added as magnitudes. `slack` times N covers it.
/// The total stays below g = h + s with s = 16 u (V + h), including its own roundings, and at least one denormal if
/// that underflows. Products that underflow add at most 2^-148, times the extent for the normal. Coordinates above 2^40
/// might overflow and are never culled.
/// @param growth,least of the box: 16 u of the coordinates, and at least a denormal. Tests pass too little.
[[nodiscard]] inline bool triangle_meets_box(const triangle3f& t, const box& b, float growth = 0x1p-20F,
                                             float least = 0x1p-149F) noexcept {
    if (!overlaps(bounds_of(t), b)) return false;
    constexpr float tiny = 0x1p-126F;  // more than products that underflow add
    detail::centred_triangle local{};
    vec3f slack{};
    float size = 0;
    for (int k = 0; k < 3; ++k) {
        const float centre = b.min[k] / 2 + b.max[k] / 2;
        float furthest = 0;
        for (int i = 0; i < 3; ++i) {
            local.corner[i][k] = t[i][k] - centre;
            furthest = std::max(furthest, std::abs(local.corner[i][k]));
        }
        const float half = std::max(b.max[k] - centre, centre - b.min[k]);
        slack[k] = growth * (furthest + half) + least;
        local.half[k] = half + slack[k];
        size += furthest + half;
    }
    if (!(size <= 0x1p40F)) return true;
    for (int i = 0; i < 3; ++i) local.edge[static_cast<std::size_t>(i)] = local.corner[(i + 1) % 3] - local.corner[i];
    const auto& [e, f, last] = local.edge;
    float distance = 0;
    float radius = tiny * (1 + size);
    for (int k = 0; k < 3; ++k) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        const float p = e[x] * f[y];
        const float q = e[y] * f[x];
        distance += (p - q) * local.corner[0][k];
        radius += std::abs(p - q) * local.half[k] + (std::abs(p) + std::abs(q)) * slack[k];
    }
    return std::abs(distance) <= radius && !detail::edge_separates(local, tiny);
}

/// The same axes as published, in float without a margin, as a baseline: it has false negatives for touching triangles
/// and boxes. (Both ends of an edge project to the same point but for rounding; the published code may use either end.)
[[nodiscard]] inline bool moller_triangle_meets_box(const triangle3f& t, const box& b) noexcept {
    detail::centred_triangle local{};
    for (int k = 0; k < 3; ++k) {
        const float centre = (b.min[k] + b.max[k]) * 0.5F;
        local.half[k] = (b.max[k] - b.min[k]) * 0.5F;
        for (int i = 0; i < 3; ++i) local.corner[i][k] = t[i][k] - centre;
    }
    for (int i = 0; i < 3; ++i) local.edge[static_cast<std::size_t>(i)] = local.corner[(i + 1) % 3] - local.corner[i];
    if (detail::edge_separates(local, /*slack=*/0)) return false;
    const box bounds = bounds_of(local.corner);
    for (int k = 0; k < 3; ++k)
        if (bounds.min[k] > local.half[k] || bounds.max[k] < -local.half[k]) return false;
    // The corners of the box that are extreme along the normal.
    const vec3f normal = cross(local.edge[0], local.edge[1]);
    vec3f lowest{}, highest{};
    for (int k = 0; k < 3; ++k) {
        const float half = normal[k] > 0 ? local.half[k] : -local.half[k];
        lowest[k] = -half - local.corner[0][k];
        highest[k] = half - local.corner[0][k];
    }
    return dot(normal, lowest) <= 0 && dot(normal, highest) >= 0;
}

}  // namespace aabb
