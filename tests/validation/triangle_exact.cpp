#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <variant>

#include "../triangle_pairs.hpp"

import aabb;
import aabb.triangle.exact;

// The exact triangle test against CGAL's exact kernel. CGAL's tests want triangles that are not degenerate, so those of
// zero area go to it as segments and points.

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using point_3 = kernel::Point_3;
using segment_3 = kernel::Segment_3;
using triangle_3 = kernel::Triangle_3;
using shape = std::variant<point_3, segment_3, triangle_3>;

shape shape_of(const triangle_pairs::triangle& t) {
    std::array<point_3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = {t[i][0], t[i][1], t[i][2]};
    if (!CGAL::collinear(p[0], p[1], p[2])) return triangle_3(p[0], p[1], p[2]);
    std::sort(p.begin(), p.end());
    if (p[0] == p[2]) return p[0];
    return segment_3(p[0], p[2]);
}

struct cgal_meets {
    bool operator()(const point_3& s, const point_3& t) const { return s == t; }
    bool operator()(const point_3& s, const auto& t) const { return t.has_on(s); }
    bool operator()(const auto& s, const point_3& t) const { return s.has_on(t); }
    bool operator()(const auto& s, const auto& t) const { return CGAL::do_intersect(s, t); }
};

bool cgal_intersects(const triangle_pairs::pair& pair) {
    return std::visit(cgal_meets{}, shape_of(pair[0]), shape_of(pair[1]));
}

template <class Real>
aabb::triangle3<Real> as_triangle(const triangle_pairs::triangle& t) {
    aabb::triangle3<Real> made;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            made[i][k] = static_cast<Real>(t[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
    return made;
}

template <class Real>
bool ours(const triangle_pairs::pair& pair) {
    return aabb::exact_triangle::intersects(as_triangle<Real>(pair[0]), as_triangle<Real>(pair[1]));
}

/// Misclassified pairs of `count`; `both` says whether intersecting and disjoint ones were among them.
struct tally {
    std::size_t intersecting = 0;
    std::size_t disjoint = 0;
    std::size_t wrong = 0;

    template <class Real>
    void check(const triangle_pairs::pair& pair) {
        const bool expected = cgal_intersects(pair);
        ++(expected ? intersecting : disjoint);
        wrong += ours<Real>(pair) != expected ? 1 : 0;
    }
};

template <class Real>
void compare_all(std::size_t count) {
    triangle_pairs::generator g{1};
    for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
        for (std::size_t placement = 0; placement < triangle_pairs::placements.size(); ++placement) {
            tally counted;
            for (std::size_t i = 0; i < count; ++i)
                counted.check<Real>(triangle_pairs::placed<Real>(g, triangle_pairs::patterned(g, pattern), placement));
            CAPTURE(triangle_pairs::patterns[pattern], triangle_pairs::placements[placement]);
            CHECK(counted.wrong == 0);
            CHECK(counted.intersecting > 0);
            CHECK((counted.disjoint > 0 || pattern == 1 || pattern == 2));
        }
    tally counted;
    for (std::size_t i = 0; i < count; ++i) counted.check<Real>(triangle_pairs::spread<Real>(g));
    CHECK(counted.wrong == 0);
    CHECK(counted.intersecting > 0);
    CHECK(counted.disjoint > 0);
}

}  // namespace

TEST_CASE("the exact triangle test agrees with CGAL on floats") {
    compare_all<float>(2500);
}

TEST_CASE("the exact triangle test agrees with CGAL on doubles") {
    compare_all<double>(2500);
}
