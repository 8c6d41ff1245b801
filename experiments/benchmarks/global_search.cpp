#include <benchmark/benchmark.h>

#include "stages.hpp"

import aabb.columns;
import aabb.std;
import aabb.strategies;
import aabblab.cases;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// @param displacement empty if objects do not move
template <class Run>
auto* add_case(std::string_view stage, const aabb::strategy_choice& choice, std::uint32_t objects,
               std::string_view displacement, const Run& run) {
    std::string name = std::string(stage) + "/" + to_text(choice) + "/n:" + std::to_string(objects);
    if (!displacement.empty()) name += "/displacement:" + std::string(displacement);
    return benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMicrosecond);
}

using list_of_frame = std::vector<aabb::projection>;

/// A sort's input in a moving scene: this frame's lower ends, in the sorted order of the previous one. With fewer
/// frames, the branch predictor would learn the outcomes of the comparisons.
std::vector<list_of_frame> lists_over_frames(std::uint32_t objects, std::string_view displacement) {
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

/// Shared by all sorts: Google Benchmark calls each several times.
const std::vector<list_of_frame>& lists_of(std::uint32_t objects, std::string_view displacement) {
    static std::map<std::pair<std::uint32_t, std::string_view>, std::vector<list_of_frame>> cache;
    std::vector<list_of_frame>& lists = cache[{objects, displacement}];
    if (lists.empty()) lists = lists_over_frames(objects, displacement);
    return lists;
}

/// Reports the work of a sort per list element, counted in a separate pass, which is not timed.
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
    const auto per_element = [&](aabb::work kind) { return static_cast<double>(counted[kind]) / elements; };
    state.counters["inversions/n"] = per_element(aabb::work::inversions);
    state.counters["comparisons/n"] = per_element(aabb::work::comparisons);
    // Library sorts do not count moves.
    if (counted[aabb::work::moves] > 0) state.counters["moves/n"] = per_element(aabb::work::moves);
}

/// Times the sort of the lists of successive frames, one per iteration; the copy of a list is not timed.
template <class Sort>
void time_sort(benchmark::State& state, Sort sort, std::span<const list_of_frame> lists) {
    aabb::no_counters none;
    list_of_frame list;
    std::size_t next = 0;
    for (auto _ : state) {
        list = lists[next];
        next = (next + 1) % lists.size();
        benchmark::DoNotOptimize(list.data());
        const wall_stopwatch watch;
        sort.sort(std::span(list), none);
        benchmark::ClobberMemory();
        state.SetIterationTime(watch.ms() / 1000);
    }
}

constexpr aabb::axis_set swept = 0b001;  // x

/// Times what a partition that cuts sorted lists does per frame, for a sweep along `swept`. Work is counted separately.
template <class Partition>
void time_partition(benchmark::State& state, Partition partition, std::uint32_t objects) {
    const sorted_frame frame(objects);
    const aabb::axis_set cut = partition.axes(frame.boxes(), frame.objects(), swept);
    const aabb::whole_subset whole = frame.with_lists(cut | swept);
    aabb::subset_lists subsets;
    aabb::no_counters none;
    for (auto _ : state) {
        benchmark::DoNotOptimize(partition.axes(frame.boxes(), frame.objects(), swept));
        partition.fit(whole);
        subsets.distribute(partition, whole, swept, none);
        benchmark::ClobberMemory();
    }
    aabb::work_counters counted;
    subsets.distribute(partition, whole, swept, counted);
    state.counters["copies/n"] = static_cast<double>(counted[aabb::work::subset_copies]) / objects;
    state.counters["subsets"] = subsets.size();
    if constexpr (aabb::SegmentingPartition<Partition>) {
        state.counters["segments_wanted"] = static_cast<double>(partition.segments().wanted);
        state.counters["segments_got"] = static_cast<double>(partition.segments().got);
    }
    state.counters["bytes"] = static_cast<double>(aabb::bytes_of(partition) + subsets.bytes());
}

