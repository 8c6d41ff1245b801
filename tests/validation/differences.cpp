#include "support.hpp"

import aabb.validation;

using namespace aabb;

namespace {

const std::vector<index_pair> none;
const std::vector<index_pair> one = {{0, 0}};
const triangle3f floor_triangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

std::size_t total(const differences& all) {
    return std::accumulate(all.false_negatives.begin(), all.false_negatives.end(), std::size_t{0}) +
           std::accumulate(all.false_positives.begin(), all.false_positives.end(), std::size_t{0});
}

/// Of an engine that contradicts the exact answer on two triangles: the one class its difference is counted in.
void require_class(difference_class expected, const triangle3f& s, const pose& pose_s, const triangle3f& t,
                   const pose& pose_t) {
    const mesh a = one_triangle(s);
    const mesh b = one_triangle(t);
    const bool truth = exactly_intersect(s, relative_pose(pose_s, pose_t, bounds_of(b))(t));
    const differences all = truth ? compare_triangle_pairs(one, none, a, pose_s, b, pose_t)
                                  : compare_triangle_pairs(none, one, a, pose_s, b, pose_t);
    REQUIRE(total(all) == 1);
    for (std::size_t c = 0; c < difference_class_names.size(); ++c) {
        INFO("counted as " << difference_class_names[c]);
        REQUIRE(all.false_negatives[c] == (truth && c == static_cast<std::size_t>(expected)));
        REQUIRE(all.false_positives[c] == (!truth && c == static_cast<std::size_t>(expected)));
    }
}

void require_class(difference_class expected, const triangle3f& s, const triangle3f& t) {
    require_class(expected, s, {}, t, {});
    require_class(expected, t, {}, s, {});
}

triangle3f moved(triangle3f t, vec3f by) {
    for (int i = 0; i < 3; ++i) t[i] = t[i] + by;
    return t;
}

}  // namespace

TEST_CASE("equal sets of pairs differ in nothing") {
    const mesh m = tetrahedron(1);
    const std::vector<index_pair> pairs = {{0, 1}, {0, 2}, {3, 3}};
    REQUIRE(total(compare_triangle_pairs(pairs, pairs, m, {}, m, {})) == 0);
    REQUIRE(total(compare_triangle_pairs(none, none, m, {}, m, {})) == 0);
}

TEST_CASE("every pair of one set alone is counted, wherever it stands") {
    const mesh m = tetrahedron(1);
    const std::vector<index_pair> exact = {{0, 0}, {0, 2}, {1, 1}, {2, 2}};
    const std::vector<index_pair> found = {{0, 1}, {0, 2}, {2, 2}, {3, 1}, {3, 3}};
    differences all = compare_triangle_pairs(exact, found, m, {}, m, {});
    REQUIRE(std::accumulate(all.false_negatives.begin(), all.false_negatives.end(), std::size_t{0}) == 2);
    REQUIRE(std::accumulate(all.false_positives.begin(), all.false_positives.end(), std::size_t{0}) == 3);
    REQUIRE(total(all) == 5);
    all += all;
    REQUIRE(total(all) == 10);
}

TEST_CASE("class names are in the order of the classes, each once") {
    using enum difference_class;
    const std::pair<difference_class, std::string_view> named[] = {{degenerate, "degenerate"},
                                                                   {pose_rounding, "pose_rounding"},
                                                                   {coplanar, "coplanar"},
                                                                   {touching, "touching"},
                                                                   {near, "near"},
                                                                   {other, "other"}};
    for (const auto& [of, name] : named) REQUIRE(difference_class_names[static_cast<std::size_t>(of)] == name);
}

TEST_CASE("a difference is of the class that two triangles say, in either order") {
    using enum difference_class;
    const triangle3f standing{{{1, 1, 0}, {1, 2, 3}, {2, 1, 3}}};
    const std::pair<difference_class, triangle3f> at_the_floor[] = {
        // A triangle without area.
        {degenerate, {{{1, 1, -1}, {1, 1, 1}, {1, 1, 0}}}},
        {degenerate, {{{9, 9, 9}, {9, 9, 9}, {9, 9, 9}}}},
        // In one plane, apart or not.
        {coplanar, moved(floor_triangle, {1, 1, 0})},
        {coplanar, moved(floor_triangle, {4, 0, 0})},
        {coplanar, moved(floor_triangle, {9, 0, 0})},
        // Points in common, but nothing passes through: a corner on the face, an edge in the face, two corners, a
        // corner on an edge, two edges that cross.
        {touching, {{{1, 1, 0}, {1, 2, 3}, {2, 1, 3}}}},
        {touching, {{{1, 1, 0}, {1, 2, 0}, {2, 1, 3}}}},
        {touching, {{{4, 0, 0}, {5, 0, 1}, {5, 1, 1}}}},
        {touching, {{{2, 0, 0}, {2, -1, 2}, {3, -1, 2}}}},
        {touching, {{{2, 0, -1}, {2, 0, 1}, {2, -3, 0}}}},
        // A hair apart, or a hair through, and more than that.
        {near, moved(standing, {0, 0, 1e-6F})},
        {near, moved(standing, {0, 0, -1e-6F})},
        {other, moved(standing, {0, 0, 1e-4F})},
        {other, moved(standing, {0, 0, -1e-4F})},
        // A corner beside a corner, and a corner beside an edge; the planes are far from each other.
        {near, {{{4.000001F, 0, 0}, {5, 0, 1}, {5, 1, 1}}}},
        {other, {{{4.0001F, 0, 0}, {5, 0, 1}, {5, 1, 1}}}},
        {near, {{{2, -1e-6F, 0}, {2, -1, 2}, {3, -1, 2}}}},
        // Plainly through each other, or plainly apart.
        {other, {{{1, 1, -2}, {1, 2, 3}, {2, 1, 3}}}},
        {other, {{{1, 1, 2}, {1, 2, 3}, {2, 1, 3}}}}};
    for (std::size_t row = 0; const auto& [expected, t] : at_the_floor) {
        INFO("row " << row++);
        require_class(expected, floor_triangle, t);
    }
    // Far from the origin and tiny.
    require_class(other, moved(floor_triangle, {4096, 4096, 4096}),
                  moved({{{1, 1, -2}, {1, 2, 3}, {2, 1, 3}}}, {4096, 4096, 4096}));
    require_class(other, {{{0, 0, 0}, {4e-40F, 0, 0}, {0, 4e-40F, 0}}},
                  {{{1e-40F, 1e-40F, -2e-40F}, {1e-40F, 2e-40F, 3e-40F}, {2e-40F, 1e-40F, 3e-40F}}});
}

TEST_CASE("pose rounding: the answer changes when the moved vertices are rounded to float") {
    // Lifted by less than float keeps beside 1: apart in the world, touching after rounding.
    const triangle3f standing{{{1, 1, 1}, {1, 2, 3}, {2, 1, 3}}};
    const triangle3f at_one = moved(floor_triangle, {0, 0, 1});
    const pose lifted{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1e-12}};
    require_class(difference_class::pose_rounding, at_one, {}, standing, lifted);
}
