module;
#include <cassert>

export module aabb.global_search:interval_ends;

import aabb.std;
import :pair_set;
import :policies;

// What sweeps share that keep the overlapping pairs between frames and follow the swaps of a sort.
export namespace aabb {

/// One end of an object's interval on an axis. A lower end comes before an upper end of the same value, so touching is
/// overlapping.
struct interval_end {
    float key;
    std::uint32_t id : 31;
    std::uint32_t is_upper : 1;

    friend constexpr bool precedes(const interval_end& e, const interval_end& f) noexcept {
        return e.key < f.key || (e.key == f.key && e.is_upper < f.is_upper);
    }
};
static_assert(sizeof(interval_end) == 8);

/// That `interval_end` can tell apart.
inline constexpr std::size_t most_interval_objects = std::size_t{1} << 31;

[[nodiscard]] inline interval_end lower_end(std::span<const box> boxes, std::uint32_t id, std::size_t axis) {
    return {boxes[id].min[static_cast<int>(axis)], id, 0};
}
[[nodiscard]] inline interval_end upper_end(std::span<const box> boxes, std::uint32_t id, std::size_t axis) {
    return {boxes[id].max[static_cast<int>(axis)], id, 1};
}

/// Where the end lies now.
[[nodiscard]] inline float key_of(const interval_end& e, std::span<const box> boxes, std::size_t axis) {
    return e.is_upper ? boxes[e.id].max[static_cast<int>(axis)] : boxes[e.id].min[static_cast<int>(axis)];
}

inline void sort_ends(std::vector<interval_end>& list) {
    std::ranges::sort(list, [](const auto& e, const auto& f) { return precedes(e, f); });
}

/// Puts a pair in where an overlap may begin with a swap, and takes it out where one ends.
/// @param before the boxes of the frame before
template <CounterPolicy Counters>
inline void take_note_of_swap(const interval_end& passed, const interval_end& mover, std::span<const box> before,
                              std::span<const box> boxes, pair_set& pairs, Counters& counters) {
    if (passed.is_upper == mover.is_upper) return;
    const index_pair pair = ordered_pair(passed.id, mover.id);
    counters.add(work::box_tests);
    // Few of the pairs whose overlap ends on this axis overlapped on the others: a test spares the look-up.
    if (mover.is_upper) {
        if (overlaps(before[pair.a], before[pair.b])) pairs.erase(pair);
    } else if (overlaps(boxes[pair.a], boxes[pair.b])) {
        pairs.insert(pair);
    }
}

/// What they hand out, and with which strategies they go.
class kept_pairs {
public:
    template <class... All>
    static constexpr std::string_view refuses() {
        return refusal_of_coherent_sweep<All...>();
    }

    void search(std::vector<index_pair>& pairs) const {
        pairs.insert(pairs.end(), pairs_.pairs().begin(), pairs_.pairs().end());
    }

protected:
    pair_set pairs_;
};

/// Sweeps a list of ends for the pairs of which one at least is new.
class interval_sweep {
public:
    /// @returns how many pairs were tested
    std::uint64_t find(std::span<const interval_end> list, std::span<const box> boxes, pair_set& pairs, auto is_new) {
        std::uint64_t tests = 0;
        place_.resize(boxes.size());
        for (const interval_end& e : list) {
            std::vector<std::uint32_t>& own = active_[is_new(e.id)];
            if (e.is_upper) {
                place_[own.back()] = place_[e.id];
                own[place_[e.id]] = own.back();
                own.pop_back();
                continue;
            }
            for (std::size_t of_new = is_new(e.id) ? 0 : 1; of_new < 2; ++of_new) {
                tests += active_[of_new].size();
                for (const std::uint32_t other : active_[of_new])
                    if (overlaps(boxes[e.id], boxes[other])) pairs.insert(ordered_pair(e.id, other));
            }
            place_[e.id] = static_cast<std::uint32_t>(own.size());
            own.push_back(e.id);
        }
        // Every interval that begins ends.
        assert(active_[0].empty() && active_[1].empty());
        return tests;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(place_, active_); }

private:
    std::array<std::vector<std::uint32_t>, 2> active_;  // those met and not yet left, known ones and new ones
    std::vector<std::uint32_t> place_;                  // of an active object in its vector
};

}  // namespace aabb
