#include <benchmark/benchmark.h>

#include "stages.hpp"

import aabb.base;
import aabb.columns;
import aabb.counters;
import aabb.global_search;
import aabb.policy;
import aabb.std;
import aabb.strategies;
import aabblab.cases;

namespace aabblab {

namespace {

constexpr aabb::axis_set swept = 0b001;

template <class Partition>
void time_partition(benchmark::State& state, Partition partition, std::uint32_t objects) {
    const sorted_frame frame(objects);
    const aabb::axis_set cut = partition.axes(frame.boxes(), frame.objects(), swept);
    const aabb::whole_subset all = frame.with_lists(cut | swept);
    aabb::subset_lists subsets;
    aabb::no_counters none;
    for (auto _ : state) {
        benchmark::DoNotOptimize(partition.axes(frame.boxes(), frame.objects(), swept));
        partition.fit(all);
        subsets.distribute(partition, all, swept, none);
        benchmark::ClobberMemory();
    }
    aabb::work_counters counted;
    subsets.distribute(partition, all, swept, counted);
    state.counters["copies/n"] = static_cast<double>(counted[aabb::work::subset_copies]) / objects;
    state.counters["subsets"] = subsets.size();
    if constexpr (aabb::SegmentingPartition<Partition>) {
        state.counters["segments_wanted"] = static_cast<double>(partition.segments().wanted);
        state.counters["segments_got"] = static_cast<double>(partition.segments().got);
    }
    state.counters["bytes"] = static_cast<double>(aabb::bytes_of(partition) + subsets.bytes());
}

/// A partition that cuts first brings boxes to columns bucket by bucket.
template <class Partition>
void time_columns(benchmark::State& state, Partition partition, std::uint32_t objects) {
    const sorted_frame frame(objects);
    aabb::column_search<aabb::bucket_sort, Partition, aabb::simd_sweep, aabb::work_counters> counted({}, partition, {});
    aabb::column_search<aabb::bucket_sort, Partition, aabb::simd_sweep, aabb::no_counters> search({}, partition, {});
    aabb::work_counters work;
    aabb::no_counters none;
    counted.update(frame.boxes(), frame.objects(), work);
    for (auto _ : state) {
        search.update(frame.boxes(), frame.objects(), none);
        benchmark::ClobberMemory();
    }
    state.counters["copies/n"] = static_cast<double>(work[aabb::work::subset_copies]) / objects;
    state.counters["subsets"] = static_cast<double>(work[aabb::work::subsets]);
    state.counters["bytes"] = static_cast<double>(search.partition_bytes());
}

}  // namespace

void add_partition_benchmarks() {
    for_each_strategy(aabb::partitions{}, []<class Partition>(aabb::type_list<Partition>) {
        if constexpr (aabb::ColumnPartition<Partition>)
            for (const aabb::strategy_choice& choice : choices_of<Partition>())
                for (const std::uint32_t objects : sizes)
                    benchmark::RegisterBenchmark(
                        case_name("partition", choice, objects).c_str(),
                        [=](benchmark::State& state) { time_columns(state, made<Partition>(choice), objects); })
                        ->Unit(benchmark::kMicrosecond);
        if constexpr (aabb::CuttingPartition<Partition>)
            for (const aabb::strategy_choice& choice : choices_of<Partition>())
                for (const std::uint32_t objects : sizes)
                    benchmark::RegisterBenchmark(
                        case_name("partition", choice, objects).c_str(),
                        [=](benchmark::State& state) { time_partition(state, made<Partition>(choice), objects); })
                        ->Unit(benchmark::kMicrosecond);
    });
}

}  // namespace aabblab
