export module aabb.global_search:partition_policy;

import aabb.geometry;
import aabb.policy;
import aabb.std;
import :membership;
import :projection;

export namespace aabb {

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

}  // namespace aabb
