#include "support.hpp"

import aabb.validation;

using namespace aabb;

namespace {

using vec3i = vec3<std::int64_t>;
using triangle3i = triangle3<std::int64_t>;

bool are_separated_along(const triangle3i& s, const triangle3i& t, const vec3i& axis) {
    const auto [s_low, s_high] = std::minmax({dot(axis, s[0]), dot(axis, s[1]), dot(axis, s[2])});
    const auto [t_low, t_high] = std::minmax({dot(axis, t[0]), dot(axis, t[1]), dot(axis, t[2])});
    return s_high < t_low || t_high < s_low;
}

/// Two triangles, degenerate ones too, are disjoint if they are separated along the line between their nearest points,
/// each on a corner, an edge or a face. Integers, so nothing is rounded; no code in common with CGAL.
bool intersect_by_definition(const triangle3i& s, const triangle3i& t) {
    std::vector<vec3i> axes = {cross(s[1] - s[0], s[2] - s[0]), cross(t[1] - t[0], t[2] - t[0])};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            axes.push_back(cross(s[(i + 1) % 3] - s[i], t[(j + 1) % 3] - t[j]));
            const vec3i between = t[j] - s[i];
            axes.push_back(between);
            for (const triangle3i* u : {&s, &t})
                for (int k = 0; k < 3; ++k) {
                    const vec3i edge = (*u)[(k + 1) % 3] - (*u)[k];
                    axes.push_back(cross(edge, cross(between, edge)));
                }
        }
    return std::ranges::none_of(axes, [&](const vec3i& axis) { return are_separated_along(s, t, axis); });
}

template <class Real>
triangle3<Real> scaled(const triangle3i& t, Real factor) {
    triangle3<Real> result;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) result[i][k] = static_cast<Real>(t[i][k]) * factor;
    return result;
}

triangle3i lattice_triangle(std::mt19937& random, std::uint32_t side) {
    triangle3i t{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) t[i][k] = random() % side;
    return t;
}

}  // namespace

TEST_CASE("the exact decision equals the definition on lattices full of ties") {
    std::mt19937 random(4);
    int hits = 0;
    for (int round = 0; round < 20000; ++round) {
        // Side 2 and 3: mostly touching, coplanar and degenerate; side 6: mostly general.
        const std::uint32_t side = 2 + static_cast<std::uint32_t>(round) % 5;
        triangle3i s = lattice_triangle(random, side);
        triangle3i t = lattice_triangle(random, side);
        if (round % 3 == 0)
            for (int i = 0; i < 3; ++i) s[i][2] = t[i][2] = 0;  // coplanar
        const bool truth = intersect_by_definition(s, t);
        hits += truth;
        const bool decision = exactly_intersect(scaled(s, 1.0F), scaled(t, 1.0F));
        if (decision != truth) FAIL("round " << round << ": " << decision << " instead of " << truth);
        REQUIRE(exactly_intersect(scaled(t, 0x1p-120F), scaled(s, 0x1p-120F)) == truth);
        REQUIRE(exactly_intersect(scaled(t, 0x1p-149F), scaled(s, 0x1p-149F)) == truth);
        REQUIRE(exactly_intersect(scaled(s, 0x1p+120F), scaled(t, 0x1p+120F)) == truth);
        REQUIRE(exactly_intersect(scaled(s, 0x1p-1060), scaled(t, 0x1p-1060)) == truth);
        REQUIRE(exactly_intersect(scaled(s, 0x1p+1020), scaled(t, 0x1p+1020)) == truth);
    }
    REQUIRE(hits > 4000);
    REQUIRE(hits < 16000);
}

TEST_CASE("the exact decision depends on the last bit") {
    const triangle3d floor{{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}}};
    const auto above = [](double z) { return triangle3d{{{1, 1, z}, {1, 0.5, 1}, {0.5, 1, 1}}}; };
    REQUIRE(exactly_intersect(floor, above(0)));
    REQUIRE(exactly_intersect(floor, above(-std::numeric_limits<double>::denorm_min())));
    REQUIRE(!exactly_intersect(floor, above(std::numeric_limits<double>::denorm_min())));
    // The sloping edge, at a point that double cannot represent: 1/3 is above its nearest double.
    const double third = 1.0 / 3.0;
    const triangle3d slope{{{0, 0, 0}, {3, 1, 0}, {3, 5, 0}}};
    REQUIRE(!exactly_intersect(slope, triangle3d{{{1, third, 0}, {1, third, 0}, {1, third, 0}}}));
    REQUIRE(exactly_intersect(slope, triangle3d{{{1, third, 0}, {1, third + 1e-16, 0}, {1, third, 0}}}));
}
