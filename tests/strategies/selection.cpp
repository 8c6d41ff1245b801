// What `auto` selects.

#include "../compositions.hpp"

import aabb.selection;

using namespace aabb;

namespace {

std::string selected(strategy_kind kind, const named_strategies& named, const scene_traits& scene) {
    return to_text(select_composition(named, scene)[kind]);
}

/// Every combination of names that is not refused.
std::vector<composition> accepted_by_name(enum stage of) {
    std::vector<composition> all(1);
    for (const strategy_kind kind : kinds_of(of)) {
        std::vector<composition> longer;
        for (const composition& c : all)
            for (const strategy_info& info : strategies(kind)) longer.emplace_back(c)[kind] = {info.name, {}};
        all = std::move(longer);
    }
    std::erase_if(all, [&](const composition& c) { return !rejection_of(c, of).empty(); });
    return all;
}

}  // namespace

TEST_CASE("auto keeps what is named, whatever it is, and completes it where it can be completed") {
    for (const enum stage of : {stage::global_search, stage::local_detection}) {
        const std::vector<composition> accepted = accepted_by_name(of);
        const auto can_be_completed = [&](const named_strategies& named) {
            return std::ranges::any_of(accepted, [&](const composition& c) {
                return std::ranges::all_of(strategy_kinds, [&](strategy_kind kind) {
                    return !named[kind] || c[kind].name == named[kind]->name;
                });
            });
        };
        std::size_t rejected = 0;
        for (const strategy_kind first : kinds_of(of))
            for (const strategy_choice& one : all_choices(first))
                for (const strategy_kind second : kinds_of(of))
                    for (const strategy_info& other : strategies(second)) {
                        named_strategies named;
                        named[second] = strategy_choice{other.name, {}};
                        named[first] = one;
                        const composition c = select_composition(named, {});
                        INFO(to_text(one) << " with " << other.name << ": " << to_text(c, of));
                        for (const strategy_kind kind : {first, second}) REQUIRE(c[kind] == *named[kind]);
                        REQUIRE(rejection_of(c, of).empty() == can_be_completed(named));
                        rejected += rejection_of(c, of).empty() ? 0 : 1;
                    }
        CHECK((rejected > 0) == (of == stage::global_search));
    }
    const auto beside = [](strategy_kind kind, const char* name) {
        named_strategies named;
        named[kind] = strategy_choice{name, {}};
        return text_of_global(select_composition(named, {}));
    };
    CHECK(beside(strategy_kind::sweep, "incremental") == "insertion + none + incremental");
    // Beside what is named stands what is fastest, not what is usual in papers.
    CHECK(beside(strategy_kind::sort, "shell") == "shell + none + simd");
    CHECK(beside(strategy_kind::partition, "none") == "bucket + none + simd");
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
    // Of as many triangles in a hundred meshes, a query meets two hundredths, and saves less.
    CHECK(selected(strategy_kind::build, {}, {100, 10'000, 100, 2}) == "sah");
    CHECK(selected(strategy_kind::build, {}, {100, 10'000, 100, 100}) == "median");
}

TEST_CASE("auto lists vertices where queries repay it or fetch them from far, and keeps fronts where frames follow") {
    CHECK(selected(strategy_kind::tree, {}, {1, 150'816, 1, 2}) == "implicit:vertices=fetched");
    CHECK(selected(strategy_kind::tree, {}, {1, 150'816, 1000, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {1, 1'742'828, 1, 2}) == "implicit");
    // The fewer the triangles, the less a query saves by lists; few enough are listed in no time.
    CHECK(selected(strategy_kind::tree, {}, {1, 150'816, 100, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {1, 20'000, 100, 2}) == "implicit:vertices=fetched");
    CHECK(selected(strategy_kind::tree, {}, {1, 100, 100, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {1}) == "implicit");
    // What frames have in common is kept.
    CHECK(selected(strategy_kind::tree, {}, {3, 150'816, 100, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {4, 150'816, 100, 2}) == "implicit:front=kept");
    CHECK(selected(strategy_kind::tree, {}, {4, 512, 100, 2}) == "implicit:front=kept");
    CHECK(selected(strategy_kind::tree, {}, {4, 511, 100, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {4, 20'000, 100, 2}) == "implicit:vertices=fetched,front=kept");
    CHECK(selected(strategy_kind::tree, {}, {4}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {10, 150'816, 10'240, 2}) == "implicit:front=kept");
    CHECK(selected(strategy_kind::tree, {}, {10, 150'816, 10'241, 2}) == "implicit");
    named_strategies inexact;
    inexact[strategy_kind::triangle] = strategy_choice{"moller", {}};
    CHECK(selected(strategy_kind::tree, inexact, {4, 150'816, 100, 2}) == "implicit");
    named_strategies named;
    named[strategy_kind::tree] = strategy_choice{"implicit", {}};
    CHECK(selected(strategy_kind::tree, named, {1, 150'816, 1, 2}) == "implicit");
    // For one scene after the other.
    composition c = complete_composition({});
    for (const std::size_t queries : {1, 1000, 1}) {
        select_for_scene(c, {}, {queries, 150'816, queries, 2});
        CHECK(c == select_composition({}, {queries, 150'816, queries, 2}));
    }
}
