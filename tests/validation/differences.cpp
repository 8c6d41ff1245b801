#include "support.hpp"

import aabb.validation;

using namespace aabb;

namespace {

const std::vector<index_pair> no_pairs;
const std::vector<index_pair> one_pair = {{0, 0}};
const triangle3f floor_triangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

std::size_t total(const differences& counts) {
    return std::accumulate(counts.false_negatives.begin(), counts.false_negatives.end(), std::size_t{0}) +
           std::accumulate(counts.false_positives.begin(), counts.false_positives.end(), std::size_t{0});
}

/// The only class in which the difference is counted of an engine that contradicts the ground truth on two triangles.
void require_class(difference_class expected, const triangle3f& s, const pose& pose_s, const triangle3f& t,
                   const pose& pose_t) {
    const mesh a = one_triangle(s);
    const mesh b = one_triangle(t);
    const bool truth = exactly_intersect({pose_s, pose_t}, in_double(s), in_double(t));
    const differences counts = truth ? compare_triangle_pairs(one_pair, no_pairs, a, pose_s, b, pose_t)
                                     : compare_triangle_pairs(no_pairs, one_pair, a, pose_s, b, pose_t);
    REQUIRE(total(counts) == 1);
    for (std::size_t c = 0; c < difference_class_names.size(); ++c) {
        INFO("counted as " << difference_class_names[c]);
        REQUIRE(counts.false_negatives[c] == (truth && c == static_cast<std::size_t>(expected)));
        REQUIRE(counts.false_positives[c] == (!truth && c == static_cast<std::size_t>(expected)));
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

TEST_CASE("equal sets of pairs have no differences") {
    const mesh m = tetrahedron(1);
    const std::vector<index_pair> pairs = {{0, 1}, {0, 2}, {3, 3}};
    REQUIRE(total(compare_triangle_pairs(pairs, pairs, m, {}, m, {})) == 0);
    REQUIRE(total(compare_triangle_pairs(no_pairs, no_pairs, m, {}, m, {})) == 0);
}

TEST_CASE("every pair that is in one set only is counted") {
    const mesh m = tetrahedron(1);
    const std::vector<index_pair> exact = {{0, 0}, {0, 2}, {1, 1}, {2, 2}};
    const std::vector<index_pair> computed = {{0, 1}, {0, 2}, {2, 2}, {3, 1}, {3, 3}};
    differences counts = compare_triangle_pairs(exact, computed, m, {}, m, {});
    REQUIRE(std::accumulate(counts.false_negatives.begin(), counts.false_negatives.end(), std::size_t{0}) == 2);
    REQUIRE(std::accumulate(counts.false_positives.begin(), counts.false_positives.end(), std::size_t{0}) == 3);
    REQUIRE(total(counts) == 5);
    counts += counts;
    REQUIRE(total(counts) == 10);
}

TEST_CASE("class names are in the order of the classes, each once") {
    using enum difference_class;
    const std::pair<difference_class, std::string_view> names[] = {{degenerate, "degenerate"},
                                                                   {pose_rounding, "pose_rounding"},
                                                                   {coplanar, "coplanar"},
                                                                   {touching, "touching"},
                                                                   {near, "near"},
                                                                   {other, "other"}};
    for (const auto& [value, name] : names) REQUIRE(difference_class_names[static_cast<std::size_t>(value)] == name);
}

TEST_CASE("the class of a difference depends on the two triangles only, not on their order") {
    using enum difference_class;
    const triangle3f standing{{{1, 1, 0}, {1, 2, 3}, {2, 1, 3}}};
    const std::pair<difference_class, triangle3f> cases[] = {
        // A degenerate triangle.
        {degenerate, {{{1, 1, -1}, {1, 1, 1}, {1, 1, 0}}}},
        {degenerate, {{{9, 9, 9}, {9, 9, 9}, {9, 9, 9}}}},
        // Coplanar, disjoint or not.
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
        // Disjoint or intersecting by a hair, and by more.
        {near, moved(standing, {0, 0, 1e-6F})},
        {near, moved(standing, {0, 0, -1e-6F})},
        {other, moved(standing, {0, 0, 1e-4F})},
        {other, moved(standing, {0, 0, -1e-4F})},
        // A corner beside a corner, and a corner beside an edge; the planes are far from each other.
        {near, {{{4.000001F, 0, 0}, {5, 0, 1}, {5, 1, 1}}}},
        {other, {{{4.0001F, 0, 0}, {5, 0, 1}, {5, 1, 1}}}},
        {near, {{{2, -1e-6F, 0}, {2, -1, 2}, {3, -1, 2}}}},
        // Clearly intersecting, or clearly disjoint.
        {other, {{{1, 1, -2}, {1, 2, 3}, {2, 1, 3}}}},
        {other, {{{1, 1, 2}, {1, 2, 3}, {2, 1, 3}}}}};
    for (std::size_t row = 0; const auto& [expected, t] : cases) {
        INFO("row " << row++);
        require_class(expected, floor_triangle, t);
    }
    // Far from the origin and tiny.
    require_class(other, moved(floor_triangle, {4096, 4096, 4096}),
                  moved({{{1, 1, -2}, {1, 2, 3}, {2, 1, 3}}}, {4096, 4096, 4096}));
    require_class(other, {{{0, 0, 0}, {4e-40F, 0, 0}, {0, 4e-40F, 0}}},
                  {{{1e-40F, 1e-40F, -2e-40F}, {1e-40F, 2e-40F, 3e-40F}, {2e-40F, 1e-40F, 3e-40F}}});
}

TEST_CASE("a difference is pose_rounding if the result changes when moved vertices are rounded") {
    // Lifted by less than an ulp of 1 in float: disjoint in the world, touching after rounding.
    const triangle3f standing{{{1, 1, 1}, {1, 2, 3}, {2, 1, 3}}};
    const triangle3f at_one = moved(floor_triangle, {0, 0, 1});
    const pose lifted{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1e-12}};
    require_class(difference_class::pose_rounding, at_one, {}, standing, lifted);
}
