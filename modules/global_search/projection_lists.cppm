module;
#include <cassert>

export module aabb.global_search:projection_lists;

import aabb.std;
import :policies;

export namespace aabb {

/// Counts the inversions of a list, the measure of "almost sorted", by merge sort in O(n log n).
class inversion_counter {
public:
    /// The number of inversions, counted in O(n log n) by a bottom-up merge sort of runs of `width` keys.
    [[nodiscard]] std::uint64_t count(std::span<const projection> list) {
        keys_.clear();
        for (const projection& p : list) keys_.push_back(p.key);
        merged_.resize(keys_.size());
        std::uint64_t inversions = 0;
        for (std::size_t width = 1; width < keys_.size(); width *= 2) {
            for (std::size_t begin = 0; begin < keys_.size(); begin += 2 * width)
                inversions +=
                    merge(begin, std::min(begin + width, keys_.size()), std::min(begin + 2 * width, keys_.size()));
            keys_.swap(merged_);
        }
        assert(std::ranges::is_sorted(keys_));
        return inversions;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(keys_, merged_); }

private:
    /// Merges two adjacent sorted runs of keys, [begin, middle) and [middle, end), into `merged_`.
    /// @returns the inversions between them: each key of the second run passes what is left of the first
    [[nodiscard]] std::uint64_t merge(std::size_t begin, std::size_t middle, std::size_t end) {
        std::uint64_t inversions = 0;
        std::size_t left = begin, right = middle;
        for (std::size_t out = begin; out < end; ++out) {
            const bool passes = left == middle || (right < end && keys_[right] < keys_[left]);
            if (passes) inversions += middle - left;
            merged_[out] = keys_[passes ? right++ : left++];
        }
        return inversions;
    }

    std::vector<float> keys_;
    std::vector<float> merged_;
};

/// Replaces `inversion_counter` in searches without counters.
struct no_inversion_counter {
    [[nodiscard]] static constexpr std::uint64_t count(std::span<const projection>) noexcept { return 0; }
};

/// The sorted projection lists of the broad phase, kept between frames (paper, section 2).
///
/// New entries, of a new axis or an arriving object, are sorted by std::sort, since insertion sort would be quadratic
/// there. The sort policy sorts only the entries whose key has changed, in the order of the list; they are then merged
/// with the unchanged ones, which are never sorted again. If all objects move, this is the whole list.
template <CounterPolicy Counters>
class projection_lists {
public:
    /// Removes the entries of absent objects, keeping the order of the others, and appends those of new ones, unsorted.
    void settle(const membership& objects) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (!has_axis(axes_, k)) continue;
            if (objects.any_departures())
                std::erase_if(lists_[k], [&](const projection& p) { return objects.is_leaving(p.id); });
            make_room(lists_[k], lists_[k].size() + objects.arrivals());
            objects.for_each_arrival([&](std::uint32_t id) { lists_[k].push_back({.key = 0, .id = id}); });
        }
        arrivals_ += objects.arrivals();  // number of appended entries
    }

    /// Sorts the lists of the boxes' lower ends on these axes, and frees the other lists. A list that was kept from the
    /// previous frame (`axes_`) is almost sorted; one of a new axis is sorted from scratch.
    template <SortPolicy Sort>
    void sort(std::span<const box> boxes, axis_set axes, Sort& sort, Counters& counters) {
        assert(axes != 0 && (axes & ~every_axis) == 0);
        for (std::size_t k = 0; k < 3; ++k)
            if (has_axis(axes & ~axes_, k)) {
                lists_[k] = members();  // a copy of another list, since all have the same objects
                sort_new(boxes, k, lists_[k]);
            }
        for (std::size_t k = 0; k < 3; ++k) {
            if (!has_axis(axes, k))
                release(lists_[k]);
            else if (has_axis(axes_, k)) {
                sort_known(boxes, k, sort, counters);
                sort_arrivals(boxes, k);
            }
        }
        axes_ = axes;
        arrivals_ = 0;
        assert(are_of_one_length());
    }

    [[nodiscard]] axis_set axes() const noexcept { return axes_; }
    [[nodiscard]] whole_subset all(std::span<const box> boxes) const noexcept {
        return {boxes, {lists_[0], lists_[1], lists_[2]}};
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(lists_, moved_); }

