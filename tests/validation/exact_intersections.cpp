#include "pairs.hpp"

import aabb.triangle.intersection;

// CGAL's exact construction behind plain types, and what is compared with it.

using aabb::intersection_kind;
using aabb::triangle3d;
using aabb::triangle_intersection;

namespace {

const triangle3d face{{{0, 0, 0}, {6, 0, 0}, {3, 6, 0}}};
const triangle3d star{{{0, 4, 0}, {6, 4, 0}, {3, -2, 0}}};
/// Through the face along a segment whose ends are not doubles.
const triangle3d through{{{2, 1, -1}, {2, 1, 2}, {4, 1, 2}}};

}  // namespace

TEST_CASE("an intersection is compared with the exact one in any order of its corners") {
    const aabb::exact_intersection segment(face, through);
    CHECK(segment.kind() == intersection_kind::transversal);
    triangle_intersection computed = aabb::intersection_of(face, through);
    const aabb::corner_errors errors = segment.errors_of(computed);
    CHECK(errors.same);
    CHECK(errors.within);
    CHECK(errors.of_bound > 0);
    CHECK(errors.of_bound <= 1);
    CHECK(errors.greatest <= errors.bound);
    std::swap(computed.corners[0], computed.corners[1]);
    CHECK(segment.errors_of(computed).within);
    computed.corners[0][0] += 2 * computed.error[0];
    CHECK(segment.errors_of(computed).same);
    CHECK_FALSE(segment.errors_of(computed).within);
    CHECK(segment.errors_of(computed).of_bound > 1);
    computed.kind = intersection_kind::segment;
    CHECK_FALSE(segment.errors_of(computed).same);
    CHECK_FALSE(segment.errors_of(computed).within);

    const aabb::exact_intersection polygon(face, star);
    triangle_intersection hexagon = aabb::intersection_of(face, star);
    REQUIRE(hexagon.size == 6);
    for (int rotation = 0; rotation < 6; ++rotation) {
        CHECK(polygon.errors_of(hexagon).within);
        triangle_intersection reversed = hexagon;
        std::ranges::reverse(reversed.corners);
        CHECK(polygon.errors_of(reversed).within);
        std::ranges::rotate(hexagon.corners, hexagon.corners.begin() + 1);
    }
    std::swap(hexagon.corners[0], hexagon.corners[1]);
    CHECK_FALSE(polygon.errors_of(hexagon).within);
    --hexagon.size;
    CHECK_FALSE(polygon.errors_of(hexagon).same);

    const aabb::exact_intersection disjoint(face, {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}});
    CHECK(disjoint.kind() == intersection_kind::none);
    CHECK(disjoint.errors_of({}).same);
    CHECK(disjoint.errors_of({}).within);
}

TEST_CASE("an error is infinitely greater than a bound of zero") {
    const aabb::exact_intersection segment(face, through);
    triangle_intersection computed = segment.rounded();
    computed.error = {};
    const aabb::corner_errors errors = segment.errors_of(computed);
    CHECK_FALSE(errors.within);
    CHECK(errors.of_bound > 1e300);
}

TEST_CASE("the rounded exact intersection is off by a few ulps at most, and ours is within its bound") {
    triangle_pairs::generator g{11};
    std::size_t hits = 0;
    triangle_pairs::check_each_pair<double>(g, 100, [&](const aabb::triangle_pair<double>& pair) {
        const aabb::exact_intersection exact(pair.a, pair.b);
        const triangle_intersection rounded = exact.rounded();
        hits += static_cast<std::size_t>(rounded.size > 0);
        bool is_right = (rounded.size > 0) == aabb::exactly_intersect(pair.a, pair.b) &&
                        exact.errors_of(rounded).within &&
                        exact.errors_of(aabb::intersection_of(pair.a, pair.b)).within;
        for (int k = 0; k < 3; ++k) {
            double largest = 0;
            for (std::size_t c = 0; c < rounded.size; ++c) largest = std::max(largest, std::abs(rounded.corners[c][k]));
            is_right &= rounded.size == 0 || rounded.error[k] <= largest * 0x1p-51 + 0x1p-1073;
        }
        return is_right;
    });
    CHECK(hits > 1000);
    const triangle_intersection doubles = aabb::exact_intersection(face, {{{1, 1, 0}, {2, 1, 0}, {2, 2, 0}}}).rounded();
    CHECK(doubles.size == 3);
    CHECK(doubles.error == aabb::vec3d{0, 0, 0});
}
