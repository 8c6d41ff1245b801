#include <rapidcheck.h>

#include <set>

#include "../compositions.hpp"
#include "../random_poses.hpp"
#include "support.hpp"

import aabb.build.median;
import aabb.touching;
import aabb.tree.canonical;

// Solids that are unions of unit cubes: how two of them lie follows from the sets of cubes. Their faces, edges and
// vertices coincide in every way, so that hardly any triangles pass through each other where surfaces cross.

namespace {

using aabb::contact_relation;
using aabb::index_pair;
using aabb::mesh;
using aabb::pose;
using aabb::vec3f;
using cell = std::array<int, 3>;
using cells = std::set<cell>;
using solid = aabb::enclosure<aabb::canonical_tree>;

cell beside(cell c, std::size_t axis, int step) {
    c[axis] += step;
    return c;
}

/// Up to `most` cubes, each but the first at a face of another one.
cells any_blob(int most, const cell& around) {
    cells blob{{around[0] + *rc::gen::inRange(0, 2), around[1] + *rc::gen::inRange(0, 2), around[2]}};
    const int count = *rc::gen::inRange(1, most + 1);
    while (static_cast<int>(blob.size()) < count) {
        auto at = blob.begin();
        std::advance(at, *rc::gen::inRange<std::size_t>(0, blob.size()));
        blob.insert(beside(*at, *rc::gen::inRange<std::size_t>(0, 3), *rc::gen::element(-1, 1)));
    }
    return blob;
}

/// A box of cubes.
cells any_box(int most, const cell& around) {
    cell low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = around[k] + *rc::gen::inRange(0, 2);
        high[k] = low[k] + *rc::gen::inRange(1, most + 1);
    }
    cells box;
    for (int x = low[0]; x < high[0]; ++x)
        for (int y = low[1]; y < high[1]; ++y)
            for (int z = low[2]; z < high[2]; ++z) box.insert({x, y, z});
    return box;
}

vec3f corner_at(const cell& c) {
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

/// The surface of the cubes: two triangles for each face between a cube and none.
mesh surface_of(const cells& blob, bool faces_inward) {
    mesh m;
    for (const cell& c : blob)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                if (blob.contains(beside(c, axis, step))) continue;
                const cell origin = step > 0 ? beside(c, axis, 1) : c;
                const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                const std::array square{corner_at(origin), corner_at(beside(origin, u, 1)),
                                        corner_at(beside(beside(origin, u, 1), v, 1)), corner_at(beside(origin, v, 1))};
                const bool is_up = (step > 0) != faces_inward;
                const std::size_t first = static_cast<std::size_t>(c[0] + c[1] + c[2]) % 2;  // either diagonal
                for (const std::size_t half : {std::size_t{1}, std::size_t{2}}) {
                    const vec3f &p = square[first], &q = square[(first + half) % 4],
                                &r = square[(first + half + 1) % 4];
                    add_triangle(m, p, is_up ? q : r, is_up ? r : q);
                }
            }
    return m;
}

/// A box of cubes, with two triangles for each of its faces.
mesh coarse_surface_of(const cells& box) {
    const cell low = *box.begin(), high = *box.rbegin();
    mesh m = aabb::unit_cube();
    for (vec3f& v : m.vertices)
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            v[k] = static_cast<float>(v[k] == 0 ? low[axis] : high[axis] + 1);
        }
    return m;
}

contact_relation expected_relation(const cells& a, const cells& b) {
    std::size_t common = 0;
    for (const cell& c : a) common += b.count(c);
    if (common == 0) return contact_relation::touching;
    if (common == a.size()) return common == b.size() ? contact_relation::equal : contact_relation::a_inside_b;
    return common == b.size() ? contact_relation::b_inside_a : contact_relation::crossing;
}

std::vector<aabb::component_contact> contacts(const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b) {
    const auto stage = aabb::compose_local_detection({}, aabb::instrumentation::none);
    const std::vector<index_pair> hits = aabb::pairs_of(*stage, a, pose_a, b, pose_b);
    const solid of_a(a, aabb::median_build{}), of_b(b, aabb::median_build{});
    aabb::contact_surface<aabb::canonical_tree> surface_a(of_a), surface_b(of_b);
    return contacts_of(surface_a, pose_a, surface_b, pose_b, hits);
}

mesh scaled(const mesh& other, float scale, const vec3f& shift) {
    mesh m = other;
    for (vec3f& v : m.vertices)
        for (int k = 0; k < 3; ++k) v[k] = scale * v[k] + shift[k];
    return m;
}

}  // namespace

