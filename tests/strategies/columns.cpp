#include <rapidcheck.h>
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "../compositions.hpp"

import aabb.partition.columns;
import aabb.sort.bucket;
import aabb.sweep.simd;

using namespace aabb;

namespace {

std::vector<box> random_boxes(std::size_t n, double world, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, world);
    std::vector<box> boxes(n);
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            const double at = place(random);
            b.min[k] = static_cast<float>(at);
            b.max[k] = static_cast<float>(at + size * (random() % 8 == 0 ? 3 : 1));
        }
    return boxes;
}

/// From one sorted list, in order.
std::vector<index_pair> true_pairs(const std::vector<box>& boxes) {
    const auto search = global_of(composed({{strategy_kind::sort, "std"}}));
    for (std::uint32_t id = 0; id < boxes.size(); ++id) search->insert(id);
    std::vector<index_pair> pairs;
    search->update(boxes);
    search->search(pairs);
    std::ranges::sort(pairs);
    return pairs;
}

composition columns_with(const std::string& settings) {
    return composed({{strategy_kind::partition, ("columns" + settings).c_str()}});
}

using search_by_columns = global_search<bucket_sort, columns_partition, simd_sweep, work_counters>;

}  // namespace

TEST_CASE("groups of any size find the same pairs, in an order that no number of threads changes") {
    const std::vector<box> boxes = random_boxes(20'000, 27, 0.7, 1);
    const std::vector<index_pair> expected = true_pairs(boxes);
    const std::vector<box> elsewhere = random_boxes(20'000, 27, 0.7, 2);
    REQUIRE(expected.size() > 20'000);
    for (const std::string group : {"auto", "1", "17", "400", "3000"}) {
        std::vector<index_pair> first;
        for (const char* threads : {"1", "2", "3", "7"}) {
            INFO("group=" << group << ", threads=" << threads);
            const auto search = global_of(columns_with(":group=" + group + ",threads=" + threads));
            for (std::uint32_t id = 0; id < boxes.size(); ++id) search->insert(id);
            std::vector<index_pair> pairs;
            for (const std::vector<box>& frame : {boxes, elsewhere, boxes}) {
                pairs.clear();
                search->update(frame);
                search->search(pairs);
            }
            if (first.empty()) first = pairs;
            CHECK(pairs == first);
            std::ranges::sort(pairs);
            CHECK(pairs == expected);
        }
    }
}

TEST_CASE("more boxes than one group takes are put into groups") {
    const std::vector<box> boxes = random_boxes(50'000, 80, 1, 2);
    const auto search = global_of(columns_with(""), instrumentation::counters);
    for (std::uint32_t id = 0; id < boxes.size(); ++id) search->insert(id);
    std::vector<index_pair> pairs;
    search->update(boxes);
    search->search(pairs);
    std::ranges::sort(pairs);
    CHECK(pairs == true_pairs(boxes));
}

TEST_CASE("a plan is made anew when a scene changes its nature, so that work does not stay high") {
    const std::vector<box> wide = random_boxes(4000, 40, 1, 3);
    std::vector<box> packed = wide;  // all where a single column was
    for (box& b : packed)
        for (int k = 0; k < 3; ++k) {
            b.min[k] = b.min[k] / 32;
            b.max[k] = b.min[k] + 1.0F / 32;
        }
    search_by_columns search;
    for (std::uint32_t id = 0; id < wide.size(); ++id) search.insert(id);
    std::vector<index_pair> pairs;
    const auto tests_of = [&](const std::vector<box>& boxes) {
        const std::uint64_t before = search.counters()[work::box_tests];
        pairs.clear();
        search.update(boxes);
        search.search(pairs);
        return search.counters()[work::box_tests] - before;
    };
    for (int frame = 0; frame < 3; ++frame) tests_of(wide);
    const std::uint64_t surprised = tests_of(packed);
    const std::uint64_t settled = tests_of(packed);
    CHECK(2 * settled < surprised);
    std::ranges::sort(pairs);
    CHECK(pairs == true_pairs(packed));
}

TEST_CASE("nothing is tested while nothing moves, and everything again once something does") {
    std::vector<box> boxes = random_boxes(3000, 12, 0.7, 4);
    for (const std::uint32_t group : {100'000U, 200U}) {
        search_by_columns search({}, columns_partition({.group = group}), {});
        for (std::uint32_t id = 0; id < boxes.size(); ++id) search.insert(id);
        std::vector<index_pair> expected;
        const auto is_tested = [&] {
            const std::uint64_t before = search.counters()[work::box_tests];
            std::vector<index_pair> pairs;
            search.update(boxes);
            search.search(pairs);
            std::ranges::sort(pairs);
            CHECK(pairs == expected);
            return search.counters()[work::box_tests] > before;
        };
        expected = true_pairs(boxes);
        CHECK(is_tested());
        // Once to notice that nothing moves.
        CHECK(is_tested());
        for (int frame = 0; frame < 20; ++frame) CHECK_FALSE(is_tested());
        // One that is not looked at first, and a little.
        boxes[1234].max[1] = std::nextafter(boxes[1234].max[1], 100.0F);
        expected = true_pairs(boxes);
        CHECK(is_tested());
        CHECK_FALSE(is_tested());
        search.remove(77);
        std::erase_if(expected, [](index_pair p) { return p.a == 77 || p.b == 77; });
        CHECK(is_tested());
        CHECK(is_tested());
        CHECK_FALSE(is_tested());
        search.insert(77);
        expected = true_pairs(boxes);
        CHECK(is_tested());
        boxes.push_back(boxes[5]);
        search.insert(3000);
        expected = true_pairs(boxes);
        CHECK(is_tested());
        boxes.pop_back();
    }
}

TEST_CASE("whole numbers rise with what they stand for, and are the same one by one and in vectors") {
    REQUIRE(rc::check([] {
        const auto any = [] {
            const auto mantissa = static_cast<float>(*rc::gen::inRange(-1000, 1001));
            return std::ldexp(mantissa, *rc::gen::element(-149, -120, -10, 0, 10, 117));
        };
        box bounds;
        for (int k = 0; k < 3; ++k) {
            const float a = any();
            const float b = any();
            bounds.min[k] = std::min(a, b);
            bounds.max[k] = std::max(a, b);
        }
        column_plan plan;
        plan.fit(bounds);
        std::vector<float> at{bounds.min[0], bounds.max[0]};
        for (int i = 0; i < 30; ++i) at.push_back(any());
        std::ranges::sort(at);
        std::uint32_t before = 0;
        for (const float x : at) {
            const std::uint32_t here = plan.whole(x, 0);
            RC_ASSERT(here >= before);
            RC_ASSERT(here <= 65'535U);
            RC_ASSERT(plan.whole(simd::all(x), 0)[0] == here);
            before = here;
        }
    }));
}

TEST_CASE("columns are for a sweep that takes them") {
    composition c = columns_with("");
    c[strategy_kind::sweep] = parse_strategy("one_axis");
    CHECK(refusal_of(c, stage::global_search) ==
          "columns hands over boxes in whole vectors, bucket by bucket; it goes with simd only");
}
