/// Streamed segment trees: pairs of overlapping boxes within a bound on the time, wherever they lie.
export module aabb.segment_trees;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// Streamed segment trees over all three axes (Zomorodian and Edelsbrunner, "Fast software for box intersections",
/// International Journal of Computational Geometry and Applications 12, 2002), of which CGAL's `box_intersection_d` is
/// an implementation.
///
/// A node has the lower ends of some boxes on an axis, its points, and some boxes with intervals; no tree is stored.
/// Intervals that contain all points go to the next axis with them, in both roles; those that contain some go to both
/// halves of the points, of which an interval that does not end there contains all or none. So every pair meets in one
/// node of each axis. On the last axis, intervals and points are swept in their order, and all that meet are pairs.
///
/// A pair stands on an axis for the greater of its lower ends in the interval of the other box; of equal ends, the
/// later one in the sorted list. So all ends have different ranks, and the middle of a node's ranks always divides it:
/// O(log n) levels, also where all boxes begin at the same place.
///
/// Few boxes are faster to sweep along the last axis at once. The paper and CGAL do so below a fixed number. Here a
/// node does so if a sample expects no more tests than the entries that the levels below would copy: each one on every
/// level of this axis, and on every level of the next within each. After twice as many tests in vain it goes on with
/// its tree.
///
/// Time: O(n log³ n + k) for n boxes with k pairs. Memory: 40 bytes per box, 8 per pair, and 4 per entry of the nodes
/// from the root to the current one, O(n log n) at most.
class segment_trees {
public:
    /// Finds the pairs of boxes.
    /// @param lists by axis, entries whose `id` is the index of a box, sorted by lower ends; each box has one in each
    /// @param last_axis the axis of the sweeps; best that on which boxes lie farthest apart
    /// @returns pairs of places in the list of the last axis; valid until the next call
    template <class Entry, CounterPolicy Counters>
    [[nodiscard]] std::span<const index_pair> find(std::span<const box> boxes,
                                                   const std::array<std::span<const Entry>, 3>& lists, int last_axis,
                                                   Counters& counters) {
        load(boxes, lists, last_axis);
        pairs_.clear();
        const list all{0, boxes_.size()};
        search(all, all, /*axis=*/2, counters);
        return pairs_;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(boxes_, places_, entries_, pairs_); }

private:
    /// A box with permuted axes: axis 0 is the last one, in whose order boxes are stored, so that a box's index is its
    /// rank there.
    struct ranked_box {
        std::array<float, 3> min, max;
        std::array<std::uint32_t, 2> ranks;  ///< of the lower ends on axes 1 and 2
    };
    static_assert(sizeof(ranked_box) == 32);

    /// Indices of boxes, ascending, in `entries_`.
    struct list {
        std::size_t first, count;
    };
    /// The least and the greatest of a node's points.
    struct extent {
        std::uint32_t first_rank = ~std::uint32_t{0}, last_rank = 0;
        float first = std::numeric_limits<float>::infinity(), last = -std::numeric_limits<float>::infinity();
    };

    template <class Entry>
    void load(std::span<const box> boxes, const std::array<std::span<const Entry>, 3>& lists, int last_axis) {
        const auto axis_of = [&](std::size_t k) { return (static_cast<std::size_t>(last_axis) + k) % 3; };
        const std::span<const Entry> last = lists[axis_of(0)];
        boxes_.resize(last.size());
        places_.resize(boxes.size());
        entries_.resize(last.size());
        for (std::uint32_t i = 0; i < last.size(); ++i) {
            const box& b = boxes[last[i].id];
            places_[last[i].id] = i;
            entries_[i] = i;
            for (std::size_t k = 0; k < 3; ++k) {
                boxes_[i].min[k] = b.min[static_cast<int>(axis_of(k))];
                boxes_[i].max[k] = b.max[static_cast<int>(axis_of(k))];
            }
        }
        for (std::size_t k = 1; k < 3; ++k) {
            const std::span<const Entry> sorted = lists[axis_of(k)];
            for (std::uint32_t rank = 0; rank < sorted.size(); ++rank)
                boxes_[places_[sorted[rank].id]].ranks[k - 1] = rank;
        }
    }

