// Strategies plan by the costs of the machine; what they find does not hang on them, which global_compositions.cpp has.

#include "costs.hpp"
#include "searches.hpp"

import aabb.prepare.list_plan;
import aabb.selection;
import aabb.strategies;

using namespace aabb;

namespace {

std::vector<box> spread_boxes(std::size_t n) {
    return cubes(n, {40, 40, 40});
}

std::uint64_t subsets_made(const composition& c, const std::vector<box>& boxes) {
    const auto stage = search_of(c, boxes.size());
    found_by(*stage, boxes);
    return stage->counters()[work::subsets];
}

composition cut_by(const char* partition) {
    return composed(
        {{strategy_kind::sort, "std"}, {strategy_kind::partition, partition}, {strategy_kind::sweep, "one_axis"}});
}

}  // namespace

TEST_CASE("auto selects a strategy of each kind with a reason, exact and not refused, whatever work costs") {
    REQUIRE(rc::check([] {
        const these_costs costs(*rc::gen::arbitrary<bool>() ? any_costs() : cost_model());
        // From scenes of which nothing is known to those of meshes that are asked often.
        scene_traits scene;
        if (*rc::gen::arbitrary<bool>())
            scene = {*rc::gen::element<std::size_t>(0, 1, 2, 3, 4, 63, 64, 1000, 100'000),
                     *rc::gen::element<std::size_t>(0, 1, 20'417, 1'000'000),
                     *rc::gen::inRange<std::size_t>(0, 1'000'000)};
        const std::vector<selected_strategy> all = select_strategies({}, scene);
        RC_ASSERT(all.size() == strategy_kind_count);
        RC_ASSERT(std::ranges::none_of(all, [](const selected_strategy& one) { return one.rule.empty(); }));
        const composition c = composed_of(all);
        for (const enum stage of : {stage::global_search, stage::local_detection}) {
            RC_ASSERT(rejection_of(c, of).empty());
            RC_ASSERT(is_exact(c, of));
        }
        RC_ASSERT(needs_meshes(c).empty());
    }));
}

TEST_CASE("an axial cut makes fewer subsets where they cost more, none where tests are free") {
    const std::vector<box> boxes = spread_boxes(3000);
    const composition cut = cut_by("axial_cut");
    const std::uint64_t usual = subsets_made(cut, boxes);
    CHECK(usual > 1);
    cost_model costs;
    costs.cut_subset *= 100;
    {
        const these_costs dear(costs);
        CHECK(subsets_made(cut, boxes) < usual);
    }
    costs.cut_test = 1e-6;
    const these_costs free(costs);
    CHECK(subsets_made(cut, boxes) <= 1);
}

TEST_CASE("an axial cut that chooses is never refused, however dear tests are") {
    std::vector<box> small = spread_boxes(3000);
    for (box& b : small) b.max = {b.min[0] + 0.001F, b.min[1] + 0.001F, b.min[2] + 0.001F};
    cost_model costs;
    costs.cut_test = 1e9;
    costs.cut_entry = costs.cut_subset = 1e-9;
    const these_costs dear(costs);
    for (const char* cut : {"axial_cut", "axial_cut:axes=3", "axial_cut:axes=3,limit=off"}) {
        const std::uint64_t subsets = subsets_made(cut_by(cut), small);
        CHECK(subsets > 1);
        CHECK(subsets <= small.size());
    }
}

TEST_CASE("columns are fewer where they cost more, and more where tests do") {
    const std::vector<box> boxes = spread_boxes(3000);
    const std::uint64_t usual = subsets_made({}, boxes);
    cost_model dear;
    dear.column *= 100;
    dear.column_entry *= 100;
    {
        const these_costs costs(dear);
        CHECK(subsets_made({}, boxes) < usual);
    }
    cost_model slow;
    slow.column_test *= 100;
    const these_costs costs(slow);
    CHECK(subsets_made({}, boxes) > usual);
}

TEST_CASE("a list is planned where testing its pairs is cheap, and none where it is dear") {
    const std::vector<box> boxes = spread_boxes(16);
    list_estimate seen{.boxes = 1000, .pairs = 1000, .growth = growth_of_pairs(boxes)};
    seen.law.observe(1, 0.01);
    CHECK(plan_list(seen).frames > 1);
    cost_model dear;
    dear.test_pair *= 100;
    const these_costs costs(dear);
    CHECK(plan_list(seen).frames == 1);
    CHECK_FALSE(is_list_worth_it(1000, 1000, 1000));
}

TEST_CASE("auto builds by sah from fewer queries on where visiting nodes costs more") {
    const auto build_for = [](std::size_t queries) {
        return select_composition({}, {1, 100'000, queries})[strategy_kind::build].name;
    };
    CHECK(build_for(20) == "median");
    cost_model slow;
    slow.node_visit *= 100;
    {
        const these_costs costs(slow);
        CHECK(build_for(20) == "sah");
    }
    cost_model quick;
    quick.sah_triangle = quick.median_triangle / 2;
    const these_costs costs(quick);
    CHECK(build_for(1) == "sah");
}
