#include "searches.hpp"

using namespace aabb;

namespace {

std::unique_ptr<global_stage> splitting(double size, std::uint32_t objects) {
    aabb::composition c;
    c[strategy_kind::prepare] = {"split_large", {{"size", std::to_string(size)}}};
    return search_of(c, objects);
}

}  // namespace

TEST_CASE("a large object is swept as pieces and reported once") {
    std::vector<box> boxes;
    for (int i = 0; i < 60; ++i) boxes.push_back(cube(static_cast<float>(i), 1));
    boxes.push_back(cube(0, 60));  // overlaps all the others
    const auto stage = splitting(2, 61);
    const std::vector<index_pair> pairs = found_by(*stage, boxes);
    // The mean extent is 120 / 61; pieces are no longer than twice that, and no more than 16 per axis.
    CHECK(stage->counters()[work::pieces] == 16 * 16 * 16);
    CHECK(pairs.size() == 59 + 60);
    CHECK(std::ranges::adjacent_find(pairs) == pairs.end());
    CHECK(std::ranges::count(pairs, 60U, &index_pair::b) == 60);
}

TEST_CASE("a box is split only on axes on which it is long") {
    std::vector<box> boxes(9, cube(0, 1));
    boxes.push_back({{0, 0, 0}, {10, 1, 1}});
    // The mean extent is 1.3: four pieces of at most 2.6.
    const auto stage = splitting(2, 10);
    CHECK(found_by(*stage, boxes).size() == 45);
    CHECK(stage->counters()[work::pieces] == 4);
}

TEST_CASE("pieces follow objects that grow, shrink, come and go, in frames of any size") {
    const auto stage = splitting(1.5, 4);
    std::vector<box> boxes{cube(0, 1), cube(0.5F, 1), cube(10, 1), cube(0, 1)};
    CHECK(found_by(*stage, boxes).size() == 3);
    boxes[0] = cube(0, 20);
    CHECK(found_by(*stage, boxes).size() == 4);
    boxes.push_back(cube(15, 1));
    stage->insert(4);
    CHECK(found_by(*stage, boxes).size() == 5);
    stage->remove(0);
    CHECK(found_by(*stage, boxes).size() == 1);
    stage->insert(0);
    stage->remove(4);
    boxes.pop_back();
    CHECK(found_by(*stage, boxes).size() == 4);
}

TEST_CASE("pieces keep their places in sorted lists when other objects come and go") {
    aabb::composition c;
    c[strategy_kind::prepare] = {"split_large", {{"size", "0.9"}}};
    c[strategy_kind::sort] = {"insertion", {}};
    c[strategy_kind::partition] = {"none", {}};
    c[strategy_kind::sweep] = {"one_axis", {}};
    const auto stage = search_of(c, 400);
    std::vector<box> boxes;
    for (std::uint32_t id = 0; id < 400; ++id) {
        const float edge = 1 + static_cast<float>(id * 7 % 4);
        boxes.push_back(cube(static_cast<float>(id * 37 % 401), edge));
    }
    found_by(*stage, boxes);
    const std::uint64_t before = stage->counters()[work::comparisons];
    stage->remove(1);
    stage->remove(399);
    found_by(*stage, boxes);
    CHECK(stage->counters()[work::pieces] > 2000);
    CHECK(stage->counters()[work::comparisons] - before < 1000);
}

TEST_CASE("a size that makes far more pieces than objects is rejected") {
    const auto stage = splitting(1e-6, 20'000);
    CHECK_REFUSED(stage->update(std::vector<box>(20'000, cube(0, 1))),
                  "split_large: this size makes more than 385536 pieces of 20000 objects; a greater size makes fewer");
}

TEST_CASE("rounding of coordinates splits no box") {
    std::vector<box> boxes;
    for (int i = 0; i < 200; ++i) boxes.push_back(cube(static_cast<float>(i) * 0.7F + 1000, 1));
    const auto stage = splitting(1, 200);
    found_by(*stage, boxes);
    CHECK(stage->counters()[work::pieces] == 0);
}

TEST_CASE("a box with no floats between its ends stays whole") {
    const float next = std::nextafter(1.0F, 2.0F);
    std::vector<box> boxes(20, {{1, 1, 1}, {1, 1, 1}});
    boxes.push_back({{1, 1, 1}, {next, next, next}});
    const auto stage = splitting(0.5, 21);
    CHECK(found_by(*stage, boxes).size() == 21 * 20 / 2);
    CHECK(stage->counters()[work::pieces] == 0);
}

TEST_CASE("the size of split_large is a number above 0") {
    for (const std::string text : {"", "on", "0", "-1", "nan", "inf", "2x"})
        CHECK_REFUSED(require_known(strategy_kind::prepare, {"split_large", {{"size", text}}}),
                      "split_large: size must be a number above 0, not '" + text + "'");
}
