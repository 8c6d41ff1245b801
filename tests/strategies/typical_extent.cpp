#include "searches.hpp"

import aabb.prepare.mean_extent;

using namespace aabb;

namespace {

constexpr float half_of_largest = std::numeric_limits<float>::max() / 2;
constexpr box half_space{{-half_of_largest, -half_of_largest, -half_of_largest}, {0, half_of_largest, half_of_largest}};

double typical(const std::vector<box>& boxes) {
    typical_extent extents;
    for (const box& b : boxes) extents.add(b);
    return extents();
}

/// The number of pairs in a list whose margin is in extents; below 0 if none is kept.
double listed_pairs(const std::vector<box>& boxes) {
    const auto stage = search_of(composed({{strategy_kind::prepare, "neighbour_list:margin=0.1"}}), boxes.size());
    found_by(*stage, boxes);
    for (const stage_plan& plan : stage->plans())
        if (plan.kind == plan_kind::neighbour_list) return plan.decision["pairs"];
    return -1;
}

}  // namespace

TEST_CASE("the typical extent is the mean if no box is far longer than the others") {
    CHECK(typical({}) == 0);
    CHECK(typical({cube(0, 0), cube(1, 0)}) == 0);
    CHECK(typical({cube(0, 1), cube(5, 2), cube(3, 9)}) == 4);
    CHECK(typical({{{0, 0, 0}, {1, 2, 3}}}) == 2);
    // Boxes without extent count for the mean, but not for deciding which are far longer.
    CHECK(typical({cube(0, 0), cube(1, 0), cube(2, 0), cube(3, 4)}) == 1);
    constexpr float least = std::numeric_limits<float>::denorm_min();
    CHECK(std::abs(typical({cube(0, least), cube(1, 0)}) - double{least} / 2) < double{least} / 1000);
}

TEST_CASE("boxes far longer than the others do not change the typical extent, up to half of all boxes") {
    std::vector<box> boxes(9, cube(0, 1));
    boxes.push_back(half_space);
    CHECK(typical(boxes) == 1);
    boxes.back() = cube(0, 1000);
    CHECK(typical(boxes) == 1);
    for (int i = 0; i < 7; ++i) boxes.push_back(half_space);
    CHECK(typical(boxes) == 1);
    CHECK(std::isfinite(typical({half_space, half_space})));
}

TEST_CASE("a Verlet list gets no longer for a box that bounds half of space") {
    std::vector<box> boxes;
    for (int i = 0; i < 400; ++i) boxes.push_back(cube(static_cast<float>(i) * 1.5F, 1));
    boxes.push_back(cube(-2, 1));
    CHECK(listed_pairs(boxes) == 0);
    boxes.back() = half_space;
    // It has the box at 0 as its neighbour.
    CHECK(listed_pairs(boxes) == 1);
}
