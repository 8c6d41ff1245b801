module;
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.global_search:partition_policy;

import aabb.geometry;
import aabb.policy;
import :column_plan;
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

/// A partition that cuts before anything is sorted: `plan(boxes, within)` says into which columns boxes are cut, of
/// which only what lies within the bounds counts; `few()` says of how many nothing is cut, `group(n)` how many of n
/// boxes are cut together, and `threads()` how many threads take such groups.
template <class P>
concept ColumnPartition =
    PartitionPolicy<P> && requires(const P policy, std::span<const box> boxes, const box& within) {
        { policy.plan(boxes, within) } -> std::same_as<column_plan>;
        { policy.few() } -> std::same_as<std::size_t>;
        { policy.group(boxes.size()) } -> std::same_as<std::size_t>;
        { policy.threads() } -> std::same_as<unsigned>;
    };

/// Whether there are subsets at all.
template <PartitionPolicy P>
inline constexpr bool really_cuts = CuttingPartition<P> || ColumnPartition<P>;

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
