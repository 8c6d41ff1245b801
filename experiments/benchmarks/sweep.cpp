#include <benchmark/benchmark.h>

#include "stages.hpp"

import aabb.columns;
import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.policy;
import aabb.std;
import aabb.strategies;
import aabblab.cases;

namespace aabblab {

namespace {

void report(benchmark::State& state, const aabb::work_counters& counted, std::size_t pairs, double objects) {
    state.counters["box_tests/n"] = static_cast<double>(counted[aabb::work::box_tests]) / objects;
    state.counters["pairs/n"] = static_cast<double>(pairs) / objects;
}

template <aabb::ListSweep Sweep>
[[nodiscard]] aabb::axis_set swept_axes(Sweep& sweep, const sorted_frame& frame) {
    return sweep.axes(frame.boxes(), frame.objects());
}

/// A sweep over several lists may walk every pair that overlaps on any of them, and all_axes does so for each block of
/// its bits: with the largest scene that is no micro-benchmark.
template <aabb::ListSweep Sweep>
[[nodiscard]] bool takes_one_list(const aabb::strategy_choice& choice) {
    Sweep sweep = made<Sweep>(choice);
    return std::popcount(swept_axes(sweep, sorted_frame(sizes.front()))) == 1;
}

template <aabb::ListSweep Sweep>
void time_sweep(benchmark::State& state, Sweep sweep, std::uint32_t objects) {
    const sorted_frame frame(objects);
    const aabb::whole_subset all = frame.with_lists(swept_axes(sweep, frame));
    std::vector<aabb::index_pair> pairs;
    aabb::work_counters counted;
    sweep.sweep(all, pairs, counted);  // which grows the buffers too
    report(state, counted, pairs.size(), objects);
    aabb::no_counters none;
    for (auto _ : state) {
        pairs.clear();
        sweep.sweep(all, pairs, none);
        benchmark::DoNotOptimize(pairs.data());
        benchmark::ClobberMemory();
    }
}

/// Over the columns of a whole frame, cut and filled before.
template <aabb::ColumnSweep Sweep>
void time_columns(benchmark::State& state, Sweep sweep, std::uint32_t objects) {
    const sorted_frame frame(objects);
    aabb::column_lists columns;
    aabb::bucket_sort sort;
    aabb::no_counters none;
    constexpr auto any_number = std::numeric_limits<std::uint64_t>::max();
    const aabb::column_plan plan = aabb::columns_partition().plan(frame.boxes(), aabb::everywhere);
    if (columns.fill(frame.boxes(), {}, plan, false, any_number, sort, none) != aabb::fill_result::whole)
        throw std::logic_error("the scene has a box that is not valid");
    std::vector<aabb::index_pair> pairs;
    aabb::work_counters counted;
    sweep.sweep(columns.block(), pairs, any_number, counted);
    report(state, counted, pairs.size(), objects);
    for (auto _ : state) {
        pairs.clear();
        benchmark::DoNotOptimize(sweep.sweep(columns.block(), pairs, any_number, none));
        benchmark::ClobberMemory();
    }
}

template <aabb::CoherentSweep Sweep, class Sort, class... Sorts>
[[nodiscard]] auto sort_for(aabb::type_list<Sort, Sorts...>) {
    if constexpr (aabb::refusal<Sort, Sweep>().empty())
        return Sort{};
    else
        return sort_for<Sweep>(aabb::type_list<Sorts...>{});
}

/// Plays frames forth and back, so that a step is always one frame long, however often.
template <aabb::CoherentSweep Sweep>
class moving_sweep {
public:
    moving_sweep(Sweep sweep, std::span<const std::vector<aabb::box>> frames)
        : sweep_(std::move(sweep)), frames_(frames) {
        for (std::uint32_t id = 0; id < frames_[0].size(); ++id) objects_.insert(id);
        aabb::no_counters none;
        sweep_.update(frames_[0], objects_, sort_, none);
        objects_.settle();
    }

    /// Until it is back at the first frame.
    [[nodiscard]] std::size_t period() const noexcept { return 2 * (frames_.size() - 1); }

    template <aabb::CounterPolicy Counters>
    void step(std::vector<aabb::index_pair>& pairs, Counters& counters) {
        step_ = (step_ + 1) % period();
        sweep_.update(frames_[std::min(step_, period() - step_)], objects_, sort_, counters);
        sweep_.search(pairs);
    }

private:
    Sweep sweep_;
    decltype(sort_for<Sweep>(aabb::sorts{})) sort_;
    std::span<const std::vector<aabb::box>> frames_;
    aabb::membership objects_;
    std::size_t step_ = 0;
};

template <aabb::CoherentSweep Sweep>
void time_steps(benchmark::State& state, Sweep sweep, std::uint32_t objects, std::string_view displacement) {
    constexpr std::uint32_t last_frame = 16;
    const auto scene = drifting_boxes(objects, last_frame, displacement);
    std::vector<std::vector<aabb::box>> frames(scene->frames());
    for (auto& boxes : frames) scene->next(boxes);
    moving_sweep<Sweep> moving(std::move(sweep), frames);
    std::vector<aabb::index_pair> pairs;
    aabb::work_counters counted;
    for (std::size_t i = 0; i < moving.period(); ++i) moving.step(pairs, counted);  // which grows the buffers too
    report(state, counted, pairs.size(), static_cast<double>(objects * moving.period()));
    aabb::no_counters none;
    for (auto _ : state) {
        pairs.clear();
        moving.step(pairs, none);
        benchmark::DoNotOptimize(pairs.data());
        benchmark::ClobberMemory();
    }
}

template <aabb::ListSweep Sweep>
void add(const aabb::strategy_choice& choice) {
    const std::size_t cases = takes_one_list<Sweep>(choice) ? sizes.size() : sizes.size() - 1;
    for (const std::uint32_t objects : std::span(sizes).first(cases))
        benchmark::RegisterBenchmark(case_name("sweep", choice, objects).c_str(), [=](benchmark::State& state) {
            time_sweep(state, made<Sweep>(choice), objects);
        })->Unit(benchmark::kMicrosecond);
    if constexpr (aabb::ColumnSweep<Sweep>)
        for (const std::uint32_t objects : sizes)
            benchmark::RegisterBenchmark(
                case_name("sweep_columns", choice, objects).c_str(),
                [=](benchmark::State& state) { time_columns(state, made<Sweep>(choice), objects); })
                ->Unit(benchmark::kMicrosecond);
}

template <aabb::CoherentSweep Sweep>
void add(const aabb::strategy_choice& choice) {
    for (const std::uint32_t objects : std::span(sizes).first(sizes.size() - 1))
        for (const std::string_view displacement : displacements)
            benchmark::RegisterBenchmark(
                case_name("sweep", choice, objects, displacement).c_str(),
                [=](benchmark::State& state) { time_steps(state, made<Sweep>(choice), objects, displacement); })
                ->Unit(benchmark::kMicrosecond);
}

}  // namespace

void add_sweep_benchmarks() {
    for_each_strategy(aabb::sweeps{}, []<class Sweep>(aabb::type_list<Sweep>) {
        for (const aabb::strategy_choice& choice : choices_of<Sweep>()) add<Sweep>(choice);
    });
}

}  // namespace aabblab
