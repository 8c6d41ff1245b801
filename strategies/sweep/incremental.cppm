module;
#include <cassert>
#include <ranges>

export module aabb.sweep.incremental;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// The classic incremental sweep and prune (Baraff 1992; Cohen, Lin, Manocha and Ponamgi, "I-COLLIDE", 1995): lists of
/// both ends of all intervals are kept sorted by insertion sort, whose swaps mark where overlaps begin and end; the
/// overlapping pairs are kept between frames. When to use: little motion. A frame without motion tests no pair; a frame
/// with much motion costs a test for each lower and upper end that pass each other.
///
/// Once a frame has followed as many swaps as a restart would take steps, it restarts: the lists are sorted by
/// std::sort, and one of them is swept for all pairs. No frame therefore costs more than about twice the cheaper way.
///
/// A pair is inserted when it begins to overlap on an axis and its boxes overlap on all axes. The order of the axes
/// therefore does not matter, and the set never contains a pair that overlaps in neither of the last two frames. Memory
/// is 16 bytes per object and axis, 24 per object for the boxes of the previous frame, up to 36 during insertions and
/// restarts, and 16 to 32 bytes per pair, for the greatest number of pairs so far.
class incremental_sweep : public kept_pairs {
public:
    static constexpr std::string_view name = "incremental";
    static constexpr std::string_view summary =
        "keeps the overlapping pairs between frames and follows the swaps of insertion sort";

    /// Updates the lists and pairs: swaps of two ends in insertion sort begin or end overlaps. After as many steps as a
    /// restart takes (`steps_left_` is 0), sorts and sweeps from scratch.
    template <class Sort, CounterPolicy Counters>
    void update(std::span<const box> boxes, const membership& objects, Sort& sort, Counters& counters) {
        if (boxes.size() > most_interval_objects)
            throw input_error("incremental takes at most 2^31 objects, not " + std::to_string(boxes.size()));
        if (objects.any_departures()) forget_departures(objects);
        const axis_set known_axes = axes_;  // those with a list of the last frame
        steps_left_ = restart_steps();
        for (std::size_t k = 0; k < 3; ++k)
            if (has_axis(known_axes, k)) sort_known(boxes, k, sort, counters);
        const vec3d separation = separation_of(boxes, objects);
        axes_ = separating_axes(separation);
        for (std::size_t k = 0; k < 3; ++k) {
            if (has_axis(axes_ & ~known_axes, k)) build_list(boxes, objects, k);
            if (has_axis(axes_ & known_axes, k)) merge_arrivals(boxes, objects, k);
            if (!has_axis(axes_, k)) release(ends_[k]);
        }
        if (steps_left_ == 0) {  // following more swaps would take longer than a restart
            counters.add(work::restarts);
            pairs_.clear();
            restart_tests_ = 0;
            find_pairs(boxes, longest_axis(separation), counters, /*is_new=*/[](std::uint32_t) { return true; });
        } else {
            apply_unreported_changes(axes_ & ~known_axes, boxes, objects, separation, counters);
        }
        before_.assign(boxes.begin(), boxes.end());
        assert(are_of_one_length());
    }

    [[nodiscard]] axis_set axes() const noexcept { return axes_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(ends_, arriving_, before_, sweep_, pairs_); }

private:
    void forget_departures(const membership& objects) {
        for (auto& list : ends_) std::erase_if(list, [&](const interval_end& e) { return objects.is_leaving(e.id); });
        pairs_.erase_if([&](index_pair p) { return objects.is_leaving(p.a) || objects.is_leaving(p.b); });
    }

    /// Updates the keys of an axis and sorts its list, still without arrivals: by swaps, or from scratch on a restart.
    template <class Sort, CounterPolicy Counters>
    void sort_known(std::span<const box> boxes, std::size_t axis, Sort& sort, Counters& counters) {
        bool moved = false;
        for (interval_end& e : ends_[axis]) {
            const float key = key_of(e, boxes, axis);
            moved |= key != e.key;
            e.key = key;
        }
        if (!moved) return;
        if (steps_left_ > 0) follow_swaps(ends_[axis], boxes, sort, counters);
        if (steps_left_ == 0) sort_ends(ends_[axis]);
    }

