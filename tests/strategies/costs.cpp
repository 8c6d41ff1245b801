// Strategies plan by the machine's costs; their results do not depend on them, as global_compositions.cpp tests.

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

std::uint64_t subset_count_of(const composition& c, const std::vector<box>& boxes) {
    const auto stage = search_of(c, boxes.size());
    found_by(*stage, boxes);
    return stage->counters()[work::subsets];
}

composition cut_by(const char* partition) {
    return composed(
        {{strategy_kind::sort, "std"}, {strategy_kind::partition, partition}, {strategy_kind::sweep, "one_axis"}});
}

}  // namespace

TEST_CASE("auto selects a valid, exact strategy of each kind with a reason, whatever work costs") {
    REQUIRE(rc::check([] {
        const scoped_costs costs(*rc::gen::arbitrary<bool>() ? any_costs() : cost_model());
        // From scenes of which nothing is known to scenes whose meshes are queried often.
        scene_traits scene;
        if (*rc::gen::arbitrary<bool>())
            scene = {*rc::gen::element<std::size_t>(0, 1, 2, 3, 4, 63, 64, 1000, 100'000),
                     *rc::gen::element<std::size_t>(0, 1, 20'417, 1'000'000),
                     *rc::gen::inRange<std::size_t>(0, 1'000'000)};
        const std::vector<selected_strategy> selected = select_strategies({}, scene);
        RC_ASSERT(selected.size() == strategy_kind_count);
        RC_ASSERT(std::ranges::none_of(selected, [](const selected_strategy& s) { return s.rule.empty(); }));
        const composition c = composed_of(selected);
        for (const enum stage of : {stage::global_search, stage::local_detection}) {
            RC_ASSERT(rejection_of(c, of).empty());
            RC_ASSERT(is_exact(c, of));
        }
        RC_ASSERT(needs_meshes(c).empty());
    }));
}

TEST_CASE("an axial cut makes fewer subsets if they cost more, and none if tests are free") {
    const std::vector<box> boxes = spread_boxes(3000);
    const composition cut = cut_by("axial_cut");
    const std::uint64_t usual = subset_count_of(cut, boxes);
    CHECK(usual > 1);
    cost_model costs;
    costs.cut_subset *= 100;
    {
        const scoped_costs expensive(costs);
        CHECK(subset_count_of(cut, boxes) < usual);
    }
    costs.cut_test = 1e-6;
    const scoped_costs free(costs);
    CHECK(subset_count_of(cut, boxes) <= 1);
}

TEST_CASE("an automatic axial cut is never rejected, however expensive tests are") {
    std::vector<box> small = spread_boxes(3000);
    for (box& b : small) b.max = {b.min[0] + 0.001F, b.min[1] + 0.001F, b.min[2] + 0.001F};
    cost_model costs;
    costs.cut_test = 1e9;
    costs.cut_entry = costs.cut_subset = 1e-9;
    const scoped_costs expensive(costs);
    for (const char* cut : {"axial_cut", "axial_cut:axes=3", "axial_cut:axes=3,limit=off"}) {
        const std::uint64_t subsets = subset_count_of(cut_by(cut), small);
        CHECK(subsets > 1);
        CHECK(subsets <= small.size());
    }
}

TEST_CASE("columns are fewer if they cost more, and more if tests do") {
    const std::vector<box> boxes = spread_boxes(3000);
    const std::uint64_t usual = subset_count_of({}, boxes);
    cost_model expensive;
    expensive.column *= 100;
    expensive.column_entry *= 100;
    {
        const scoped_costs costs(expensive);
        CHECK(subset_count_of({}, boxes) < usual);
    }
    cost_model slow;
    slow.column_test *= 100;
    const scoped_costs costs(slow);
    CHECK(subset_count_of({}, boxes) > usual);
}

TEST_CASE("a Verlet list is planned only if testing its pairs is cheap") {
    const std::vector<box> boxes = spread_boxes(16);
    list_estimate seen{.boxes = 1000, .pairs = 1000, .growth = growth_of_pairs(boxes)};
    seen.law.observe(1, 0.01);
    CHECK(plan_list(seen).frames > 1);
    cost_model expensive;
    expensive.test_pair *= 100;
    const scoped_costs costs(expensive);
    CHECK(plan_list(seen).frames == 1);
    CHECK_FALSE(is_list_worth_it(1000, 1000, 1000));
}

TEST_CASE("auto selects sah for fewer queries if visiting nodes costs more") {
    const auto build_for = [](std::size_t queries) {
        return select_composition({}, {1, 100'000, queries})[strategy_kind::build].name;
    };
    CHECK(build_for(20) == "median");
    cost_model slow;
    slow.node_visit *= 100;
    {
        const scoped_costs costs(slow);
        CHECK(build_for(20) == "sah");
    }
    cost_model quick;
    quick.sah_triangle = quick.median_triangle / 2;
    const scoped_costs costs(quick);
    CHECK(build_for(1) == "sah");
}
