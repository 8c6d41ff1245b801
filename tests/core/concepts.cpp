#include "../testing.hpp"

#include "fakes.hpp"

using namespace aabb;

static_assert(SortPolicy<fake_sort>);
static_assert(PartitionPolicy<fake_whole_partition> && !CuttingPartition<fake_whole_partition>);
static_assert(CuttingPartition<fake_cutting_partition>);
static_assert(SwapReportingSort<fake_swapping_sort> && !SwapReportingSort<fake_sort>);
static_assert(ListSweep<fake_sweep> && !CoherentSweep<fake_sweep>);
static_assert(CoherentSweep<fake_coherent_sweep> && !ListSweep<fake_coherent_sweep>);
static_assert(!SegmentingPartition<fake_cutting_partition>);
static_assert(TreePolicy<fake_tree>);
static_assert(TrianglePolicy<fake_triangle> && !DoubleTrianglePolicy<fake_triangle>);
static_assert(CounterPolicy<no_counters> && CounterPolicy<work_counters>);

static_assert(!SortPolicy<fake_sweep> && !SweepPolicy<fake_sort> && !TreePolicy<fake_triangle> &&
              !TrianglePolicy<fake_tree>);

// A sweep that rejects other sorts accepts its own.
static_assert(rejection<fake_sort, fake_whole_partition, picky_sweep>().empty());

// A global search without a partition has no members that only a partition needs.
static_assert(sizeof(global_search<fake_sort, fake_whole_partition, fake_sweep>) + 5 * sizeof(std::vector<int>) <=
              sizeof(global_search<fake_sort, fake_cutting_partition, fake_sweep>));

namespace {

const std::vector<box> row = {
    {{-3, 0, 0}, {-1, 1, 1}}, {{-1, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {3, 1, 1}}, {{-9, 0, 0}, {9, 1, 1}}};
const std::vector<index_pair> row_pairs = {{0, 1}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

template <class Partition, class Sweep = fake_sweep>
std::vector<index_pair> pairs_with() {
    global_search<fake_sort, Partition, Sweep> search;
    for (std::uint32_t id = 0; id < row.size(); ++id) search.insert(id);
    std::vector<index_pair> pairs;
    search.update(row);
    search.search(pairs);
    return sorted(pairs);
}

}  // namespace

TEST_CASE("a global search works with minimal strategies") {
    CHECK(pairs_with<fake_whole_partition>() == row_pairs);
    CHECK(pairs_with<fake_cutting_partition>() == row_pairs);
    CHECK(pairs_with<fake_whole_partition, fake_coherent_sweep>() == row_pairs);
}

TEST_CASE("a local detection works with minimal strategies") {
    const mesh steps{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {4, 0, 0}, {5, 0, 0}, {4, 1, 0}, {8, 0, 0}, {9, 0, 0}, {8, 1, 0}},
        {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
    const model<fake_tree> fixed(steps, fake_build());
    local_detection<fake_tree, fake_triangle> detection;
    std::vector<index_pair> pairs;
    detection.all_pairs(fixed, {}, fixed, {}, pairs);
    CHECK(sorted(pairs) == std::vector<index_pair>{{0, 0}, {1, 1}, {2, 2}});
    CHECK(detection.first_pair(fixed, {}, fixed, {}).has_value());
    pose away;
    away.translation = {0, 0, 20};
    CHECK_FALSE(detection.first_pair(fixed, {}, fixed, away).has_value());
}