    /// Finds the pairs of an interval with a point in it on this axis, which overlap on those below.
    template <CounterPolicy Counters>
    void search(list intervals, list points, std::size_t axis, Counters& counters) {
        if (intervals.count == 0 || points.count == 0) return;
        counters.add(work::subsets);
        if (axis == 0) return sweep_points(intervals, points);
        if (sweep_boxes(intervals, points, axis, counters)) return;
        const extent all = extent_of(points, axis);
        const std::size_t end = entries_.size();
        const list covering = filtered(intervals, counters, [&](const ranked_box& b) { return covers(b, all, axis); });
        search(covering, points, axis - 1, counters);
        search(points, covering, axis - 1, counters);
        entries_.resize(end);
        const list crossing = filtered(
            intervals, counters, [&](const ranked_box& b) { return meets(b, all, axis) && !covers(b, all, axis); });
        const std::size_t end_of_crossing = entries_.size();
        const std::uint32_t middle = all.first_rank + (all.last_rank - all.first_rank) / 2;
        for (const bool is_upper : {false, true}) {
            if (crossing.count == 0) break;
            const list half = filtered(points, counters,
                                       [&](const ranked_box& b) { return (b.ranks[axis - 1] > middle) == is_upper; });
            search(crossing, half, axis, counters);
            entries_.resize(end_of_crossing);
        }
        entries_.resize(end);
    }

    /// Appends the entries whose boxes satisfy the predicate as a list, in their order.
    template <CounterPolicy Counters>
    [[nodiscard]] list filtered(list from, Counters& counters, auto predicate) {
        const std::size_t first = entries_.size();
        entries_.resize(first + from.count);
        std::size_t end = first;
        for (std::size_t i = from.first; i < from.first + from.count; ++i) {
            entries_[end] = entries_[i];  // without a branch
            end += predicate(boxes_[entries_[i]]);
        }
        entries_.resize(end);
        counters.add(work::subset_copies, end - first);
        return {first, end - first};
    }

    [[nodiscard]] std::span<const std::uint32_t> in(list l) const {
        return std::span(entries_).subspan(l.first, l.count);
    }

    /// On the last axis each point in an interval makes a pair.
    void sweep_points(list intervals, list points) {
        std::span<const std::uint32_t> rest = in(points);
        for (const std::uint32_t i : in(intervals)) {
            while (!rest.empty() && rest.front() <= i) rest = rest.subspan(1);
            const float end = boxes_[i].max[0];
            for (const std::uint32_t p : rest) {
                if (boxes_[p].min[0] > end) break;
                pairs_.push_back({i, p});
            }
        }
    }

