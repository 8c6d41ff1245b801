#include <CGAL/Exact_rational.h>

#include "../compositions.hpp"
#include "../random_poses.hpp"
#include "pairs.hpp"
#include "support.hpp"

// Worst cases of the error bounds of filters: half of a bound would let a wrong sign or a missed pair through.

namespace {

using aabb::pose;
using aabb::pose_pair;
using aabb::triangle3d;
using aabb::vec3d;
using triangle_pairs::generator;

aabb::lanes<double> lowest(const triangle3d& s, const triangle3d& t) {
    aabb::lanes<double> low = coordinates(s[0]);
    for (const vec3d* p : {&s[1], &s[2], &t[0], &t[1], &t[2]}) low = coordinates(*p) < low ? coordinates(*p) : low;
    return low;
}
aabb::lanes<double> highest(const triangle3d& s, const triangle3d& t) {
    aabb::lanes<double> high = coordinates(s[0]);
    for (const vec3d* p : {&s[1], &s[2], &t[0], &t[1], &t[2]}) high = coordinates(*p) > high ? coordinates(*p) : high;
    return high;
}

aabb::mesh mesh_at(const vec3d& point) {
    aabb::mesh m{{}, {{0, 1, 2}}};
    set_vertices(m, {point, point, point});
    return m;
}

}  // namespace

TEST_CASE("a turn and a side whose signs rounding inverts are decided exactly") {
    // Found by a search: the errors of the computed values are 5.99 u E E and 11.85 u E E E.
    const triangle3d s{{{-0x1.3f9d0d66bda74p-2, 0x1.1644e15d7b81p-4, 0},
                        {0x1.609b351a086f9p-1, -0x1.babef1ea2eb25p-2, 0},
                        {0x1.609b351a086f7p-1, -0x1.babef1ea2eb23p-2, 0}}};
    const auto across = [&](int i, int k) { return s[i][k] - s[0][k]; };
    REQUIRE((across(1, 0) * across(2, 1) - across(1, 1) * across(2, 0) > 0) != (exact_turn(s[0], s[1], s[2], 2) > 0));
    CHECK(aabb::orientations(s, s, lowest(s, s), highest(s, s)).turn(s[0], s[1], s[2], 2) ==
          exact_turn(s[0], s[1], s[2], 2));

    const triangle3d t{{{0x1.1ffff3f7dbd2dp-1, 0x1.01dffed27ea1cp-4, 0x1.11f684b1867bp-1},
                        {-0x1.cbd99ea1f1454p-2, 0x1.209049c0e6a7cp-1, 0x1.1eee2316af1d8p-5},
                        {-0x1.cbd99e3dabd14p-2, 0x1.0418942bfdbe9p-4, 0x1.1eee54856a458p-5}}};
    const vec3d d{-0x1.cbd99e9d5dd58p-2, 0x1.1c69a11d06f4p-1, 0x1.1eee23ef81688p-5};
    const triangle3d other{{d, d, d}};
    const int side = exact_side(t[0], t[1], t[2], d);
    REQUIRE((dot(cross(t[1] - t[0], t[2] - t[0]), d - t[0]) > 0) != (side > 0));
    CHECK(aabb::orientations(t, other, lowest(t, other), highest(t, other)).side(t[0], t[1], t[2], other[0]) == side);
}

