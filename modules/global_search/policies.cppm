export module aabb.global_search:policies;

import aabb.counters;
import aabb.policy;
import aabb.std;
import :membership;
import :projection;

export namespace aabb {

/// Sorts a projection list by key, ascending; the order of equal keys is free. Lists come almost sorted when objects
/// move little between frames.
template <class S>
concept SortPolicy =
    Strategy<S> && requires(S policy, std::span<projection> list, no_counters none, work_counters some) {
        policy.sort(list, none);
        policy.sort(list, some);
    };

namespace detail {
/// An entry that is no projection.
struct other_entry {
    int key;
    friend constexpr bool precedes(const other_entry& e, const other_entry& f) noexcept { return e.key < f.key; }
};
}  // namespace detail

/// A sort that exchanges neighbours only and tells of it: `on_swap(passed, moved)` is called once for each two entries
/// whose order changes, until it returns false: the list is left as it is then. It sorts entries of any type, as
/// `precedes` orders them.
template <class S>
concept SwapReportingSort =
    SortPolicy<S> && requires(S policy, std::span<detail::other_entry> list, no_counters none,
                              bool (*on_swap)(const detail::other_entry& passed, const detail::other_entry& moved)) {
        policy.sort(list, none, on_swap);
    };

/// Puts objects into subsets, such that two overlapping boxes share at least one and exactly one owns the pair. A
/// policy without `for_each_subset` keeps all objects together.
template <class P>
concept PartitionPolicy = Strategy<P>;

/// A partition that really cuts. `axes(boxes, objects, swept)` says which sorted lists it needs beside those of the
/// sweep; `fit(all)` decides the subsets of a frame; `for_each_subset(id, b, visit)` calls
/// `visit(subset, owned_axes)` for each subset that box b of object `id` reaches into, and `copies(id, b)` says how
/// many those are without a walk over them.
template <class P>
concept CuttingPartition =
    PartitionPolicy<P> &&
    requires(P policy, const P fitted, std::span<const box> boxes, const membership& objects, axis_set swept,
             const whole_subset& all, std::uint32_t id, const box& b, void (*visit)(std::uint32_t, axis_set)) {
        { policy.axes(boxes, objects, swept) } -> std::same_as<axis_set>;
        policy.fit(all);
        { fitted.subset_count() } -> std::convertible_to<std::uint32_t>;
        fitted.for_each_subset(id, b, visit);
        { fitted.copies(id, b) } -> std::convertible_to<std::uint64_t>;
    };

namespace detail {
template <template <class Sort, class Sweep, class Counters> class Search>
struct search_of_partition;
}  // namespace detail

/// A partition that cuts before anything is sorted, in a search of its own, made of the three strategies:
/// `search_with<Sort, Sweep, Counters>(sort, partition, sweep)`. Its `update(boxes, objects, counters)` takes boxes
/// that nobody has looked at, `search(pairs, counters)` appends the pairs; `sort_bytes()`, `partition_bytes()` and
/// `sweep_bytes()` say what each holds, `plans()`, `left_out()` and `share_of_update()` what a stage says.
template <class P>
concept SearchingPartition =
    PartitionPolicy<P> && requires { typename detail::search_of_partition<P::template search_with>; };

/// Whether there are subsets at all.
template <PartitionPolicy P>
inline constexpr bool really_cuts = CuttingPartition<P> || SearchingPartition<P>;

/// Into how many segments axes were to be cut, and were; summed over the axes.
struct segment_counts {
    std::uint64_t wanted;
    std::uint64_t got;
};

/// A partition whose subsets come from segments of axes.
template <class P>
concept SegmentingPartition = CuttingPartition<P> && requires(const P fitted) {
    { fitted.segments() } -> std::same_as<segment_counts>;
};

/// Finds the overlapping pairs of a subset from sorted lists. `axes(boxes, objects)` says which projection lists it
/// needs this frame.
template <class S>
concept ListSweep = Strategy<S> && requires(S policy, std::span<const box> boxes, const membership& objects,
                                            const whole_subset& all, const partition_subset& part,
                                            std::vector<index_pair>& pairs, no_counters none, work_counters some) {
    { policy.axes(boxes, objects) } -> std::same_as<axis_set>;
    policy.sweep(all, pairs, none);
    policy.sweep(part, pairs, some);
};

namespace detail {
/// A sort as a sweep that follows swaps may use it.
struct any_swap_reporting_sort {
    static constexpr std::string_view name = "any";
    static constexpr std::string_view summary = "any";
    template <class Entry, class Counters>
    static void sort(std::span<Entry>, Counters&) {}
    template <class Entry, class Counters, class OnSwap>
    static void sort(std::span<Entry>, Counters&, OnSwap) {}
};
}  // namespace detail

/// Keeps the overlapping pairs from frame to frame, and changes them as the swaps of the sort tell: `update` brings the
/// sweep's own lists up to a frame, `search` appends the pairs, `axes` are those on which it has a list.
template <class S>
concept CoherentSweep =
    Strategy<S> && requires(S policy, std::span<const box> boxes, const membership& objects,
                            detail::any_swap_reporting_sort sort, std::vector<index_pair>& pairs, no_counters none) {
        policy.update(boxes, objects, sort, none);
        policy.search(pairs);
        { policy.axes() } -> std::same_as<axis_set>;
    };

/// Why a coherent sweep does not go with these strategies; empty where it does.
template <class... All>
constexpr std::string_view refusal_of_coherent_sweep() {
    if (((CuttingPartition<All> || SearchingPartition<All>) || ...))
        return "a sweep that keeps its pairs between frames cannot follow a partition that makes other subsets in each "
               "frame; it goes with none only";
    if (((SortPolicy<All> && !SwapReportingSort<All>) || ...))
        return "a sweep that keeps its pairs follows the swaps of neighbours, of which this sort does not tell; "
               "it goes with insertion only";
    return {};
}

/// Either of the two.
template <class S>
concept SweepPolicy = ListSweep<S> || CoherentSweep<S>;

}  // namespace aabb
