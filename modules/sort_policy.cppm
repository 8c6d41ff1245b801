module;
#include <concepts>
#include <span>

export module aabb:sort_policy;

import :counters;
import :policy;
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

/// A sort that exchanges neighbours only and tells of it: `on_swap(passed, moved)` is called once for each two entries
/// whose order changes. It sorts entries of any type, as `precedes` orders them.
template <class S>
concept SwapReportingSort =
    SortPolicy<S> &&
    requires(S policy, std::span<projection> list, no_counters none,
             void (*on_swap)(const projection& passed, const projection& moved)) { policy.sort(list, none, on_swap); };

}  // namespace aabb