/// Times a partition into columns by the update of a whole search; a second search counts the work.
template <class Partition>
void time_column_search(benchmark::State& state, Partition partition, std::uint32_t objects) {
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

void report_work(benchmark::State& state, const aabb::work_counters& counted, std::size_t pairs, double objects) {
    state.counters["box_tests/n"] = static_cast<double>(counted[aabb::work::box_tests]) / objects;
    state.counters["pairs/n"] = static_cast<double>(pairs) / objects;
}

/// True if a sweep uses a single list. A sweep of several lists may visit every pair that overlaps on any axis, and
/// all_axes does so for each block of its bits, which takes too long for a micro-benchmark of the largest scene.
template <aabb::ListSweep Sweep>
[[nodiscard]] bool uses_one_list(const aabb::strategy_choice& choice) {
    const sorted_frame frame(sizes.front());
    return std::popcount(make_configured<Sweep>(choice).axes(frame.boxes(), frame.objects())) == 1;
}

/// Times a sweep over the sorted lists of a whole frame, one search per iteration. The work is counted before.
template <aabb::ListSweep Sweep>
void time_sweep(benchmark::State& state, Sweep sweep, std::uint32_t objects) {
    const sorted_frame frame(objects);
    const aabb::whole_subset whole = frame.with_lists(sweep.axes(frame.boxes(), frame.objects()));
    std::vector<aabb::index_pair> pairs;
    aabb::work_counters counted;
    sweep.sweep(whole, pairs, counted);  // also grows the buffers
    report_work(state, counted, pairs.size(), objects);
    aabb::no_counters none;
    for (auto _ : state) {
        pairs.clear();
        sweep.sweep(whole, pairs, none);
        benchmark::DoNotOptimize(pairs.data());
        benchmark::ClobberMemory();
    }
}

/// Times a sweep over the columns of a whole frame, one search per iteration. The columns are filled before.
template <aabb::ColumnSweep Sweep>
void time_columns(benchmark::State& state, Sweep sweep, std::uint32_t objects) {
    const sorted_frame frame(objects);
    aabb::column_lists columns;
    aabb::bucket_sort sort;
    aabb::no_counters none;
    constexpr auto no_limit = std::numeric_limits<std::uint64_t>::max();
    const aabb::column_plan plan = aabb::columns_partition().plan(frame.boxes(), aabb::everywhere);
    constexpr std::span<const std::uint32_t> ids_are_indices{};
    constexpr bool by_keys = false;  // the sort `bucket` leaves buckets unsorted
    const auto filled = columns.fill(frame.boxes(), ids_are_indices, plan, by_keys, no_limit, sort, none);
    if (filled != aabb::fill_result::complete) throw std::logic_error("the scene has a box that is not valid");
    std::vector<aabb::index_pair> pairs;
    aabb::work_counters counted;
    sweep.sweep(columns.block(), pairs, no_limit, counted);
    report_work(state, counted, pairs.size(), objects);
    for (auto _ : state) {
        pairs.clear();
        benchmark::DoNotOptimize(sweep.sweep(columns.block(), pairs, no_limit, none));
        benchmark::ClobberMemory();
    }
}

/// The first of the sorts that the sweep does not reject.
template <aabb::CoherentSweep Sweep, class Sort, class... Sorts>
[[nodiscard]] auto sort_for(aabb::type_list<Sort, Sorts...>) {
    if constexpr (aabb::rejection<Sort, Sweep>().empty())
        return Sort{};
    else
        return sort_for<Sweep>(aabb::type_list<Sorts...>{});
}

/// A sweep that alternates forwards and backwards through the frames, so that every step spans one frame.
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

    /// The number of steps until the first frame recurs.
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

/// Times a sweep that keeps its pairs, one frame of a moving scene per iteration, forwards and backwards
/// (`moving_sweep`). The work is counted before, over a period, the steps until the first frame recurs.
template <aabb::CoherentSweep Sweep>
void time_steps(benchmark::State& state, Sweep sweep, std::uint32_t objects, std::string_view displacement) {
    constexpr std::uint32_t last_frame = 16;
    const auto scene = drifting_boxes(objects, last_frame, displacement);
    std::vector<std::vector<aabb::box>> frames(scene->frames());
    for (auto& boxes : frames) scene->next(boxes);
    moving_sweep<Sweep> moving(std::move(sweep), frames);
    std::vector<aabb::index_pair> pairs;
    aabb::work_counters counted;
    for (std::size_t i = 0; i < moving.period(); ++i) moving.step(pairs, counted);  // also grows the buffers
    report_work(state, counted, pairs.size(), static_cast<double>(objects * moving.period()));
    aabb::no_counters none;
    for (auto _ : state) {
        pairs.clear();
        moving.step(pairs, none);
        benchmark::DoNotOptimize(pairs.data());
        benchmark::ClobberMemory();
    }
}

/// Adds the benchmarks of a sweep of sorted lists, and, if it can sweep columns, too, those of columns. A sweep of
/// several lists would take too long in the largest scene.
template <aabb::ListSweep Sweep>
void add_sweep(const aabb::strategy_choice& choice) {
    const std::size_t cases = uses_one_list<Sweep>(choice) ? sizes.size() : sizes.size() - 1;
    for (const std::uint32_t objects : std::span(sizes).first(cases))
        add_case("sweep", choice, objects, {},
                 [=](benchmark::State& state) { time_sweep(state, make_configured<Sweep>(choice), objects); });
    if constexpr (aabb::ColumnSweep<Sweep>)
        for (const std::uint32_t objects : sizes)
            add_case("sweep_columns", choice, objects, {},
                     [=](benchmark::State& state) { time_columns(state, make_configured<Sweep>(choice), objects); });
}

/// Adds a sweep that keeps its pairs, at each displacement.
template <aabb::CoherentSweep Sweep>
void add_sweep(const aabb::strategy_choice& choice) {
    for (const std::uint32_t objects : std::span(sizes).first(sizes.size() - 1))
        for (const std::string_view displacement : displacements) {
            const auto run = [=](benchmark::State& state) {
                time_steps(state, make_configured<Sweep>(choice), objects, displacement);
            };
            add_case("sweep", choice, objects, displacement, run);
        }
}

}  // namespace

