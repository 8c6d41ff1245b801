export module aabb.global_search:sweep_policy;

import aabb.counters;
import aabb.geometry;
import aabb.policy;
import aabb.std;
import :membership;
import :partition_policy;
import :projection;
import :sort_policy;

export namespace aabb {

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
