module;
#include <cstddef>
#include <span>
#include <string_view>

export module aabb.sort.insertion;

import aabb;

export namespace aabb {

/// Insertion sort, the paper's traditional method (section 2). When to use: lists that stay almost sorted between
/// frames, where it takes n + d comparisons for d inversions; quadratic on anything else.
struct insertion_sort {
    static constexpr std::string_view name = "insertion";
    static constexpr std::string_view summary =
        "insertion sort, the traditional method: linear on almost sorted lists, else quadratic";

    template <CounterPolicy Counters>
    static constexpr void sort(std::span<projection> list, Counters& counters) {
        for (std::size_t i = 1; i < list.size(); ++i) {
            const projection inserted = list[i];
            std::size_t hole = i;
            while (hole > 0) {
                counters.add(work::comparisons);
                if (!(inserted.key < list[hole - 1].key)) break;
                list[hole] = list[hole - 1];
                counters.add(work::moves);
                --hole;
            }
            if (hole == i) continue;
            list[hole] = inserted;
            counters.add(work::moves);
        }
    }
};

static_assert(SortPolicy<insertion_sort>);

}  // namespace aabb
