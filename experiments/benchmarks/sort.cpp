#include <benchmark/benchmark.h>

#include "stages.hpp"

import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.policy;
import aabb.std;
import aabb.strategies;
import aabblab.cases;
import aabblab.stopwatch;

namespace aabblab {

namespace {

using list_of_frame = std::vector<aabb::projection>;

/// The list of one axis for several frames: each with the keys of its frame in the order of the frame before. So many
/// that the processor does not learn their comparisons by heart.
std::vector<list_of_frame> play_lists(std::uint32_t objects, std::string_view displacement) {
    constexpr std::uint32_t frames = 16;
    constexpr int axis = 0;
    const auto scene = drifting_boxes(objects, frames, displacement);
    std::vector<aabb::box> boxes;
    scene->next(boxes);
    list_of_frame list = sorted_list(boxes, axis);
    std::vector<list_of_frame> lists;
    while (scene->next(boxes)) {
        for (aabb::projection& p : list) p.key = boxes[p.id].min[axis];
        lists.push_back(list);
        std::ranges::sort(list, aabb::precedes);
    }
    return lists;
}

/// Kept for all sorts, and since a benchmark is called several times before its time is taken.
const std::vector<list_of_frame>& lists_of(std::uint32_t objects, std::string_view displacement) {
    static std::map<std::pair<std::uint32_t, std::string_view>, std::vector<list_of_frame>> known;
    std::vector<list_of_frame>& lists = known[{objects, displacement}];
    if (lists.empty()) lists = play_lists(objects, displacement);
    return lists;
}

template <class Sort>
void count_work(benchmark::State& state, Sort sort, std::span<const list_of_frame> lists) {
    aabb::work_counters counted;
    aabb::inversion_counter inversions;
    list_of_frame sorted;
    for (const list_of_frame& list : lists) {
        counted.add(aabb::work::inversions, inversions.count(list));
        sorted = list;
        sort.sort(std::span(sorted), counted);
    }
    const auto elements = static_cast<double>(lists.size() * lists.front().size());
    const auto per_element = [&](aabb::work what) { return static_cast<double>(counted[what]) / elements; };
    state.counters["inversions/n"] = per_element(aabb::work::inversions);
    state.counters["comparisons/n"] = per_element(aabb::work::comparisons);
    // A sort that moves entries out of sight counts no moves.
    if (counted[aabb::work::moves] > 0) state.counters["moves/n"] = per_element(aabb::work::moves);
}

template <class Sort>
void time_sort(benchmark::State& state, Sort sort, std::span<const list_of_frame> lists) {
    aabb::no_counters none;
    list_of_frame list;
    std::size_t next = 0;
    for (auto _ : state) {
        list = lists[next];
        next = (next + 1) % lists.size();
        benchmark::DoNotOptimize(list.data());
        state.SetIterationTime(milliseconds_of([&] {
                                   sort.sort(std::span(list), none);
                                   benchmark::ClobberMemory();
                               }) /
                               1000);
    }
}

}  // namespace

void add_sort_benchmarks() {
    for_each_strategy(aabb::sorts{}, []<class Sort>(aabb::type_list<Sort>) {
        for (const aabb::strategy_choice& choice : choices_of<Sort>())
            for (const std::uint32_t objects : sizes)
                for (const std::string_view displacement : displacements)
                    benchmark::RegisterBenchmark(case_name("sort", choice, objects, displacement).c_str(),
                                                 [=](benchmark::State& state) {
                                                     const auto& lists = lists_of(objects, displacement);
                                                     time_sort(state, made<Sort>(choice), lists);
                                                     count_work(state, made<Sort>(choice), lists);
                                                 })
                        ->UseManualTime()
                        ->Unit(benchmark::kMicrosecond);
    });
}

}  // namespace aabblab
