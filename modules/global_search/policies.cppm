export module aabb.global_search:policies;

import aabb.counters;
import aabb.policy;
import aabb.std;
import :membership;
import :projection;

export namespace aabb {

/// Sorts a projection list by ascending key; equal keys may have any order. Little motion leaves it almost sorted.
template <class S>
concept SortPolicy = Strategy<S> && requires(S policy, std::span<projection> list, no_counters off, work_counters on) {
    policy.sort(list, off);
    policy.sort(list, on);
};

namespace detail {
/// An entry type other than projection.
struct other_entry {
    int key;
    friend constexpr bool precedes(const other_entry& e, const other_entry& f) noexcept { return e.key < f.key; }
};
}  // namespace detail

/// A sort that only swaps neighbours and reports each swap: `on_swap(passed, moved)` is called once for any two entries
/// whose order changes; when it returns false, the sort stops and leaves the list. `precedes` orders entries of any
/// type.
template <class S>
concept SwapReportingSort =
    SortPolicy<S> && requires(S policy, std::span<detail::other_entry> list, no_counters off,
                              bool (*on_swap)(const detail::other_entry& passed, const detail::other_entry& moved)) {
        policy.sort(list, off, on_swap);
    };

/// Puts objects into subsets, such that two overlapping boxes share at least one subset and exactly one owns the pair.
/// A policy without `for_each_subset` keeps all objects in one subset.
template <class P>
concept PartitionPolicy = Strategy<P>;

/// A partition with several subsets. `axes(boxes, objects, swept)` returns the axes whose sorted lists it needs beside
/// those of the sweep; `fit(scene)` chooses the subsets of a frame; `for_each_subset(id, b, visit)` calls
/// `visit(subset, owned_axes)` for each subset that box b of object `id` overlaps; `copies(id, b)` only counts these.
template <class P>
concept CuttingPartition =
    PartitionPolicy<P> &&
    requires(P policy, const P fitted, std::span<const box> boxes, const membership& objects, axis_set swept,
             const whole_subset& scene, std::uint32_t id, const box& b, void (*visit)(std::uint32_t, axis_set)) {
        { policy.axes(boxes, objects, swept) } -> std::same_as<axis_set>;
        policy.fit(scene);
        { fitted.subset_count() } -> std::convertible_to<std::uint32_t>;
        fitted.for_each_subset(id, b, visit);
        { fitted.copies(id, b) } -> std::convertible_to<std::uint64_t>;
    };

namespace detail {
template <template <class Sort, class Sweep, class Counters> class Search>
struct search_of_partition;
}  // namespace detail

/// A partition that cuts before sorting, in a search of its own composed of the three strategies:
/// `search_with<Sort, Sweep, Counters>(sort, partition, sweep)`. Its `update(boxes, objects, counters)` takes boxes
/// that are not validated yet, and `search(pairs, counters)` appends the pairs; `sort_bytes()`, `partition_bytes()` and
/// `sweep_bytes()` are heap bytes, and `plans()`, `left_out()` and `share_of_update()` are as in `global_stage`.
template <class P>
concept SearchingPartition =
    PartitionPolicy<P> && requires { typename detail::search_of_partition<P::template search_with>; };

/// Whether the partition has subsets at all.
template <PartitionPolicy P>
inline constexpr bool really_cuts = CuttingPartition<P> || SearchingPartition<P>;

/// Desired and actual numbers of segments, summed over the axes.
struct segment_counts {
    std::uint64_t wanted;
    std::uint64_t got;
};

/// A partition whose subsets come from segments of axes.
template <class P>
concept SegmentingPartition = CuttingPartition<P> && requires(const P fitted) {
    { fitted.segments() } -> std::same_as<segment_counts>;
};

/// Finds the overlapping pairs of a subset from the sorted lists of the axes that `axes(boxes, objects)` returns.
template <class S>
concept ListSweep = Strategy<S> && requires(S policy, std::span<const box> boxes, const membership& objects,
                                            const whole_subset& scene, const partition_subset& part,
                                            std::vector<index_pair>& pairs, no_counters off, work_counters on) {
    { policy.axes(boxes, objects) } -> std::same_as<axis_set>;
    policy.sweep(scene, pairs, off);
    policy.sweep(part, pairs, on);
};

namespace detail {
/// The interface of a sort that reports its swaps to a sweep.
struct any_swap_reporting_sort {
    static constexpr std::string_view name = "any";
    static constexpr std::string_view summary = "any";
    template <class Entry, class Counters>
    static void sort(std::span<Entry>, Counters&) {}
    template <class Entry, class Counters, class OnSwap>
    static void sort(std::span<Entry>, Counters&, OnSwap) {}
};
}  // namespace detail

/// Keeps the overlapping pairs between frames and updates them by the swaps of the sort: `update` updates the sweep's
/// own lists to a frame, `search` appends the pairs, and `axes` are the axes on which it has a list.
template <class S>
concept CoherentSweep =
    Strategy<S> && requires(S policy, std::span<const box> boxes, const membership& objects,
                            detail::any_swap_reporting_sort sort, std::vector<index_pair>& pairs, no_counters off) {
        policy.update(boxes, objects, sort, off);
        policy.search(pairs);
        { policy.axes() } -> std::same_as<axis_set>;
    };

template <class S>
concept SweepPolicy = ListSweep<S> || CoherentSweep<S>;

}  // namespace aabb
