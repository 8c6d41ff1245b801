#include "searches.hpp"

import aabb.prepare.mean_extent;

using namespace aabb;

namespace {

constexpr float half_of_all = std::numeric_limits<float>::max() / 2;
constexpr box half_space{{-half_of_all, -half_of_all, -half_of_all}, {0, half_of_all, half_of_all}};

double typical(const std::vector<box>& boxes) {
    typical_extent extents;
    for (const box& b : boxes) extents.add(b);
    return extents();
}

/// How many pairs are in a list with a margin in extents; less than 0 where none is kept.
double listed_of(const std::vector<box>& boxes) {
    const auto stage = search_of(composed({{strategy_kind::prepare, "neighbour_list:margin=0.1"}}), boxes.size());
    found_by(*stage, boxes);
    for (const stage_plan& plan : stage->plans())
        if (plan.kind == plan_kind::neighbour_list) return plan.decision["pairs"];
    return -1;
}

}  // namespace

TEST_CASE("The typical extent is the mean where no box is by far longer than the others") {
    CHECK(typical({}) == 0);
    CHECK(typical({cube(0, 0), cube(1, 0)}) == 0);
    CHECK(typical({cube(0, 1), cube(5, 2), cube(3, 9)}) == 4);
    CHECK(typical({{{0, 0, 0}, {1, 2, 3}}}) == 2);
    // Boxes without extent count as others do, but not for what is far longer.
    CHECK(typical({cube(0, 0), cube(1, 0), cube(2, 0), cube(3, 4)}) == 1);
    constexpr float least = std::numeric_limits<float>::denorm_min();
    CHECK(std::abs(typical({cube(0, least), cube(1, 0)}) - double{least} / 2) < double{least} / 1000);
}

TEST_CASE("Boxes that are by far longer than the others do not change the typical extent, up to half of all") {
    std::vector<box> boxes(9, cube(0, 1));
    boxes.push_back(half_space);
    CHECK(typical(boxes) == 1);
    boxes.back() = cube(0, 1000);
    CHECK(typical(boxes) == 1);
    for (int i = 0; i < 7; ++i) boxes.push_back(half_space);
    CHECK(typical(boxes) == 1);
    CHECK(std::isfinite(typical({half_space, half_space})));
}

TEST_CASE("A list of neighbours is not the longer for a box that bounds half of space") {
    std::vector<box> boxes;
    for (int i = 0; i < 400; ++i) boxes.push_back(cube(static_cast<float>(i) * 1.5F, 1));
    boxes.push_back(cube(-2, 1));
    CHECK(listed_of(boxes) == 0);
    boxes.back() = half_space;
    // It has the box at 0 as its neighbour.
    CHECK(listed_of(boxes) == 1);
}