// With RC_PARAMS=max_success=100000 in the environment, 100,000 pairs.
TEST_CASE("solids whose surfaces meet touch, cross or lie inside each other as their cubes do") {
    std::map<contact_relation, std::size_t> counts;
    std::size_t apart = 0, undecided = 0;
    REQUIRE(rc::check([&] {
        const auto make = [&](const cell& around, cells& blob, bool inward) {
            switch (*rc::gen::inRange(0, 3)) {
                case 0: blob = any_blob(8, around); return surface_of(blob, inward);
                case 1: blob = any_box(3, around); return surface_of(blob, inward);
                default: blob = any_box(3, around); return coarse_surface_of(blob);
            }
        };
        cells of_a, of_b;
        const mesh a = make({0, 0, 0}, of_a, *rc::gen::arbitrary<bool>());
        const mesh b = make({*rc::gen::inRange(0, 3), *rc::gen::inRange(0, 2), 0}, of_b, *rc::gen::arbitrary<bool>());
        pose at;
        switch (*rc::gen::inRange(0, 4)) {
            case 0: break;
            case 1: at = any_turned(any_vector(10)); break;
            case 2: at.rotation = {0, 0, -1, 3, 0, 0, 0, 0.5, 0}; break;
            default: at.rotation = {-1, 0, 0, 0, 1, 0.25, 0, 0, 1};
        }
        const std::vector<aabb::component_contact> meetings = contacts(a, at, b, at);
        RC_PRE(components_of(a).parts.size() == 1U && components_of(b).parts.size() == 1U);
        if (meetings.empty()) {
            ++apart;
            return;
        }
        RC_ASSERT(meetings.size() == 1U);
        // Cubes that meet in an edge or a corner only are no manifold.
        if (meetings[0].relation == contact_relation::undecided) {
            ++undecided;
            return;
        }
        RC_ASSERT(meetings[0].relation == expected_relation(of_a, of_b));
        ++counts[meetings[0].relation];
    }));
    CAPTURE(apart, undecided);
    for (std::size_t relation = 0; relation < aabb::contact_relation_names.size() - 1; ++relation) {
        CAPTURE(aabb::contact_relation_names[relation]);
        CHECK(counts[static_cast<contact_relation>(relation)] > 0);
    }
    CHECK(counts[contact_relation::crossing] > 10);
    CHECK(counts[contact_relation::touching] > 5);
}

