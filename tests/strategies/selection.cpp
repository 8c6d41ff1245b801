// What `auto` selects.

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "../compositions.hpp"

import aabb.selection;

using namespace aabb;

namespace {

std::string selected(strategy_kind kind, const named_strategies& named, const scene_outlook& scene) {
    return to_text(composed_of(select_strategies(named, scene))[kind]);
}

/// From scenes of which nothing is known to those of meshes that are asked often.
const std::vector<scene_outlook> scenes{{},        {0, 0, 0},   {1, 20'417, 1}, {100'000, 20'417, 100'000},
                                        {2, 0, 1}, {1000, 0, 1}};

}  // namespace

TEST_CASE("auto selects a strategy of each kind with a reason, exact, of which nothing is refused") {
    for (const scene_outlook& scene : scenes) {
        const std::vector<selected_strategy> all = select_strategies({}, scene);
        REQUIRE(all.size() == strategy_kind_count);
        for (const selected_strategy& one : all) CHECK_FALSE(one.rule.empty());
        const composition c = composed_of(all);
        for (const enum stage of : {stage::global_search, stage::local_detection}) {
            CHECK(refusal_of(c, of).empty());
            CHECK(is_exact(c, of));
        }
        CHECK(needs_meshes(c).empty());
    }
}

TEST_CASE("auto keeps what is named, whatever it is, and completes it where it can be completed") {
    for (const strategy_kind kind : strategy_kinds)
        for (const strategy_choice& choice : all_choices(kind)) {
            named_strategies named;
            named[kind] = choice;
            INFO(to_text(choice));
            for (const scene_outlook& scene : scenes) {
                const composition c = composed_of(select_strategies(named, scene));
                CHECK(c[kind] == choice);
                for (const enum stage of : {stage::global_search, stage::local_detection})
                    CHECK(refusal_of(c, of) == refusal_of(composition(named), of));
            }
        }
}

TEST_CASE("auto keeps lists where frames follow each other, and builds well what is asked often") {
    CHECK(selected(strategy_kind::prepare, {}, {1}) == "none");
    CHECK(selected(strategy_kind::prepare, {}, {3}) == "none");
    CHECK(selected(strategy_kind::prepare, {}, {4}) == "neighbour_list");
    CHECK(selected(strategy_kind::build, {}, {1, 150'816, 1}) == "median");
    CHECK(selected(strategy_kind::build, {}, {1000, 150'816, 1000}) == "sah");
    // A larger mesh takes longer to build, and more queries to repay it.
    CHECK(selected(strategy_kind::build, {}, {100, 10'000, 100}) == "sah");
    CHECK(selected(strategy_kind::build, {}, {100, 1'000'000, 100}) == "median");
}
