#include <catch2/catch_test_macros.hpp>

import aabb;
import aabb.triangle.moller;

// The baseline must err as the original does.

using aabb::moller_triangle;
using aabb::triangle3f;

namespace {
const triangle3f face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
}

TEST_CASE("Möller's test decides the clear cases") {
    CHECK(moller_triangle{}.intersects(face, {{{1, 1, -1}, {1, 1, 1}, {5, 5, 1}}}));
    CHECK_FALSE(moller_triangle{}.intersects(face, {{{3, 3, -1}, {3, 3, 1}, {5, 5, 1}}}));
    CHECK_FALSE(moller_triangle{}.intersects(face, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}));
    CHECK(moller_triangle{}.intersects(face, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}));
    CHECK(moller_triangle{}.intersects({{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, face));
    CHECK_FALSE(moller_triangle{}.intersects(face, {{{2, 3, 0}, {3, 2, 0}, {4, 4, 0}}}));
    CHECK(moller_triangle{}.intersects(face, {{{1, 0, 0}, {2, 0, 0}, {1, -1, 1}}}));
}

TEST_CASE("Möller's epsilon is absolute and applies to distances times the normal's length") {
    // The normal is (0, 0, 1), so the distance is the height itself; both triangles seem to lie in one plane.
    const triangle3f unit{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const auto hovering = [](float height) {
        return triangle3f{{{0.25F, 0.25F, height}, {0.5F, 0.25F, height}, {0.25F, 0.5F, height}}};
    };
    CHECK(moller_triangle{}.intersects(unit, hovering(9e-7F)));
    // The float next to 1e-6 lies below it.
    CHECK(moller_triangle{}.intersects(unit, hovering(1e-6F)));
    CHECK_FALSE(moller_triangle{}.intersects(unit, hovering(1.1e-6F)));
}

TEST_CASE("Möller's test loses a corner inside a triangle whose products underflow") {
    const triangle3f outer{{{0, 0, 0}, {4e-12F, 0, 0}, {0, 4e-12F, 0}}};
    const triangle3f inner{{{1e-12F, 1e-12F, 0}, {2e-12F, 1e-12F, 0}, {1e-12F, 2e-12F, 0}}};
    CHECK_FALSE(moller_triangle{}.intersects(outer, inner));
}

TEST_CASE("Möller's test says yes when it has overflowed") {
    const triangle3f s{{{-1e38F, -1e38F, 1e37F}, {1e38F, -1e38F, 2e37F}, {0, 1e38F, 3e37F}}};
    const triangle3f t{{{9e37F, 9e37F, -1e38F}, {9e37F, 9e37F, 1e38F}, {8e37F, 9e37F, 1e38F}}};
    CHECK(moller_triangle{}.intersects(s, t));
}

TEST_CASE("Möller's test looks along y at a triangle without a normal") {
    const triangle3f segment{{{0, 0, -1}, {0, 0, 1}, {0, 0, 1}}};
    CHECK_FALSE(moller_triangle{}.intersects(segment, {{{1, -1, 0}, {2, 1, 0}, {1, 1, 0}}}));  // along x they cross
    CHECK(moller_triangle{}.intersects(segment, {{{-1, 1, 0}, {1, 1, 0}, {1, 2, 0}}}));        // along y they cross
}