    /// The estimated number of steps of a restart, which sorts all lists and sweeps one; never 0.
    [[nodiscard]] std::uint64_t restart_steps() const noexcept {
        std::uint64_t steps = restart_tests_ + 1;
        for (const auto& list : ends_) steps += list.size() * std::bit_width(list.size());
        return steps;
    }

    /// Whether the lists of the active axes (`axes_`) have the same length and the others are empty.
    [[nodiscard]] bool are_of_one_length() const {
        const std::size_t ends = ends_[static_cast<std::size_t>(std::countr_zero(axes_))].size();
        bool same = true;
        for (std::size_t k = 0; k < 3; ++k) same &= ends_[k].size() == (has_axis(axes_, k) ? ends : 0);
        return same;
    }

    /// Sorts both ends of all boxes on an axis that had no list.
    void build_list(std::span<const box> boxes, const membership& objects, std::size_t axis) {
        std::vector<interval_end>& list = ends_[axis];
        assert(list.empty());
        list.reserve(2 * boxes.size());
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (objects.contains(id)) append_ends(list, boxes, id, static_cast<int>(axis));
        sort_ends(list);
    }

    /// Merges the sorted ends of arriving objects into the list of an axis, in place, from the back.
    void merge_arrivals(std::span<const box> boxes, const membership& objects, std::size_t axis) {
        arriving_.clear();
        objects.for_each_arrival([&](std::uint32_t id) { append_ends(arriving_, boxes, id, static_cast<int>(axis)); });
        sort_ends(arriving_);
        std::vector<interval_end>& list = ends_[axis];
        std::size_t known = list.size();
        list.resize(known + arriving_.size());
        for (std::size_t out = list.size(), left = arriving_.size(); left > 0;)
            list[--out] =
                known > 0 && precedes(arriving_[left - 1], list[known - 1]) ? list[--known] : arriving_[--left];
    }

    /// The axis with the greatest separation among those with a list.
    [[nodiscard]] std::size_t longest_axis(const vec3d& separation) const {
        auto longest = static_cast<std::size_t>(std::countr_zero(axes_));
        for (std::size_t k = longest + 1; k < 3; ++k)
            if (has_axis(axes_, k) && separation[static_cast<int>(k)] > separation[static_cast<int>(longest)])
                longest = k;
        return longest;
    }

    /// Applies the changes of the pairs that no swap reports: on new axes some pairs end, and arrivals have new pairs.
    /// @param begun axes that have a list from this frame on
    template <CounterPolicy Counters>
    void apply_unreported_changes(axis_set begun, std::span<const box> boxes, const membership& objects,
                                  const vec3d& separation, Counters& counters) {
        if (begun) {
            // On a new axis all boxes overlapped until now, so pairs can only end on it.
            pairs_.erase_if([&](index_pair p) {
                counters.add(work::box_tests);
                return !overlaps(boxes[p.a], boxes[p.b]);
            });
        }
        if (objects.arrivals() > 0)
            find_pairs(boxes, longest_axis(separation), counters,
                       [&](std::uint32_t id) { return objects.is_arrival(id); });
    }

    /// Sweeps the list of an axis for all pairs with at least one object that `is_new`, and inserts those that overlap.
    template <CounterPolicy Counters>
    void find_pairs(std::span<const box> boxes, std::size_t axis, Counters& counters, auto is_new) {
        const std::uint64_t tests = sweep_.find(ends_[axis], boxes, pairs_, is_new);
        counters.add(work::box_tests, tests);
        restart_tests_ = std::max(restart_tests_, tests);
    }

    axis_set axes_ = 0;                              // axes with a list
    std::array<std::vector<interval_end>, 3> ends_;  // sorted
    std::uint64_t restart_tests_ = 0;                // greatest number of tests of a list sweep since the last restart
    // Used for arrivals and restarts:
    std::vector<interval_end> arriving_;
    interval_sweep sweep_;
};

static_assert(CoherentSweep<incremental_sweep>);

}  // namespace aabb
