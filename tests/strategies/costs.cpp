// Strategies plan by the costs of the machine; what they find does not hang on them.

#include <rapidcheck.h>
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "../compositions.hpp"
#include "overlapping.hpp"

import aabb.partition.axial_cut;
import aabb.partition.columns;
import aabb.prepare.list_plan;
import aabb.selection;

using namespace aabb;

namespace {

/// Costs in force for one test.
class these_costs {
public:
    explicit these_costs(const cost_model& costs) { set_machine_costs(costs); }
    these_costs(const these_costs&) = delete;
    these_costs& operator=(const these_costs&) = delete;
    ~these_costs() { set_machine_costs({}); }
};

/// From a billionth of a nanosecond to a second.
cost_model any_costs() {
    cost_model costs;
    for (const cost_info& cost : cost_infos) costs.*cost.value = std::pow(10.0, *rc::gen::inRange(-9, 10));
    return costs;
}

box any_box(int world) {
    box b;
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(*rc::gen::inRange(0, world)) / 4;
        b.max[k] = b.min[k] + static_cast<float>(*rc::gen::element(0, 1, 2, 2, 3, 40)) / 4;
    }
    return b;
}

/// A little, so that lists may serve.
void move_a_little(std::vector<box>& boxes) {
    for (box& b : boxes) {
        const auto k = *rc::gen::inRange(0, 3);
        const float by = static_cast<float>(*rc::gen::inRange(-2, 3)) / 32;
        b.min[k] += by;
        b.max[k] += by;
    }
}

std::vector<box> spread_boxes(std::size_t n) {
    std::vector<box> boxes;
    std::uint64_t random = 1;
    const auto next = [&] {
        random = random * 6364136223846793005U + 1442695040888963407U;
        return static_cast<float>(random >> 40U) / (1U << 24U) * 40;
    };
    for (std::size_t i = 0; i < n; ++i) {
        const float x = next(), y = next(), z = next();
        boxes.push_back({{x, y, z}, {x + 1, y + 1, z + 1}});
    }
    return boxes;
}

std::uint64_t subsets_made(const composition& c, const std::vector<box>& boxes) {
    const auto stage = global_of(c, instrumentation::counters);
    for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
    std::vector<index_pair> found;
    stage->update(boxes);
    stage->search(found);
    return stage->counters()[work::subsets];
}

}  // namespace

TEST_CASE("every composition finds exactly the overlapping pairs, whatever work costs") {
    const std::vector<composition> all = all_global_compositions();
    for (const strategy_choice& partition : all_choices(strategy_kind::partition)) {
        std::vector<composition> compositions;
        for (const composition& c : all)
            if (c[strategy_kind::partition] == partition) compositions.push_back(c);
        if (compositions.empty()) continue;
        INFO(to_text(partition));
        REQUIRE(rc::check([&] {
            const these_costs costs(any_costs());
            const composition c = *rc::gen::elementOf(compositions);
            RC_LOG(text_of_global(c));
            const auto stage = global_of(c);
            std::vector<box> boxes(*rc::gen::inRange<std::size_t>(1, 120));
            const int world = *rc::gen::element(8, 40, 200);
            for (box& b : boxes) b = any_box(world);
            for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
            for (int frame = 0; frame < 6; ++frame) {
                std::vector<index_pair> found;
                stage->update(boxes);
                stage->search(found);
                std::ranges::sort(found);
                RC_ASSERT(found == overlapping(boxes));
                move_a_little(boxes);
            }
        }));
    }
}

TEST_CASE("auto selects what is exact, whatever work costs") {
    REQUIRE(rc::check([] {
        const these_costs costs(any_costs());
        const scene_outlook scene{*rc::gen::inRange<std::size_t>(0, 100), *rc::gen::inRange<std::size_t>(0, 1'000'000),
                                  *rc::gen::inRange<std::size_t>(0, 1'000'000)};
        const composition c = select_composition({}, scene);
        for (const enum stage of : {stage::global_search, stage::local_detection}) {
            RC_ASSERT(refusal_of(c, of).empty());
            RC_ASSERT(is_exact(c, of));
        }
    }));
}

TEST_CASE("an axial cut makes fewer subsets where they cost more, none where tests are free") {
    const std::vector<box> boxes = spread_boxes(3000);
    const composition cut = composed(
        {{strategy_kind::sort, "std"}, {strategy_kind::partition, "axial_cut"}, {strategy_kind::sweep, "one_axis"}});
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
        const std::uint64_t subsets = subsets_made(
            composed(
                {{strategy_kind::sort, "std"}, {strategy_kind::partition, cut}, {strategy_kind::sweep, "one_axis"}}),
            small);
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
    list_outlook seen{.boxes = 1000, .pairs = 1000, .growth = growth_of_pairs(boxes)};
    seen.law.observe(1, 0.01);
    CHECK(plan_list(seen).frames > 1);
    cost_model dear;
    dear.test_pair *= 100;
    const these_costs costs(dear);
    CHECK(plan_list(seen).frames == 1);
    CHECK_FALSE(pays(1000, 1000, 1000));
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