TEST_CASE("signs stay undecided as long as the errors of coordinates may change them, and no longer") {
    // The four corners of a square, and three on a line, each moved by `by` along an axis so that the determinant grows
    // most. Moved back by as much, they have the determinant 0.
    constexpr double error = 0x1p-20;
    for (int axis = 0; axis < 3; ++axis)
        for (const double by : {0.99 * error, 1.01 * error}) {
            CAPTURE(axis, by);
            const auto point = [&](double height, double x, double y) {
                vec3d p{};
                p[axis] = height;
                p[(axis + 1) % 3] = x;
                p[(axis + 2) % 3] = y;
                return p;
            };
            vec3d errors{};
            errors[axis] = error;
            const triangle3d s{{point(by, 0, 0), point(-by, 1, 0), point(by, 1, 1)}};
            const triangle3d t{{point(-by, 0, 1), point(by, 0.5, 0.5), point(-by, 0.5, 0.5)}};
            const auto signs = [&] {
                return aabb::filtered_orientations<false>(s, t, lowest(s, t), highest(s, t), errors);
            };
            auto of_side = signs();
            CHECK((of_side.side(s[0], s[1], s[2], t[0]) == 0) == (by < error));
            CHECK(of_side.unsure() == (by < error));
            auto of_turn = signs();
            CHECK((of_turn.turn(s[0], s[2], t[2], (axis + 1) % 3) == 0) == (by < error));
            CHECK(of_turn.unsure() == (by < error));
        }
}

TEST_CASE("triangles whose normals overflow in float are left to the exact test") {
    // A component of the normal of s overflows, but no product of extents.
    const aabb::mesh s{{{0, 0x1.f0a672p61F, 0}, {1, 0x1.788336p63F, 0x1.5c1f06p64F}, {1, 0, 0x1.5c1f06p64F}},
                       {{0, 1, 2}}};
    const aabb::mesh t{{{0.5F, 0x1.788336p62F, 0x1.5c1f06p64F},
                        {0.5F, 0x1.788336p62F, 0x1.167f38p61F},
                        {0.5F, 0x1.800af4p62F, 0x1.167f38p61F}},
                       {{0, 1, 2}}};
    for (const aabb::composition& c : exact_local_compositions()) {
        CAPTURE(text_of_local(c));
        const auto stage = local_of(c, aabb::instrumentation::none);
        CHECK(pairs_of(*stage, s, {}, t, {}).size() == 1);
        CHECK(pairs_of(*stage, t, {}, s, {}).size() == 1);
    }
}

TEST_CASE("corners whose rounded world coordinates lie in the wrong order are ordered exactly, and not apart") {
    // Found by a search: the coordinates are off by 2.6 u and -3.4 u.
    const std::array<double, 9> matrix{
        0x1.027dd9f120b27p0, 0x1.bde5c08b791f7p-1, 0x1.cb91ce361824p-1, 0, 1, 0, 0, 0, 1};
    const pose_pair poses{{matrix, {0, 0, 0}}, {matrix, {0x1.7cfc28f5c28f6p-45, 0, 0}}};
    const vec3d p{0x1.0000000000237p0, 0x1.3d85e56a538f4p-49, -0x1.13ba2d40110dcp-48};
    const vec3d q{0x1.000000000016p0, 0x1.51b8cd26d2516p-48, 0x1.95fd867aea46p-52};
    const triangle3d s{{p, {0, 1, 0}, {0, 0, 1}}}, t{{q, {0, 1, 0}, {0, 0, 1}}};
    aabb::posed_orientations signs(poses, s, t);
    REQUIRE(signs.s()[0][0] - signs.t()[0][0] == 6 * 0x1p-53);
    CHECK(signs.exact().order(0, 3, 0) <= 0);
    CHECK(signs.order(signs.s()[0], signs.t()[0], 0) == signs.exact().order(0, 3, 0));

    // As rounded, all of s lies beyond all of t along x.
    constexpr double e = 0x1p-20;
    const triangle3d beyond{{p, {1 + e, e, 0}, {1 + e, 0, e}}}, before{{q, {0.5, 0, 0}, {0.5, e, 0}}};
    CHECK_FALSE(aabb::posed_orientations(poses, beyond, before).are_apart());
}

