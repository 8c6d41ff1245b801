#include "pairs.hpp"

import aabb.triangle.intersection;

// Intersections of two triangles, compared with CGAL's exact construction.

namespace {

template <class Real>
void compare_all(int count) {
    triangle_pairs::generator g{4};
    std::map<std::string, int> kinds;
    const auto is_right = [&](const aabb::triangle_pair<Real>& pair) {
        const aabb::triangle3d s = aabb::in_double(pair.a);
        const aabb::triangle3d t = aabb::in_double(pair.b);
        const aabb::exact_intersection exact(s, t);
        ++kinds[std::string(name_of(exact.kind()))];
        const aabb::corner_errors errors = exact.errors_of(aabb::intersection_of(s, t));
        return errors.same && errors.within;
    };
    triangle_pairs::check_each_pair<Real>(g, count, is_right);
    int wrong = 0;
    for (int i = 0; i < 10 * count; ++i)
        wrong += is_right(triangle_pairs::of_type<Real>(triangle_pairs::spread<Real>(g))) ? 0 : 1;
    CHECK(wrong == 0);
    for (const char* kind : {"none", "point", "segment", "transversal", "overlap"}) {
        INFO(kind);
        CHECK(kinds[kind] > count);
    }
}

}  // namespace

TEST_CASE("what triangles of floats have in common equals what CGAL constructs, within the stated error") {
    compare_all<float>(300);
}

TEST_CASE("what triangles of doubles have in common equals what CGAL constructs, within the stated error") {
    compare_all<double>(300);
}

TEST_CASE("intersection corners that are corners of a triangle are exact") {
    using aabb::intersection_kind;
    const aabb::triangle3d face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const auto point = aabb::intersection_of(face, {{{1, 1, 0}, {1, 1, 3}, {2, 1, 3}}});
    CHECK(point.kind == intersection_kind::point);
    CHECK(point.corners[0] == aabb::vec3d{1, 1, 0});
    CHECK(point.error == aabb::vec3d{0, 0, 0});
    const auto overlap = aabb::intersection_of(face, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}});
    CHECK(overlap.kind == intersection_kind::overlap);
    CHECK(overlap.size == 3);
    const auto star = aabb::intersection_of(aabb::triangle3d{{{0, 0, 0}, {6, 0, 0}, {3, 6, 0}}},
                                            {{{0, 4, 0}, {6, 4, 0}, {3, -2, 0}}});
    REQUIRE(star.size == 6);
    int turns = 0;
    for (std::size_t i = 0; i < 6; ++i) {  // around the middle, always in the same direction
        const aabb::vec3d p = star.corners[i];
        const aabb::vec3d q = star.corners[(i + 1) % 6];
        turns += (p[0] - 3) * (q[1] - 2) > (p[1] - 2) * (q[0] - 3) ? 1 : -1;
    }
    CHECK(std::abs(turns) == 6);
    CHECK(aabb::intersection_of(face, {{{1, 1, 1}, {1, 1, 3}, {2, 1, 3}}}).kind == intersection_kind::none);
    CHECK(aabb::intersection_of(face, {{{1, 1, -1}, {1, 1, 3}, {2, 1, 3}}}).kind == intersection_kind::transversal);
    CHECK(aabb::intersection_of(face, {{{1, 0, 0}, {2, 0, 0}, {1, 0, 3}}}).kind == intersection_kind::segment);
    CHECK(name_of(intersection_kind::transversal) == "transversal");
    // An end point that is cut from one triangle and a corner of the other.
    const aabb::triangle3d slanted{{{0, 0, 0}, {49, 49, 0}, {0, 49, 0}}};
    const aabb::triangle3d upright{{{1, 1, 0}, {1, 0, 1}, {1, 2, 1}}};
    for (const auto& result : {aabb::intersection_of(slanted, upright), aabb::intersection_of(upright, slanted)}) {
        CHECK(result.kind == intersection_kind::point);
        CHECK(result.corners[0] == aabb::vec3d{1, 1, 0});
        CHECK(result.error == aabb::vec3d{0, 0, 0});
    }
    const auto pierced = aabb::intersection_of(aabb::triangle3d{{{1, 1, 0}, {3, 0, 0}, {0, 4, 0}}},
                                               {{{1, 1, 49}, {1, 1, -3}, {1, 1, -3}}});
    CHECK(pierced.kind == intersection_kind::point);
    CHECK(pierced.corners[0] == aabb::vec3d{1, 1, 0});
    CHECK(pierced.error == aabb::vec3d{0, 0, 0});
}
