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

/// Insertion sort: n + d comparisons for d inversions.
/// @param on_swap gets the entry that is passed and the one that moves before it; returning false ends the sort there
template <class Entry, CounterPolicy Counters, class OnSwap = ignore_swaps>
constexpr void insert_each(std::span<Entry> list, Counters& counters, OnSwap on_swap = {}) {
    for (std::size_t i = 1; i < list.size(); ++i) {
        const Entry inserted = list[i];
        std::size_t hole = i;
        bool goes_on = true;
        while (goes_on && hole > 0) {
            counters.add(work::comparisons);
            if (!precedes(inserted, list[hole - 1])) break;
            goes_on = on_swap(list[hole - 1], inserted);
            list[hole] = list[hole - 1];
            counters.add(work::moves);
            --hole;
        }
        if (hole == i) continue;
        list[hole] = inserted;
        counters.add(work::moves);
        if (!goes_on) return;
    }
}

}  // namespace aabb