TEST_CASE("the image of a vertex is off by hardly less than its bound") {
    // Rounded down by almost half a unit in the last place, and up.
    for (const double at : {1 + 0x1p-24 - 0x1p-50, 1 + 0x1p-24 + 0x1p-50}) {
        const aabb::relative_pose to_a({}, {pose{}.rotation, {at, -at, at}}, {{0, 0, 0}, {0, 0, 0}});
        for (int k = 0; k < 3; ++k) {
            const double error = std::abs(to_a(aabb::vec3f{})[k] - (k == 1 ? -at : at));
            CHECK(error <= to_a.image_error()[k]);
            CHECK(error > 0.99 * to_a.image_error()[k]);
        }
    }
}

TEST_CASE("floats of vertices are off by at most their bound, and hardly less") {
    using number = CGAL::Exact_rational;
    generator g(545);
    for (const double size : {1.0, 1e-40, 1e200})
        for (const double offset : {0.0, 1e3, 1e9}) {
            CAPTURE(size, offset);
            std::vector<vec3d> vertices(1000);
            for (vec3d& v : vertices)
                for (double& x : v.at) x = size * (offset + std::uniform_real_distribution<double>(1, 2)(g));
            const auto frame = aabb::vertex_frame::around(vertices);
            for (int k = 0; k < 3; ++k) {
                number worst = 0;
                for (const vec3d& v : vertices) {
                    const number image = number(frame.origin[k]) + number(frame.scale) * number(frame(v)[k]);
                    worst = std::max<number>(worst, abs(number(v[k]) - image));
                }
                const number bound = number(frame.scale) * number(frame.rounding[k]);
                CHECK(worst <= bound);
                CHECK(worst >= bound * number(0.9));
            }
        }
}

TEST_CASE("points that coincide far from their origins are found whatever the order of the terms") {
    // The columns of one matrix are those of the other in another order, as are the coordinates.
    generator g(546);
    const auto real = [&](double most) { return std::uniform_real_distribution<double>(-most, most)(g); };
    for (int i = 0; i < 300; ++i) {
        const vec3d p{real(1e6), real(1e6), real(1e6)};
        pose a{.translation = {real(1e6), real(1e6), real(1e6)}};
        for (double& r : a.rotation) r = real(1);
        pose b = a;
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t j = 0; j < 3; ++j) b.rotation[3 * row + j] = a.rotation[3 * row + (j + 1) % 3];
        const aabb::mesh at_p = mesh_at(p), at_q = mesh_at({p[1], p[2], p[0]});
        for (const aabb::composition& c : exact_local_compositions()) {
            CAPTURE(i, text_of_local(c));
            const auto stage = local_of(c, aabb::instrumentation::none);
            REQUIRE(pairs_of(*stage, at_p, a, at_q, b).size() == 1);
        }
    }
}

TEST_CASE("a point at a corner is found at poses close to singular ones") {
    // The corner (1, 1, 1) is mapped close to 0: the inverse, off by some 2^-23, takes the point there back to it.
    generator g(547);
    const aabb::mesh with_corner{{{1, 1, 1}, {-1, 0, 0.5F}, {0, -1, -1}}, {{0, 1, 2}}};
    for (int i = 0; i < 100; ++i) {
        pose p;
        vec3d image{};
        for (std::size_t row = 0; row < 3; ++row) {
            const double x = triangle_pairs::integer(g, -1 << 26, 1 << 26) * 0x1p-26;
            const double y = triangle_pairs::integer(g, -1 << 26, 1 << 26) * 0x1p-26;
            const double sum = triangle_pairs::integer(g, -8, 8) * 0x1p-33;
            p.rotation[3 * row] = x;
            p.rotation[3 * row + 1] = y;
            p.rotation[3 * row + 2] = sum - x - y;
            image[static_cast<int>(row)] = sum;
        }
        const aabb::mesh at_image = mesh_at(image);
        for (const aabb::composition& c : exact_local_compositions()) {
            CAPTURE(i, text_of_local(c));
            const auto stage = local_of(c, aabb::instrumentation::none);
            REQUIRE(pairs_of(*stage, with_corner, p, at_image, {}).size() == 1);
            REQUIRE(pairs_of(*stage, at_image, {}, with_corner, p).size() == 1);
        }
    }
}
