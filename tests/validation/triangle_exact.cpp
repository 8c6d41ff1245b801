#include "pairs.hpp"

import aabb.triangle.exact;

// The exact triangle test against CGAL's exact kernel.

namespace {

/// Misclassified pairs, and whether there were both intersecting and disjoint ones.
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
    void check(bool may_all_intersect = false) {
        CHECK(wrong == 0);
        CHECK(intersecting > 0);
        CHECK((disjoint > 0 || may_all_intersect));
        *this = {};
    }
};

template <class Real>
void compare_all(int count) {
    triangle_pairs::generator g{1};
    tally pairs;
    triangle_pairs::for_each_pair<Real>(
        g, count, [&](const auto& pair) { pairs.add(pair); },
        [&](std::size_t pattern) { pairs.check(pattern == 1 || pattern == 2); });
    for (int i = 0; i < count; ++i) pairs.add(triangle_pairs::of_type<Real>(triangle_pairs::spread<Real>(g)));
    pairs.check();
}

}  // namespace

TEST_CASE("the exact triangle test agrees with CGAL on floats") {
    compare_all<float>(2500);
}

TEST_CASE("the exact triangle test agrees with CGAL on doubles") {
    compare_all<double>(2500);
}
