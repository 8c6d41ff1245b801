#include <rapidcheck.h>

#include "../testing.hpp"

import aabb.strategies;
import aabb;

using namespace aabb;

namespace {

std::vector<projection> any_list() {
    std::vector<projection> list(*rc::gen::inRange<std::size_t>(0, 3000));
    const int keys = *rc::gen::element(0, 2, 50, 100'000);
    for (std::uint32_t id = 0; id < list.size(); ++id)
        list[id] = {keys == 0 ? *rc::gen::element(0.0F, -0.0F, 3.4e38F, -3.4e38F, 1e-45F, -1e-45F, 1.0F, -2.5F)
                              : static_cast<float>(*rc::gen::inRange(-keys, keys)) / 8,
                    id};
    return list;
}

template <class Sort>
void check_sorts(Sort sort) {
    REQUIRE(rc::check([&] {
        const std::vector<projection> original = any_list();
        std::vector<projection> list = original;
        no_counters counters;
        sort.sort(std::span(list), counters);
        RC_ASSERT(std::ranges::is_sorted(list, precedes));
        std::ranges::sort(list, {}, &projection::id);
        for (std::size_t i = 0; i < list.size(); ++i)
            RC_ASSERT(list[i].id == original[i].id && list[i].key == original[i].key);
    }));
}

std::vector<projection> list_of(const std::vector<float>& keys) {
    std::vector<projection> list;
    for (const float key : keys) list.push_back({key, static_cast<std::uint32_t>(list.size())});
    return list;
}

}  // namespace

TEST_CASE("every sort sorts all finite keys, with zeros of both signs equal, and keeps every entry") {
    []<class... Sorts>(type_list<Sorts...>) { (check_sorts(Sorts{}), ...); }(sorts{});
    const auto& gaps = std::get<0>(shell_sort::parameters);
    for (const std::string_view choice : gaps.names) {
        const auto config = configured<shell_sort>(std::vector<setting>{{std::string(gaps.name), std::string(choice)}});
        check_sorts(shell_sort(config));
    }
}

TEST_CASE("radix sort does not move a sorted list, and skips digits that all keys share") {
    const auto moves = [](float step, bool backwards) {
        std::vector<float> keys;
        for (int i = 0; i < 1000; ++i) keys.push_back(1 + step * static_cast<float>(backwards ? 999 - i : i));
        auto list = list_of(keys);
        work_counters counted;
        radix_sort sort;
        sort.sort(std::span(list), counted);
        CHECK(std::ranges::is_sorted(list, precedes));
        return counted[work::moves];
    };
    CHECK(moves(0x1p-23F, false) == 0);
    // Only the lowest digit differs: once to the other list, and back.
    CHECK(moves(0x1p-23F, true) == 2000);
    CHECK(moves(0x1p-13F, true) == 2000);
    CHECK(moves(1.37F, true) == 4000);
}

TEST_CASE("insertion sort moves and compares in proportion to the inversions") {
    work_counters counted;
    auto list = list_of({3, 1, 2, 5, 4});
    insertion_sort::sort(std::span(list), counted);
    // Three inversions: one comparison each, and one more for each entry that stops before the front.
    CHECK(counted[work::comparisons] == 6);
    CHECK(counted[work::moves] == 6);
    work_counters already_sorted;
    insertion_sort::sort(std::span(list), already_sorted);
    CHECK(already_sorted[work::comparisons] == 4);
    CHECK(already_sorted[work::moves] == 0);
}

TEST_CASE("insertion sort reports each inversion once") {
    REQUIRE(rc::check([] {
        auto list = list_of({});
        for (auto n = *rc::gen::inRange<std::uint32_t>(0, 40); n > 0; --n)
            list.push_back({static_cast<float>(*rc::gen::inRange(0, 9)), n});
        std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
        for (std::size_t i = 0; i < list.size(); ++i)
            for (std::size_t j = i + 1; j < list.size(); ++j)
                if (precedes(list[j], list[i])) expected.emplace_back(list[i].id, list[j].id);
        std::vector<std::pair<std::uint32_t, std::uint32_t>> reported;
        no_counters counters;
        insertion_sort::sort(std::span(list), counters, [&](const projection& passed, const projection& moved) {
            reported.emplace_back(passed.id, moved.id);
            return true;
        });
        RC_ASSERT(sorted(reported) == sorted(expected));
    }));
}

TEST_CASE("insertion sort stops after the swap for which the callback returns false") {
    auto list = list_of({5, 4, 3, 2, 1});
    work_counters counted;
    int swaps = 0;
    insertion_sort::sort(std::span(list), counted, [&](const projection&, const projection&) { return ++swaps < 5; });
    CHECK(swaps == 5);
    CHECK(counted[work::comparisons] == 5);
    std::vector<float> keys;
    for (const projection& p : list) keys.push_back(p.key);
    CHECK(keys == std::vector<float>{3, 2, 4, 5, 1});
}

TEST_CASE("the gap sequences are the published ones") {
    // A pass over gap g compares each of the n - g entries once.
    const auto comparisons = [](const char* gaps, int n = 1000) {
        std::vector<float> keys;
        for (int i = 0; i < n; ++i) keys.push_back(static_cast<float>(i));
        auto list = list_of(keys);
        work_counters counted;
        shell_sort(configured<shell_sort>(std::vector<setting>{{"gaps", gaps}})).sort(std::span(list), counted);
        CHECK(counted[work::moves] == 0);
        return counted[work::comparisons];
    };
    const auto expected = [](const std::vector<std::uint64_t>& gaps, std::uint64_t n = 1000) {
        std::uint64_t sum = 0;
        for (const std::uint64_t gap : gaps) sum += n - gap;
        return sum;
    };
    CHECK(comparisons("shell") == expected({500, 250, 125, 62, 31, 15, 7, 3, 1}));
    CHECK(comparisons("ciura") == expected({701, 301, 132, 57, 23, 10, 4, 1}));
    CHECK(comparisons("tokuda") == expected({525, 233, 103, 46, 20, 9, 4, 1}));
    // Longer lists extend the other sequences, but not these.
    CHECK(comparisons("ciura", 5000) == expected({3548, 1577, 701, 301, 132, 57, 23, 10, 4, 1}, 5000));
    CHECK(comparisons("ciura_eight", 5000) == expected({701, 301, 132, 57, 23, 10, 4, 1}, 5000));
    CHECK(comparisons("four_one", 5000) == expected({4, 1}, 5000));
}
