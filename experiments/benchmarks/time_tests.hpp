#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace aabblab {

/// The pairs in random order, and again in others, 65,536 in all. A processor learns the answers to 5,000 tests by
/// heart when they come in one order again and again, and then a box test takes a third of its time.
template <class Pair>
[[nodiscard]] std::vector<Pair> in_random_order(std::vector<Pair> pairs) {
    constexpr std::size_t count = 1 << 16;
    std::mt19937_64 random(1);  // NOLINT(*-msc51-cpp): the same order in every run
    std::vector<Pair> order;
    while (order.size() < count) {
        for (std::size_t left = pairs.size(); left > 1; --left) std::swap(pairs[left - 1], pairs[random() % left]);
        order.insert(order.end(), pairs.begin(), pairs.end());
    }
    order.resize(count);
    return order;
}

/// An iteration is one test, and the branch on its answer with which a walk goes on or turns back: what the processor
/// loses where it guesses wrongly is a part of what the test costs.
/// @param test with `[[gnu::always_inline]]`: it is called twice here, and the compiler would make it a function of its
/// own, which a walk does not call.
template <class Pair, class Test>
void time_tests(benchmark::State& state, const std::vector<Pair>& pairs, const Test& test) {
    std::size_t hits = 0;
    std::size_t next = 0;
    for (auto _ : state) {
        if (test(pairs[next])) benchmark::DoNotOptimize(++hits);
        if (++next == pairs.size()) next = 0;
    }
    const auto all = static_cast<double>(pairs.size());
    state.counters["hits"] = static_cast<double>(std::ranges::count_if(pairs, test)) / all;
}

}  // namespace aabblab
