/// Sorts the rows of a list.
module aabblab.checking:pair_sort;

import aabb.std;
import aabblab.checking;
import aabblab.pair_output;

namespace aabblab {

/// Sorts pairs by counting one of their ids.
/// @param ids above the greatest id
template <class IdOf>
void sort_by_id(std::span<const aabb::index_pair> pairs, std::size_t ids, std::span<aabb::index_pair> sorted,
                IdOf id_of) {
    std::vector<std::size_t> begins(ids + 1);
    for (const aabb::index_pair& pair : pairs) ++begins[std::size_t{id_of(pair)} + 1];
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    for (const aabb::index_pair& pair : pairs) sorted[begins[id_of(pair)]++] = pair;
}

/// Sorts pairs, in linear time if their ids are not much more than the pairs: by b, then by a, in the order of b.
/// @param ids of the scene; those of pairs may be any
inline void sort_pairs(std::span<aabb::index_pair> pairs, std::size_t ids) {
    // Ids that count from 1 are up to the number of objects.
    const bool are_known =
        std::ranges::all_of(pairs, [&](const aabb::index_pair& pair) { return pair.a <= ids && pair.b <= ids; });
    if (!are_known || ids / 4 > pairs.size()) return sort_rows(pairs);
    std::vector<aabb::index_pair> by_b(pairs.size());
    sort_by_id(pairs, ids + 1, by_b, [](const aabb::index_pair& pair) { return pair.b; });
    sort_by_id(by_b, ids + 1, pairs, [](const aabb::index_pair& pair) { return pair.a; });
}

}  // namespace aabblab
