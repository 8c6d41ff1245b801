export module aabb.geometry:triangle_box;

import aabb.std;
import :box;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb::detail {

/// A triangle and its edges as seen from the centre of a box, and half the box's extents.
struct centred_triangle {
    triangle3f corner;
    std::array<vec3f, 3> edge;  // from corner i to corner i + 1
    vec3f half;
};

/// Does one of the nine products of an edge and an axis keep the triangle apart from the box?
[[nodiscard]] inline bool edge_separates(const centred_triangle& t, float slack) noexcept {
    bool apart = false;
    for (int i = 0; i < 3; ++i) {
        const vec3f& e = t.edge[static_cast<std::size_t>(i)];
        const vec3f& on = t.corner[i];
        const vec3f& off = t.corner[(i + 2) % 3];
        for (int k = 0; k < 3; ++k) {
            const int x = (k + 1) % 3;
            const int y = (k + 2) % 3;
            const float p = e[y] * on[x] - e[x] * on[y];
            const float q = e[y] * off[x] - e[x] * off[y];
            const float reach = t.half[x] * std::abs(e[y]) + t.half[y] * std::abs(e[x]) + slack;
            apart |= std::min(p, q) > reach || std::max(p, q) < -reach;
        }
    }
    return apart;
}

}  // namespace aabb::detail

export namespace aabb {

/// Do the closed triangle and the closed box share a point? A test for culling: it never says no when they do. Thirteen
/// separating axes (Akenine-Möller, "Fast 3D triangle-box overlap testing", 2001), in float, with a box grown so that
/// no rounding can part what meets.
///
/// How much, with u = 2^-24. Seen from the rounded centre c, the box lies within half extents h (1 + 2u), and each
/// coordinate v' = v - c of a corner is off by at most 1.01 u V, where V is the greatest |v'| on the axis; so if box
/// and triangle meet, then the triangle of the v' meets the box of half extents g = h (1 + 2u) + 1.01 u V.
/// - An edge axis compares P, two products of an edge E and a corner, with R = g_x |E_y| + g_y |E_x|. Computed, each
///   carries three roundings (edge, product, sum): off by at most 3.01 u (S + R) with S = V_x |E_y| + V_y |E_x|. This
///   is what R gains when each g grows by 4 u (V + g).
/// - The normal's axis carries seven: off by at most 7.1 u Σ N_k (V_k + g_k), where N is the normal with all its terms
///   added as magnitudes. `slack` times N covers it.
/// All together stays below g = h + s with s = 16 u (V + h), its own roundings included, and at least one denormal
/// where that underflows. Products that underflow add at most 2^-148, times the extent for the normal. Coordinates
/// above 2^40 might overflow and are never culled.
/// @param growth,least of the box: 16 u of where things lie, and at least a denormal. Less is for tests that show that
/// less is not enough.
[[nodiscard]] inline bool triangle_meets_box(const triangle3f& t, const box& b, float growth = 0x1p-20F,
                                             float least = 0x1p-149F) noexcept {
    if (!overlaps(bounds_of(t), b)) return false;
    constexpr float tiny = 0x1p-126F;
    detail::centred_triangle seen{};
    vec3f slack{};
    float size = 0;
    for (int k = 0; k < 3; ++k) {
        const float centre = b.min[k] / 2 + b.max[k] / 2;
        float furthest = 0;
        for (int i = 0; i < 3; ++i) {
            seen.corner[i][k] = t[i][k] - centre;
            furthest = std::max(furthest, std::abs(seen.corner[i][k]));
        }
        const float half = std::max(b.max[k] - centre, centre - b.min[k]);
        slack[k] = growth * (furthest + half) + least;
        seen.half[k] = half + slack[k];
        size += furthest + half;
    }
    if (!(size <= 0x1p40F)) return true;
    for (int i = 0; i < 3; ++i) seen.edge[static_cast<std::size_t>(i)] = seen.corner[(i + 1) % 3] - seen.corner[i];
    const auto& [e, f, last] = seen.edge;
    float distance = 0;
    float reach = tiny * (1 + size);
    for (int k = 0; k < 3; ++k) {
        const int x = (k + 1) % 3;
        const int y = (k + 2) % 3;
        const float p = e[x] * f[y];
        const float q = e[y] * f[x];
        distance += (p - q) * seen.corner[0][k];
        reach += std::abs(p - q) * seen.half[k] + (std::abs(p) + std::abs(q)) * slack[k];
    }
    return std::abs(distance) <= reach && !detail::edge_separates(seen, tiny);
}

/// The same axes as they were published, in float without any margin: it parts some triangles and boxes that touch. A
/// baseline. (Of the two ends of an edge, whose projections differ by rounding only, this may take the other one.)
[[nodiscard]] inline bool moller_triangle_meets_box(const triangle3f& t, const box& b) noexcept {
    detail::centred_triangle seen{};
    for (int k = 0; k < 3; ++k) {
        const float centre = (b.min[k] + b.max[k]) * 0.5F;
        seen.half[k] = (b.max[k] - b.min[k]) * 0.5F;
        for (int i = 0; i < 3; ++i) seen.corner[i][k] = t[i][k] - centre;
    }
    for (int i = 0; i < 3; ++i) seen.edge[static_cast<std::size_t>(i)] = seen.corner[(i + 1) % 3] - seen.corner[i];
    if (detail::edge_separates(seen, 0)) return false;
    const box around = bounds_of(seen.corner);
    for (int k = 0; k < 3; ++k)
        if (around.min[k] > seen.half[k] || around.max[k] < -seen.half[k]) return false;
    // The corners of the box furthest against and along the normal.
    const vec3f normal = cross(seen.edge[0], seen.edge[1]);
    vec3f lowest{};
    vec3f highest{};
    for (int k = 0; k < 3; ++k) {
        const float half = normal[k] > 0 ? seen.half[k] : -seen.half[k];
        lowest[k] = -half - seen.corner[0][k];
        highest[k] = half - seen.corner[0][k];
    }
    return dot(normal, lowest) <= 0 && dot(normal, highest) >= 0;
}

}  // namespace aabb
