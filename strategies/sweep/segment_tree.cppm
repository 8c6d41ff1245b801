export module aabb.sweep.segment_tree;

import aabb.global_search;
import aabb.std;
import aabb.segment_trees;

export namespace aabb {

/// Streamed segment trees over all three axes (Zomorodian and Edelsbrunner 2002; see `segment_trees`). When to use:
/// scenes on which sweeps and grids take quadratic time, such as long rods that cross without meeting.
class segment_tree_sweep {
public:
    static constexpr std::string_view name = "segment_tree";
    static constexpr std::string_view summary =
        "streamed segment trees on all axes: O(n log^3 n + k) for n boxes with k pairs, wherever they lie";

    template <class... All>
    static constexpr std::string_view rejects() {
        if (((CuttingPartition<All> || SearchingPartition<All>) || ...))
            return "segment_tree divides boxes by trees of its own; it can be combined with none only";
        return {};
    }

    axis_set axes(std::span<const box> boxes, const membership& objects) {
        longest_.choose(boxes, objects);
        return every_axis;
    }

    template <class Subset, CounterPolicy Counters>
    void sweep(const Subset& subset, std::vector<index_pair>& pairs, Counters& counters) {
        const auto& list = subset.lists[static_cast<std::size_t>(longest_.axis())];
        for (const auto [p, q] : trees_.find(subset.boxes, subset.lists, longest_.axis(), counters)) {
            const auto &a = list[p], &b = list[q];
            if (Subset::owns(Subset::owned(a), Subset::owned(b))) pairs.push_back(ordered_pair(a.id, b.id));
        }
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(trees_); }

private:
    chosen_axis longest_;
    segment_trees trees_;
};

static_assert(ListSweep<segment_tree_sweep>);

}  // namespace aabb