private:
    /// Reserves memory for n entries; a list that must grow again grows by half.
    static void make_room(std::vector<projection>& list, std::size_t n) {
        if (n > list.capacity()) list.reserve(std::max(n, list.capacity() + list.capacity() / 2));
    }

    /// Any one of the lists, since each contains all objects.
    [[nodiscard]] const std::vector<projection>& members() const noexcept {
        assert(axes_ != 0);
        return lists_[static_cast<std::size_t>(std::countr_zero(axes_))];
    }

    [[nodiscard]] bool are_of_one_length() const noexcept {
        bool same = true;
        for (std::size_t k = 0; k < 3; ++k) same &= lists_[k].size() == (has_axis(axes_, k) ? members().size() : 0);
        return same;
    }

    static void sort_new(std::span<const box> boxes, std::size_t axis, std::span<projection> list) {
        for (projection& p : list) p.key = boxes[p.id].min[static_cast<int>(axis)];
        std::ranges::sort(list, [](const projection& p, const projection& q) { return precedes(p, q); });
    }

    /// Sorts a list kept from the previous frame, except new entries at its end: takes out the entries whose key has
    /// changed, sorts these by the policy, and merges them with the others.
    template <class Sort>
    void sort_known(std::span<const box> boxes, std::size_t axis, Sort& sort, Counters& counters) {
        const std::span known = std::span(lists_[axis]).first(lists_[axis].size() - arrivals_);
        moved_.clear();
        make_room(moved_, known.size());
        std::size_t unmoved = 0;  // number of entries with an unchanged key, which are gathered at the front
        for (const projection& p : known) {
            const float key = boxes[p.id].min[static_cast<int>(axis)];
            if (key == p.key)
                known[unmoved++] = p;
            else
                moved_.push_back({key, p.id});
        }
        if (moved_.empty()) return;
        if constexpr (Counters::enabled) counters.add(work::inversions, inversions_.count(moved_));
        sort.sort(std::span(moved_), counters);
        if (unmoved == 0 && arrivals_ == 0)
            lists_[axis].swap(moved_);
        else
            merge_moved_into(known, unmoved, counters);
    }

    /// Sorts the last `arrivals_` entries, of new objects, from scratch, and merges them with those before.
    void sort_arrivals(std::span<const box> boxes, std::size_t axis) {
        if (arrivals_ == 0) return;
        const std::span list(lists_[axis]);
        const std::size_t known = list.size() - arrivals_;
        if (known == 0) return sort_new(boxes, axis, list);
        moved_.assign(list.begin() + static_cast<std::ptrdiff_t>(known), list.end());
        sort_new(boxes, axis, moved_);
        no_counters uncounted;  // as is the work of std::sort on new entries
        merge_moved_into(list, known, uncounted);
    }

    /// Merges the sorted `moved_` in place into a list whose first `sorted` entries are sorted and whose other places
    /// are free, from the greatest entry on.
    void merge_moved_into(std::span<projection> list, std::size_t sorted, CounterPolicy auto& counters) {
        assert(list.size() == sorted + moved_.size());
        std::size_t out = list.size();
        for (std::size_t i = moved_.size(); i-- > 0;) {
            const std::size_t index = insertion_index(moved_[i], list.first(sorted), counters);
            std::copy_backward(list.begin() + static_cast<std::ptrdiff_t>(index),
                               list.begin() + static_cast<std::ptrdiff_t>(sorted),
                               list.begin() + static_cast<std::ptrdiff_t>(out));
            counters.add(work::moves, sorted - index + 1);
            out -= sorted - index + 1;
            sorted = index;
            list[out] = moved_[i];
        }
        assert(out == sorted);
    }

    /// The index before which to insert an entry, after equal ones, by O(log d) comparisons if d entries are greater:
    /// doubles the step from the back until an entry is not greater, then bisects the last step.
    static std::size_t insertion_index(const projection& entry, std::span<const projection> list,
                                       CounterPolicy auto& counters) {
        std::size_t step = 1;
        const auto follows = [&](std::size_t i) {
            counters.add(work::comparisons);
            return precedes(entry, list[i]);
        };
        while (step <= list.size() && follows(list.size() - step)) step *= 2;
        std::size_t low = step > list.size() ? 0 : list.size() - step + 1;
        std::size_t high = list.size() - step / 2;
        while (low < high) {
            const std::size_t middle = low + (high - low) / 2;
            if (follows(middle))
                high = middle;
            else
                low = middle + 1;
        }
        return low;
    }

    std::array<std::vector<projection>, 3> lists_;  // empty for axes that are not in axes_
    std::vector<projection> moved_;
    axis_set axes_ = 0b001;
    std::size_t arrivals_ = 0;  // number of unsorted entries at the end of each list
    [[no_unique_address]] std::conditional_t<Counters::enabled, inversion_counter, no_inversion_counter> inversions_;
};

}  // namespace aabb