TEST_CASE("solids that meet in points only touch from outside or from inside") {
    const mesh cube = scaled(aabb::unit_cube(), 4, {0, 0, 0});
    mesh tip{{{2, 2, 4}, {1, 1, 5}, {3, 1, 5}, {2, 3, 5}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    const auto relation = [](const mesh& a, const mesh& b) {
        const auto meetings = contacts(a, {}, b, {});
        REQUIRE(meetings.size() == 1);
        const auto swapped = contacts(b, {}, a, {});
        const auto mirrored = meetings[0].relation == contact_relation::a_inside_b   ? contact_relation::b_inside_a
                              : meetings[0].relation == contact_relation::b_inside_a ? contact_relation::a_inside_b
                                                                                     : meetings[0].relation;
        CHECK(swapped == std::vector<aabb::component_contact>{{0, 0, mirrored}});
        return meetings[0].relation;
    };
    CHECK(relation(tip, cube) == contact_relation::touching);
    for (vec3f& v : tip.vertices) v[2] = 8 - v[2];  // now inside, and turned over
    CHECK(relation(tip, cube) == contact_relation::a_inside_b);
    // All vertices of A touch B's faces.
    const mesh inscribed{{{0, 1, 1}, {4, 1, 2}, {2, 0, 3}, {2, 4, 2}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    CHECK(relation(inscribed, cube) == contact_relation::undecided);
    CHECK(relation(scaled(aabb::unit_cube(), 1, {4, 4, 4}), cube) == contact_relation::touching);
    CHECK(relation(scaled(aabb::unit_cube(), 1, {3, 3, 3}), cube) == contact_relation::a_inside_b);
}

TEST_CASE("solids with a common edge lie as their wedges do, at any angles") {
    /// A tetrahedron with an edge on the z-axis, from one angle in degrees to another, of a size that meets no other.
    const auto wedge = [](double from, double to, double size) {
        mesh m;
        const auto at = [&](double degrees) {
            const double angle = degrees * std::numbers::pi / 180;
            return vec3f{static_cast<float>(size * std::cos(angle)), static_cast<float>(size * std::sin(angle)), 2};
        };
        m.vertices = {{0, 0, 0}, {0, 0, 4}, at(from), at(to)};
        m.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
        return m;
    };
    const auto relation = [&](const mesh& a, const mesh& b) {
        const auto meetings = contacts(a, {}, b, {});
        REQUIRE(meetings.size() == 1);
        return meetings[0].relation;
    };
    for (int turn = 0; turn < 360; turn += 15) {
        CAPTURE(turn);
        const auto of = [&](double from, double to, double size) { return wedge(turn + from, turn + to, size); };
        CHECK(relation(of(20, 50, 1), of(10, 70, 8)) == contact_relation::a_inside_b);
        CHECK(relation(of(10, 70, 8), of(20, 50, 1)) == contact_relation::b_inside_a);
        CHECK(relation(of(10, 170, 8), of(20, 50, 0.1)) == contact_relation::b_inside_a);
        CHECK(relation(of(20, 50, 1), of(60, 90, 8)) == contact_relation::touching);
        CHECK(relation(of(60, 90, 8), of(20, 50, 1)) == contact_relation::touching);
        CHECK(relation(of(20, 50, 1), of(100, 250, 8)) == contact_relation::touching);
        CHECK(relation(of(20, 50, 1), of(40, 90, 8)) == contact_relation::crossing);
        CHECK(relation(of(20, 50, 1), of(-60, 40, 8)) == contact_relation::crossing);
        CHECK(relation(of(20, 50, 1), of(20, 80, 8)) == contact_relation::a_inside_b);
        CHECK(relation(of(20, 50, 1), of(50, 80, 8)) == contact_relation::touching);
    }
}

TEST_CASE("meshes that are no manifolds, or intersect themselves, cross or are undecided") {
    const mesh cube = scaled(aabb::unit_cube(), 4, {0, 0, 0});
    mesh open = scaled(aabb::unit_cube(), 1, {4, 0, 0});
    open.triangles.pop_back();
    CHECK(contacts(open, {}, cube, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::undecided}});
    open = scaled(open, 1, {-0.5F, 0.5F, 0.5F});
    CHECK(contacts(open, {}, cube, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::crossing}});
    // Two cubes that share an edge, of four triangles.
    mesh chess = scaled(aabb::unit_cube(), 1, {4, 0, 0});
    for (const mesh other = scaled(aabb::unit_cube(), 1, {5, 1, 0}); const auto& [p, q, r] : other.triangles)
        add_triangle(chess, other.vertices[p], other.vertices[q], other.vertices[r]);
    CHECK(contacts(chess, {}, cube, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::undecided}});
    // A component that intersects itself, since one of its vertices is drawn out through the opposite faces, says
    // nothing about another.
    mesh two = scaled(aabb::unit_cube(), 1, {-1, 2, 2});
    two.vertices[0] = {-0.5F, 5, 5};
    for (const mesh other = scaled(aabb::unit_cube(), 1, {4, 0, 0}); const auto& [p, q, r] : other.triangles)
        add_triangle(two, other.vertices[p], other.vertices[q], other.vertices[r]);
    CHECK(contacts(two, {}, cube, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::undecided},
                                                                              {1, 0, contact_relation::touching}});
    CHECK(contacts(cube, {}, two, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::undecided},
                                                                              {0, 1, contact_relation::touching}});
}

TEST_CASE("triangles with two corners at one position do not matter for how solids lie") {
    const mesh ball = scaled(aabb::sphere(6), 2, {0, 0, 0});  // with such triangles at its poles
    const auto cube_from = [](float low, float high) { return scaled(aabb::unit_cube(), high - low, {low, low, low}); };
    CHECK(contacts(ball, {}, cube_from(-2, 2), {}) ==
          std::vector<aabb::component_contact>{{0, 0, contact_relation::a_inside_b}});
    CHECK(contacts(ball, {}, scaled(aabb::unit_cube(), 2, {-1, -1, 2}), {}) ==
          std::vector<aabb::component_contact>{{0, 0, contact_relation::touching}});
    CHECK(contacts(ball, {}, ball, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::equal}});
}

TEST_CASE("solids that meet in many points are decided by a vertex off the other") {
    // A ball of which every fourth vertex near the bottom is drawn out to a plane.
    constexpr std::uint32_t rings = 40, around_ball = 2 * rings;
    mesh urchin = aabb::sphere(rings);
    const mesh below = scaled(aabb::unit_cube(), 8, {-4, -4, -10}), around = scaled(aabb::unit_cube(), 8, {-4, -4, -2});
    std::size_t touching = 0;
    for (std::uint32_t ring = 28; ring < rings; ring += 2)
        for (std::uint32_t i = 0; i < around_ball; i += 2) {
            urchin.vertices[ring * around_ball + i][2] = -2;
            ++touching;
        }
    REQUIRE(touching > 100);
    CHECK(contacts(urchin, {}, below, {}) == std::vector<aabb::component_contact>{{0, 0, contact_relation::touching}});
    CHECK(contacts(urchin, {}, around, {}) ==
          std::vector<aabb::component_contact>{{0, 0, contact_relation::a_inside_b}});
    CHECK(contacts(around, {}, urchin, {}) ==
          std::vector<aabb::component_contact>{{0, 0, contact_relation::b_inside_a}});
}
