export module aabb.sort.std;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// std::sort, a baseline that does not exploit temporal coherence. When to use: objects that jump. Its moves cannot be
/// observed, so it counts comparisons only.
struct std_sort {
    static constexpr std::string_view name = "std";
    static constexpr std::string_view summary = "std::sort: O(n log n) for any order";

    template <CounterPolicy Counters>
    static constexpr void sort(std::span<projection> list, Counters& counters) {
        std::ranges::sort(list, [&counters](const projection& p, const projection& q) {
            counters.add(work::comparisons);
            return precedes(p, q);
        });
    }
};

static_assert(SortPolicy<std_sort>);

}  // namespace aabb
