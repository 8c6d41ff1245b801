export module aabb.sort.insertion;

import aabb.global_search;
import aabb.sort.inserting;
import aabb.std;

export namespace aabb {

/// Insertion sort, the paper's traditional method (section 2). When to use: lists that stay almost sorted between
/// frames, where it takes n + d comparisons for d inversions; quadratic otherwise. It only swaps neighbours, any two
/// entries at most once, and can report each swap.
struct insertion_sort {
    static constexpr std::string_view name = "insertion";
    static constexpr std::string_view summary =
        "insertion sort, the traditional method: linear on almost sorted lists, else quadratic";

    /// @param on_swap as in `insert_each`
    template <class Entry, CounterPolicy Counters, class OnSwap = ignore_swaps>
    static constexpr void sort(std::span<Entry> list, Counters& counters, OnSwap on_swap = {}) {
        insert_each(list, counters, on_swap);
    }
};

static_assert(SwapReportingSort<insertion_sort>);

}  // namespace aabb
