export module aabb.sort.inserting;

import aabb.global_search;
import aabb.std;

export namespace aabb {

struct ignore_swaps {
    template <class Entry>
    constexpr bool operator()(const Entry&, const Entry&) const noexcept {
        return true;
    }
};

using gap_of_one = std::integral_constant<std::size_t, 1>;

/// Insertion sort of each subsequence at a distance of `gap`, a pass of Shell sort; by default, the usual insertion
/// sort. It takes n + d comparisons for d inversions in these subsequences.
/// @param on_swap gets the entry that is passed and the one that moves before it; returning false ends the sort there
template <class Entry, CounterPolicy Counters, class OnSwap = ignore_swaps, class Gap = gap_of_one>
constexpr void insert_each(std::span<Entry> list, Counters& counters, OnSwap on_swap = {}, Gap gap = {}) {
    for (std::size_t i = gap; i < list.size(); ++i) {
        const Entry inserted = list[i];
        std::size_t hole = i;
        bool goes_on = true;  // false once `on_swap` has ended the sort
        while (goes_on && hole >= gap) {
            counters.add(work::comparisons);
            if (!precedes(inserted, list[hole - gap])) break;
            goes_on = on_swap(list[hole - gap], inserted);
            list[hole] = list[hole - gap];
            counters.add(work::moves);
            hole -= gap;
        }
        if (hole == i) continue;
        list[hole] = inserted;
        counters.add(work::moves);
        if (!goes_on) return;
    }
}

}  // namespace aabb
