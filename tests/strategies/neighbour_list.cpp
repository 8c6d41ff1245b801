#include <rapidcheck.h>
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../compositions.hpp"
#include "../validation/support.hpp"

using namespace aabb;
using Catch::Matchers::Message;

namespace {

aabb::composition listing(const std::string& margin, const std::string& every) {
    return composed({{strategy_kind::prepare, ("neighbour_list:margin=" + margin + ",every=" + every).c_str()}});
}

std::unique_ptr<global_stage> stage_of(const aabb::composition& c, std::size_t objects) {
    auto stage = global_of(c, instrumentation::counters);
    for (std::uint32_t id = 0; id < objects; ++id) stage->insert(id);
    return stage;
}

box cube(float at) {
    return {{at, 0, 0}, {at + 1, 1, 1}};
}

}  // namespace

TEST_CASE("a neighbour list is searched for again when an object leaves its grown box, and not before") {
    // Extents are 1, so boxes are grown by a half.
    std::vector<box> boxes{cube(0), cube(1.75F), cube(10), cube(20)};
    aabb::composition c = listing("0.5", "0");
    c[strategy_kind::partition] = {"uniform_grid", {}};
    const auto stage = stage_of(c, boxes.size());
    // Each search makes cells anew.
    const auto cells = [&] { return stage->counters()[work::subsets]; };
    CHECK(pairs_of(*stage, boxes).empty());
    const std::uint64_t first = cells();
    CHECK(first > 0);
    boxes[0] = cube(0.5F);
    boxes[1] = cube(1.5F);
    CHECK(pairs_of(*stage, boxes) == std::vector<index_pair>{{0, 1}});
    CHECK(cells() == first);
    stage->remove(3);
    CHECK(pairs_of(*stage, boxes).size() == 1);
    CHECK(cells() == first);
    boxes[2] = cube(2.25F);
    CHECK(pairs_of(*stage, boxes) == std::vector<index_pair>{{0, 1}, {1, 2}});
    const std::uint64_t second = cells();
    CHECK(second > first);
    boxes[3] = cube(0);
    stage->insert(3);
    CHECK(pairs_of(*stage, boxes) == std::vector<index_pair>{{0, 1}, {0, 3}, {1, 2}});
    CHECK(cells() > second);
}

TEST_CASE("a stale list misses pairs until its search comes round, and invents none") {
    bool missed_any = false;
    REQUIRE(rc::check([&] {
        const auto every = *rc::gen::inRange<std::uint32_t>(1, 5);
        const std::string margin = *rc::gen::element("0", "0.2", "1");
        const auto n = *rc::gen::inRange<std::size_t>(1, 40);
        const auto stale = stage_of(listing(margin, std::to_string(every)), n);
        const auto exact = stage_of({}, n);
        std::vector<box> boxes(n);
        for (std::uint32_t frame = 0; frame < 9; ++frame) {
            for (box& b : boxes) b = cube(static_cast<float>(*rc::gen::inRange(0, 30)) / 2);
            const std::vector<index_pair> all = pairs_of(*exact, boxes);
            const std::vector<index_pair> found = pairs_of(*stale, boxes);
            RC_ASSERT(std::ranges::includes(all, found));
            if (frame % every == 0) RC_ASSERT(found == all);
            missed_any |= found != all;
        }
    }));
    CHECK(missed_any);
}

TEST_CASE("a neighbour list is exact unless it is kept whatever moves") {
    for (const std::string every : {"0", "1", "2"}) {
        const aabb::composition c = listing("0.1", every);
        INFO(text_of_global(c));
        CHECK(is_exact(c, stage::global_search) == (every != "2"));
    }
}

TEST_CASE("a neighbour list goes on after a frame that its search refuses") {
    aabb::composition c = listing("0.5", "0");
    c[strategy_kind::partition] = {"uniform_grid", {{"cell_size", "1e-30"}}};
    const auto stage = stage_of(c, 2);
    std::vector<box> boxes{cube(0), cube(1e6F)};
    CHECK_THROWS_AS(stage->update(boxes), input_error);
    boxes = {box{{0, 0, 0}, {0, 0, 0}}, box{{0, 0, 0}, {0, 0, 0}}};
    CHECK(pairs_of(*stage, boxes).size() == 1);
}

TEST_CASE("the margin is a number of at least 0") {
    for (const std::string text : {"", "-1", "nan", "inf", "2x"})
        CHECK_THROWS_MATCHES(require_known(strategy_kind::prepare, {"neighbour_list", {{"margin", text}}}), input_error,
                             Message("neighbour_list: margin must be a number of at least 0, not '" + text + "'"));
    CHECK_NOTHROW(require_known(strategy_kind::prepare, {"neighbour_list", {{"margin", "0"}}}));
}
