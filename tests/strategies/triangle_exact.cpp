#include "../testing.hpp"

import aabb;
import aabb.triangle.exact;

// Known results; tests/validation compares with CGAL.

using aabb::triangle3d;
using aabb::triangle3f;
using aabb::vec3d;

namespace {

struct known_case {
    std::string what;
    triangle3d s;
    triangle3d t;
    bool intersect;
};

const triangle3d face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
const std::vector<known_case> known_cases = {
    {"through the face", face, {{{1, 1, -1}, {1, 1, 1}, {5, 5, 1}}}, true},
    {"beside the face", face, {{{3, 3, -1}, {3, 3, 1}, {5, 5, 1}}}, false},
    {"parallel", face, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}, false},
    {"corner on the face", face, {{{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}}, true},
    {"corner on the plane only", face, {{{3, 3, 0}, {3, 3, 1}, {2, 2, 1}}}, false},
    {"edge on edge in one point", face, {{{2, 2, -1}, {2, 2, 1}, {4, 4, 0}}}, true},
    {"edges along one line", face, {{{1, 0, 0}, {2, 0, 0}, {1, -1, 1}}}, true},
    {"edges along one line, apart", face, {{{5, 0, 0}, {6, 0, 0}, {-1, -1, 1}}}, false},
    {"shared corner", face, {{{4, 0, 0}, {5, 0, 1}, {5, 1, 1}}}, true},
    {"identical", face, face, true},
    {"coplanar, one inside", face, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, true},
    {"coplanar, edges cross only", face, {{{-1, 1, 0}, {5, 1, 0}, {-1, 2, 0}}}, true},
    {"coplanar, touching edges", face, {{{1, 3, 0}, {3, 1, 0}, {4, 4, 0}}}, true},
    {"coplanar, apart with boxes that overlap", face, {{{2, 3, 0}, {3, 2, 0}, {4, 4, 0}}}, false},
    {"point on the face", face, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, true},
    {"point off the face", face, {{{3, 3, 0}, {3, 3, 0}, {3, 3, 0}}}, false},
    {"point above the face", face, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, false},
    {"segment through the face", face, {{{1, 1, -1}, {1, 1, 2}, {1, 1, 0}}}, true},
    {"segment with one end on the face", face, {{{1, 1, 0}, {1, 1, 0}, {3, 3, 5}}}, true},
    {"segment that stops short of the face", face, {{{1, 1, 1}, {1, 1, 2}, {1, 1, 3}}}, false},
    {"segment past the face", face, {{{3, 3, -1}, {3, 3, 0}, {3, 3, 1}}}, false},
    {"segment in the plane, crossing", face, {{{-1, 1, 0}, {5, 1, 0}, {2, 1, 0}}}, true},
    {"segment in the plane, apart", face, {{{1, 4, 0}, {4, 1, 0}, {4, 1, 0}}}, false},
    {"segments that cross", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{0, 2, 1}, {2, 0, 1}, {2, 0, 1}}}, true},
    {"skew segments, crossing in every view",
     {{{0, 0, 0}, {4, 4, 4}, {4, 4, 4}}},
     {{{0, 3, 2}, {4, 1, 1}, {4, 1, 1}}},
     false},
    {"segments on one line, overlapping",
     {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
     {{{3, 3, 3}, {2, 2, 2}, {5, 5, 5}}},
     true},
    {"segments on one line, apart", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{3, 3, 3}, {4, 4, 4}, {5, 5, 5}}}, false},
    {"parallel segments", {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{1, 0, 0}, {3, 2, 2}, {3, 2, 2}}}, false},
    {"coincident points", {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}, {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}, true},
    {"a point inside a segment", {{{0, 0, 0}, {2, 2, 2}, {2, 2, 2}}}, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, true},
    {"a point beside a segment", {{{0, 0, 0}, {2, 2, 2}, {2, 2, 2}}}, {{{1, 1, 2}, {1, 1, 2}, {1, 1, 2}}}, false},
    {"negative zero", {{{-0.0, -0.0, -0.0}, {4, 0, -0.0}, {0, 4, 0}}}, {{{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}}, true},
};

triangle3d scaled(triangle3d t, double factor) {
    for (vec3d& p : t.corner)
        for (double& x : p.at) x *= factor;
    return t;
}

}  // namespace

TEST_CASE("known results hold at every scale of float and double") {
    for (const known_case& k : known_cases) {
        CAPTURE(k.what);
        for (const int exponent : {-1074, -1030, -700, -340, -149, 0, 120, 335, 1000})
            CHECK(aabb::exact_triangle::intersects(scaled(k.s, std::ldexp(1.0, exponent)),
                                                   scaled(k.t, std::ldexp(1.0, exponent))) == k.intersect);
        for (const float factor : {0x1p-149F, 1.0F, 0x1p120F}) {
            triangle3f s;
            triangle3f t;
            for (int i = 0; i < 3; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    s[i][axis] = static_cast<float>(k.s[i][axis]) * factor;
                    t[i][axis] = static_cast<float>(k.t[i][axis]) * factor;
                }
            CHECK(aabb::exact_triangle::intersects(s, t) == k.intersect);
        }
    }
}

TEST_CASE("one ulp decides") {
    const double above = std::nextafter(1.0, 2.0);
    const auto corner_at = [](double height) {
        return triangle3d{{{0.25, 0.25, height}, {0.25, 0.5, 2}, {0.5, 0.25, 2}}};
    };
    const triangle3d level{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
    CHECK(aabb::exact_triangle::intersects(level, corner_at(1.0)));
    CHECK_FALSE(aabb::exact_triangle::intersects(level, corner_at(above)));
    // The whole range of doubles in one pair: the corner lies above the face by the smallest of them.
    const triangle3d huge{{{-1e300, -1e300, 0}, {1e300, -1e300, 0}, {0, 1e300, 0}}};
    CHECK(aabb::exact_triangle::intersects(huge, corner_at(0)));
    CHECK_FALSE(aabb::exact_triangle::intersects(huge, corner_at(0x1p-1074)));
}
