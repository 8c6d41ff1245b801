#include "pairs.hpp"

import aabb.triangle.exact;

// The exact triangle test against CGAL's exact kernel.

namespace {

/// Misclassified pairs, and whether intersecting and disjoint ones were among all.
struct tally {
    std::size_t intersecting = 0;
    std::size_t disjoint = 0;
    std::size_t wrong = 0;

    template <class Real>
    void add(const aabb::triangle_pair<Real>& pair) {
        const bool expected = aabb::exactly_intersect(pair.a, pair.b);
        ++(expected ? intersecting : disjoint);
        wrong += aabb::exact_triangle::intersects(pair.a, pair.b) != expected ? 1 : 0;
    }
    void check(bool may_all_meet = false) {
        CHECK(wrong == 0);
        CHECK(intersecting > 0);
        CHECK((disjoint > 0 || may_all_meet));
        *this = {};
    }
};

template <class Real>
void compare_all(int count) {
    triangle_pairs::generator g{1};
    tally counted;
    triangle_pairs::for_each_pair<Real>(
        g, count, [&](const auto& pair) { counted.add(pair); },
        [&](std::size_t pattern) { counted.check(pattern == 1 || pattern == 2); });
    for (int i = 0; i < count; ++i) counted.add(triangle_pairs::of_type<Real>(triangle_pairs::spread<Real>(g)));
    counted.check();
}

}  // namespace

TEST_CASE("the exact triangle test agrees with CGAL on floats") {
    compare_all<float>(2500);
}

TEST_CASE("the exact triangle test agrees with CGAL on doubles") {
    compare_all<double>(2500);
}
