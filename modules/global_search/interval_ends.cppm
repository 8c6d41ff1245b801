module;
#include <cassert>

export module aabb.global_search:interval_ends;

import aabb.std;
import :pair_set;
import :policies;

// Shared by the sweeps that keep the overlapping pairs between frames and follow the swaps of a sort.
export namespace aabb {

/// One end of an object's interval on an axis. Of equal ends a lower one comes first: touching counts as overlap.
struct interval_end {
    float key;
    std::uint32_t id : 31;
    std::uint32_t is_upper : 1;

    friend constexpr bool precedes(const interval_end& e, const interval_end& f) noexcept {
        return e.key < f.key || (e.key == f.key && e.is_upper < f.is_upper);
    }
};
static_assert(sizeof(interval_end) == 8);

/// The number of ids that `interval_end` can represent.
inline constexpr std::size_t most_interval_objects = std::size_t{1} << 31;

/// Appends both ends of an object's interval.
inline void append_ends(std::vector<interval_end>& list, std::span<const box> boxes, std::uint32_t id, int axis) {
    list.push_back({boxes[id].min[axis], id, 0});
    list.push_back({boxes[id].max[axis], id, 1});
}

/// The current coordinate of the end.
[[nodiscard]] inline float key_of(const interval_end& e, std::span<const box> boxes, std::size_t axis) {
    return e.is_upper ? boxes[e.id].max[static_cast<int>(axis)] : boxes[e.id].min[static_cast<int>(axis)];
}

inline void sort_ends(std::vector<interval_end>& list) {
    std::ranges::sort(list, [](const auto& e, const auto& f) { return precedes(e, f); });
}

/// What such sweeps share: the kept pairs, their changes by swaps, and the rule which strategies can be combined.
class kept_pairs {
public:
    /// Why a sweep that keeps its pairs rejects the strategies `All`; empty if it accepts them.
    template <class... All>
    static constexpr std::string_view rejects() {
        if (((CuttingPartition<All> || SearchingPartition<All>) || ...))
            return "a sweep that keeps its pairs between frames cannot use a partition that changes its subsets in "
                   "each frame; it can be combined with none only";
        if (((SortPolicy<All> && !SwapReportingSort<All>) || ...))
            return "a sweep that keeps its pairs between frames follows the swaps of neighbours, which this sort does "
                   "not report; it can be combined with insertion only";
        return {};
    }

    void search(std::vector<index_pair>& pairs) const {
        pairs.insert(pairs.end(), pairs_.pairs().begin(), pairs_.pairs().end());
    }

protected:
    /// Sorts the ends on an axis, and updates `pairs_` at each swap of neighbours: a lower end that passes an upper end
    /// can begin an overlap, the converse ends one. Stops when `steps_left_` is 0: a restart is then cheaper.
    template <class Sort, CounterPolicy Counters>
    void follow_swaps(std::vector<interval_end>& list, std::span<const box> boxes, Sort& sort, Counters& counters) {
        sort.sort(std::span(list), counters, [&](const interval_end& passed, const interval_end& mover) {
            counters.add(work::inversions);
            if (--steps_left_ == 0) return false;                // ends the sort
            if (passed.is_upper == mover.is_upper) return true;  // no overlap begins or ends
            const index_pair pair = ordered_pair(passed.id, mover.id);
            counters.add(work::box_tests);
            if (mover.is_upper) {
                // Most did not overlap on the other axes; testing the previous boxes is faster than a look-up.
                if (overlaps(before_[pair.a], before_[pair.b])) pairs_.erase(pair);
            } else if (overlaps(boxes[pair.a], boxes[pair.b])) {
                pairs_.insert(pair);
            }
            return true;
        });
    }

    pair_set pairs_;
    std::vector<box> before_;       // boxes of the previous frame, by id
    std::uint64_t steps_left_ = 0;  // remaining steps of this frame; 0: the frame restarts
};

/// Sweeps a list of ends for all pairs with at least one new object.
class interval_sweep {
public:
    /// Inserts into `pairs` the overlapping pairs with a new object: sweeps the list, and tests each object against the
    /// active ones, whose intervals contain its lower end: `active_[0]` has the known ones, `active_[1]` the new ones.
    /// @param is_new whether an object, by id, is new; pairs of known objects are already in `pairs`
    /// @returns the number of tested pairs
    std::uint64_t find(std::span<const interval_end> list, std::span<const box> boxes, pair_set& pairs, auto is_new) {
        std::uint64_t tests = 0;
        active_index_.resize(boxes.size());
        for (const interval_end& e : list) {
            std::vector<std::uint32_t>& active = active_[is_new(e.id)];
            if (e.is_upper) {  // the last active object takes the place of the one that ends
                active_index_[active.back()] = active_index_[e.id];
                active[active_index_[e.id]] = active.back();
                active.pop_back();
                continue;
            }
            // A known object is tested against new ones only.
            for (std::size_t of_new = is_new(e.id) ? 0 : 1; of_new < 2; ++of_new) {
                tests += active_[of_new].size();
                for (const std::uint32_t other : active_[of_new])
                    if (overlaps(boxes[e.id], boxes[other])) pairs.insert(ordered_pair(e.id, other));
            }
            active_index_[e.id] = static_cast<std::uint32_t>(active.size());
            active.push_back(e.id);
        }
        // Every interval that begins ends.
        assert(active_[0].empty() && active_[1].empty());
        return tests;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(active_index_, active_); }

private:
    std::array<std::vector<std::uint32_t>, 2> active_;  // active objects: known ones, then new ones
    std::vector<std::uint32_t> active_index_;           // by id: index of an active object in its vector
};

}  // namespace aabb
