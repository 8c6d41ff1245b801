// What `auto` selects.

#include "../compositions.hpp"

import aabb.selection;

using namespace aabb;

namespace {

std::string selected(strategy_kind kind, const named_strategies& named, const scene_traits& scene) {
    return to_text(select_composition(named, scene)[kind]);
}

/// Every combination of names that is not rejected.
std::vector<composition> accepted_by_name(enum stage of) {
    std::vector<composition> compositions(1);
    for (const strategy_kind kind : kinds_of(of)) {
        std::vector<composition> longer;
        for (const composition& c : compositions)
            for (const strategy_info& info : strategies(kind)) longer.emplace_back(c)[kind] = {info.name, {}};
        compositions = std::move(longer);
    }
    std::erase_if(compositions, [&](const composition& c) { return !rejection_of(c, of).empty(); });
    return compositions;
}

}  // namespace

TEST_CASE("auto keeps named strategies, and completes them if any combination is valid") {
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
            for (const strategy_choice& choice : all_choices(first))
                for (const strategy_kind second : kinds_of(of))
                    for (const strategy_info& other : strategies(second)) {
                        named_strategies named;
                        named[second] = strategy_choice{other.name, {}};
                        named[first] = choice;
                        const composition c = select_composition(named, {});
                        INFO(to_text(choice) << " with " << other.name << ": " << to_text(c, of));
                        for (const strategy_kind kind : {first, second}) REQUIRE(c[kind] == *named[kind]);
                        REQUIRE(rejection_of(c, of).empty() == can_be_completed(named));
                        rejected += rejection_of(c, of).empty() ? 0 : 1;
                    }
        CHECK((rejected > 0) == (of == stage::global_search));
    }
    const auto completed = [](strategy_kind kind, const char* name) {
        named_strategies named;
        named[kind] = strategy_choice{name, {}};
        return text_of_global(select_composition(named, {}));
    };
    CHECK(completed(strategy_kind::sweep, "incremental") == "insertion + none + incremental");
    // Named strategies are completed by the fastest ones, not by those that are usual in papers.
    CHECK(completed(strategy_kind::sort, "shell") == "shell + none + simd");
    CHECK(completed(strategy_kind::partition, "none") == "bucket + none + simd");
}

TEST_CASE("auto keeps Verlet lists across frames, and builds better trees of meshes that are queried often") {
    CHECK(selected(strategy_kind::prepare, {}, {1}) == "none");
    CHECK(selected(strategy_kind::prepare, {}, {3}) == "none");
    CHECK(selected(strategy_kind::prepare, {}, {4}) == "neighbour_list");
    CHECK(selected(strategy_kind::build, {}, {1, 150'816, 1}) == "median");
    CHECK(selected(strategy_kind::build, {}, {1000, 150'816, 1000}) == "sah");
    // A larger mesh takes longer to build, and more queries to repay it.
    CHECK(selected(strategy_kind::build, {}, {100, 10'000, 100}) == "sah");
    CHECK(selected(strategy_kind::build, {}, {100, 1'000'000, 100}) == "median");
    // With as many triangles in a hundred meshes, a query concerns two hundredths of them, and saves less.
    CHECK(selected(strategy_kind::build, {}, {100, 10'000, 100, 2}) == "sah");
    CHECK(selected(strategy_kind::build, {}, {100, 10'000, 100, 100}) == "median");
}

TEST_CASE("auto lists vertices if queries repay it or meshes are large, and keeps fronts across frames") {
    CHECK(selected(strategy_kind::tree, {}, {1, 150'816, 1, 2}) == "implicit:vertices=fetched");
    CHECK(selected(strategy_kind::tree, {}, {1, 150'816, 1000, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {1, 1'742'828, 1, 2}) == "implicit");
    // The fewer the triangles, the less a query saves by lists; few enough are listed at once.
    CHECK(selected(strategy_kind::tree, {}, {1, 150'816, 100, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {1, 20'000, 100, 2}) == "implicit:vertices=fetched");
    CHECK(selected(strategy_kind::tree, {}, {1, 100, 100, 2}) == "implicit");
    CHECK(selected(strategy_kind::tree, {}, {1}) == "implicit");
    // Fronts are kept from frame to frame.
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
    // A composition is selected for one scene after the other.
    composition c = complete_composition({});
    for (const std::size_t queries : {1, 1000, 1}) {
        select_for_scene(c, {}, {queries, 150'816, queries, 2});
        CHECK(c == select_composition({}, {queries, 150'816, queries, 2}));
    }
}
