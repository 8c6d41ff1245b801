export module aabb.sort.std;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// std::sort, a baseline that gains nothing from order between frames. When to use: objects that jump.
/// It moves entries out of sight, so it counts comparisons only.
struct std_sort {
    static constexpr std::string_view name = "std";
    static constexpr std::string_view summary = "std::sort: n log n whatever the order";

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