    /// Sweeps the boxes along the last axis, unless that seems to take, or takes, too many tests in vain.
    /// @returns whether all pairs were found; if not, there are none of these
    template <CounterPolicy Counters>
    [[nodiscard]] bool sweep_boxes(list intervals, list points, std::size_t axis, Counters& counters) {
        const std::size_t known = pairs_.size();
        const auto levels = static_cast<std::size_t>(std::bit_width(points.count));
        const std::size_t copies = (intervals.count + points.count) * (axis == 1 ? levels : levels * levels);
        if (expected_tests(intervals, points) > copies) return false;
        const std::size_t most_in_vain = 2 * copies;  // a sample can be wrong
        std::span<const std::uint32_t> rest = in(intervals), other_rest = in(points);
        std::size_t tests = 0;
        while (!rest.empty() && !other_rest.empty() && tests - (pairs_.size() - known) <= most_in_vain) {
            if (rest.front() <= other_rest.front()) {
                const std::uint32_t i = rest.front();
                rest = rest.subspan(1);
                tests += test(i, other_rest, [&](std::uint32_t p) { return is_pair(boxes_[i], boxes_[p], axis); });
            } else {
                const std::uint32_t p = other_rest.front();
                other_rest = other_rest.subspan(1);
                tests += test(p, rest, [&](std::uint32_t i) { return is_pair(boxes_[i], boxes_[p], axis); });
            }
        }
        counters.add(work::box_tests, tests);
        if (rest.empty() || other_rest.empty()) return true;
        pairs_.resize(known);
        return false;
    }
    /// Estimates the tests of a sweep by those of a few boxes of each list.
    [[nodiscard]] std::size_t expected_tests(list intervals, list points) const {
        constexpr std::size_t most_sampled = 16;
        const auto tests_of = [&](std::span<const std::uint32_t> list, std::span<const std::uint32_t> others) {
            const std::size_t sampled = std::min(list.size(), most_sampled);
            std::size_t tests = 0;
            for (std::size_t s = 0; s < sampled; ++s) {
                const std::uint32_t i = list[s * list.size() / sampled];
                const auto begin = std::ranges::upper_bound(others, i);
                const auto end = std::ranges::partition_point(
                    others, [&](std::uint32_t p) { return boxes_[p].min[0] <= boxes_[i].max[0]; });
                tests += static_cast<std::size_t>(std::max<std::ptrdiff_t>(end - begin, 0));
            }
            return tests * list.size() / sampled;
        };
        return tests_of(in(intervals), in(points)) + tests_of(in(points), in(intervals));
    }
    /// Tests a box against those of a list that begin before it ends.
    /// @returns the number of tests
    [[nodiscard]] std::size_t test(std::uint32_t first, std::span<const std::uint32_t> others, auto is_pair_with) {
        const float end = boxes_[first].max[0];
        std::size_t tests = 0;
        for (; tests < others.size() && boxes_[others[tests]].min[0] <= end; ++tests)
            if (is_pair_with(others[tests])) pairs_.push_back({first, others[tests]});
        return tests;
    }

    [[nodiscard]] extent extent_of(list points, std::size_t axis) const {
        extent all;
        for (const std::uint32_t p : in(points)) {
            const ranked_box& b = boxes_[p];
            all.first_rank = std::min(all.first_rank, b.ranks[axis - 1]);
            all.last_rank = std::max(all.last_rank, b.ranks[axis - 1]);
            all.first = std::min(all.first, b.min[axis]);
            all.last = std::max(all.last, b.min[axis]);
        }
        return all;
    }
    /// Whether all points lie in the interval of the box.
    [[nodiscard]] static bool covers(const ranked_box& b, const extent& points, std::size_t axis) {
        return (b.ranks[axis - 1] < points.first_rank) & (points.last <= b.max[axis]);
    }
    /// Whether one of them may.
    [[nodiscard]] static bool meets(const ranked_box& b, const extent& points, std::size_t axis) {
        return (b.ranks[axis - 1] < points.last_rank) & (points.first <= b.max[axis]);
    }
    /// Whether b's point lies in a's interval on the axis, and the boxes overlap on those between it and the last.
    [[nodiscard]] static bool is_pair(const ranked_box& a, const ranked_box& b, std::size_t axis) {
        const bool has_point = (a.ranks[axis - 1] < b.ranks[axis - 1]) & (b.min[axis] <= a.max[axis]);
        return has_point & (axis == 1 || ((a.min[1] <= b.max[1]) & (b.min[1] <= a.max[1])));
    }

    std::vector<ranked_box> boxes_;
    std::vector<std::uint32_t> places_;   // by index of a box: its rank on the last axis
    std::vector<std::uint32_t> entries_;  // a stack of lists, those of nodes below behind those above
    std::vector<index_pair> pairs_;
};

}  // namespace aabb
