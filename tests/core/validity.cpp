#include "../testing.hpp"

import aabb;

using namespace aabb;

TEST_CASE("boxes are closed") {
    const box unit{{0, 0, 0}, {1, 1, 1}};
    CHECK(overlaps(unit, {{1, 1, 1}, {2, 2, 2}}));
    CHECK_FALSE(overlaps(unit, {{std::nextafter(1.0F, 2.0F), 0, 0}, {2, 1, 1}}));
    CHECK(overlaps({{0, 0, 0}, {0, 0, 0}}, {{-0.0F, 0, 0}, {-0.0F, 0, 0}}));
}

TEST_CASE("boxes that are not boxes are refused by their index") {
    const box good{{0, 0, 0}, {1, 1, 1}};
    CHECK_NOTHROW(require_valid(std::vector<box>{good, {{1, 1, 1}, {1, 1, 1}}}));
    CHECK_REFUSED(require_valid(std::vector<box>{good, {{0, 2, 0}, {1, 1, 1}}}),
                  "box 1 is inverted: its minimum is above its maximum");
    CHECK_REFUSED(require_valid(std::vector<box>{{{0, NAN, 0}, {1, 1, 1}}}),
                  "box 0 has a coordinate that is not finite");
    CHECK_REFUSED(require_valid(std::vector<box>{{{0, 0, 0}, {1, INFINITY, 1}}}),
                  "box 0 has a coordinate that is not finite");
}

TEST_CASE("meshes that cannot be searched are refused") {
    const mesh good{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    CHECK_NOTHROW(require_valid(good));
    CHECK_REFUSED(require_valid(mesh{}), "the mesh has no triangles");
    mesh bad = good;
    bad.triangles.push_back({0, 1, 3});
    CHECK_REFUSED(require_valid(bad), "triangle 1 uses vertex 3, but there are only 3 vertices");
    bad = good;
    bad.vertices[2][1] = NAN;
    CHECK_REFUSED(require_valid(bad), "vertex 2 has a coordinate that is not finite");
}
