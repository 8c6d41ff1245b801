export module aabb.global_search:sort_policy;

import aabb.counters;
import aabb.policy;
import aabb.std;
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

namespace detail {
/// An entry that is no projection.
struct other_entry {
    int key;
    friend constexpr bool precedes(const other_entry& e, const other_entry& f) noexcept { return e.key < f.key; }
};
}  // namespace detail

/// A sort that exchanges neighbours only and tells of it: `on_swap(passed, moved)` is called once for each two entries
/// whose order changes, until it returns false: the list is left as it is then. It sorts entries of any type, as
/// `precedes` orders them.
template <class S>
concept SwapReportingSort =
    SortPolicy<S> && requires(S policy, std::span<detail::other_entry> list, no_counters none,
                              bool (*on_swap)(const detail::other_entry& passed, const detail::other_entry& moved)) {
        policy.sort(list, none, on_swap);
    };

}  // namespace aabb