/// Adds a benchmark per sort, setting of its parameters, number of objects and displacement.
void add_sort_benchmarks() {
    for_each_strategy(aabb::sorts{}, []<class Sort>(aabb::type_list<Sort>) {
        for (const aabb::strategy_choice& choice : choices_of<Sort>())
            for (const std::uint32_t objects : sizes)
                for (const std::string_view displacement : displacements)
                    add_case("sort", choice, objects, displacement, [=](benchmark::State& state) {
                        const auto& lists = lists_of(objects, displacement);
                        time_sort(state, make_configured<Sort>(choice), lists);
                        count_work(state, make_configured<Sort>(choice), lists);
                    })->UseManualTime();
    });
}

/// Adds a benchmark per partition, setting and number of objects; `none` and others have nothing to time.
void add_partition_benchmarks() {
    for_each_strategy(aabb::partitions{}, []<class Partition>(aabb::type_list<Partition>) {
        for (const aabb::strategy_choice& choice : choices_of<Partition>())
            for (const std::uint32_t objects : sizes) {
                if constexpr (aabb::ColumnPartition<Partition>)
                    add_case("partition", choice, objects, {}, [=](benchmark::State& state) {
                        time_column_search(state, make_configured<Partition>(choice), objects);
                    });
                if constexpr (aabb::CuttingPartition<Partition>)
                    add_case("partition", choice, objects, {}, [=](benchmark::State& state) {
                        time_partition(state, make_configured<Partition>(choice), objects);
                    });
            }
    });
}

void add_sweep_benchmarks() {
    for_each_strategy(aabb::sweeps{}, []<class Sweep>(aabb::type_list<Sweep>) {
        for (const aabb::strategy_choice& choice : choices_of<Sweep>()) add_sweep<Sweep>(choice);
    });
}

}  // namespace aabblab
