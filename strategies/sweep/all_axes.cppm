module;
#include <cassert>

export module aabb.sweep.all_axes;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// Sweep and prune along three sorted lists: a pair is reported if its projections overlap on all three (paper, section
/// 2). An axis on which all boxes overlap is skipped. When to use: to study the paper; it visits every pair that
/// overlaps on any single axis.
///
/// Between two lists, one bit per pair is kept. The bits of all pairs would take n²/8 bytes, so the lists are walked
/// once per block of rows that fits in 16 MiB, for the pairs of that block only. Memory is at most 16 MiB (or one row,
/// n/8 bytes, if that is more) + 32 bytes per object.
class all_axes_sweep {
public:
    static constexpr std::string_view name = "all_axes";
    static constexpr std::string_view summary =
        "three sorted lists; a pair is reported when its projections overlap on all three";

    static axis_set axes(std::span<const box> boxes, const membership& objects) {
        return separating_axes(separation_of(boxes, objects));
    }

    /// Reports the pairs that overlap on all one to three lists. Of ranks i < j, indices in the first list, those with
    /// j < end_[i] overlap there. With three lists, a bitmap marks overlaps on the first two, by blocks of rows.
    template <class Subset, CounterPolicy Counters>
    void sweep(const Subset& subset, std::vector<index_pair>& pairs, Counters& counters) {
        std::array<std::span<const typename Subset::entry>, 3> lists;
        std::array<int, 3> axis{};
        std::size_t n_lists = 0;
        for (int k = 0; k < 3; ++k)
            if (const auto& list = subset.lists[static_cast<std::size_t>(k)]; !list.empty()) {
                axis[n_lists] = k;
                lists[n_lists++] = list;
                assert(list.size() == lists[0].size());
            }
        if (n_lists == 0 || lists[0].size() < 2) return;
        const std::size_t n = lists[0].size();
        rank_objects(subset.boxes, lists[0], axis[0]);
        const auto report = [&](std::size_t i, std::size_t j) {
            const auto& a = lists[0][i];
            const auto& b = lists[0][j];
            // Of all subsets that both boxes overlap, one owns the pair.
            if (Subset::owns(Subset::owned(a), Subset::owned(b))) pairs.push_back(ordered_pair(a.id, b.id));
        };
        if (n_lists == 1) {
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = i + 1; j < end_[i]; ++j) {
                    counters.add(work::box_tests);
                    report(i, j);
                }
            return;
        }
        const auto overlap_on_first = [&](std::size_t i, std::size_t j) { return j < end_[i]; };
        if (n_lists == 2) {
            for_each_overlap(subset.boxes, lists[1], axis[1], /*first=*/0, /*last=*/n, counters,
                             [&](std::size_t i, std::size_t j) {
                                 if (overlap_on_first(i, j)) report(i, j);
                             });
            return;
        }
        const std::size_t words = (n + 63) / 64;
        const std::size_t rows = std::clamp<std::size_t>(most_words / words, 1, n);
        for (std::size_t first = 0; first < n; first += rows) {
            const std::size_t last = std::min(first + rows, n);
            marks_.assign((last - first) * words, 0);
            assert(marks_.size() <= std::max(most_words, words));
            for_each_overlap(subset.boxes, lists[1], axis[1], first, last, counters, [&](std::size_t i, std::size_t j) {
                if (overlap_on_first(i, j)) marks_[(i - first) * words + j / 64] |= std::uint64_t{1} << j % 64;
            });
            for_each_overlap(subset.boxes, lists[2], axis[2], first, last, counters, [&](std::size_t i, std::size_t j) {
                if (marks_[(i - first) * words + j / 64] >> j % 64 & 1) report(i, j);
            });
        }
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(marks_, rank_, end_, swept_, within_); }

private:
    static constexpr std::size_t most_words = (std::size_t{16} << 20) / sizeof(std::uint64_t);

    struct interval {
        float lower;
        float upper;
        std::uint32_t rank;
    };

    /// Ranks the objects by the first list; end_[i] is the first rank whose box begins after box i ends.
    template <class Entry>
    void rank_objects(std::span<const box> boxes, std::span<const Entry> list, int axis) {
        if (rank_.size() < boxes.size()) rank_.resize(boxes.size());
        end_.resize(list.size());
        for (std::size_t i = 0; i < list.size(); ++i) {
            rank_[list[i].id] = static_cast<std::uint32_t>(i);
            const float upper = boxes[list[i].id].max[axis];
            const auto past = std::ranges::upper_bound(list.subspan(i + 1), upper, {},
                                                       [&](const Entry& e) { return boxes[e.id].min[axis]; });
            end_[i] = static_cast<std::uint32_t>(past - list.begin());
        }
    }

    /// Visits every pair that overlaps on an axis, by ranks i < j with first <= i < last. An interval above this block
    /// is compared only with those within it, so that no two blocks visit the same pair.
    template <class Entry, CounterPolicy Counters, class Visit>
    void for_each_overlap(std::span<const box> boxes, std::span<const Entry> list, int axis, std::size_t first,
                          std::size_t last, Counters& counters, Visit visit) {
        swept_.clear();
        within_.clear();
        swept_.reserve(list.size());
        within_.reserve(last - first);
        for (const Entry& e : list) {
            const box& b = boxes[e.id];
            const interval i{b.min[axis], b.max[axis], rank_[e.id]};
            if (i.rank >= first) swept_.push_back(i);
            if (i.rank >= first && i.rank < last) within_.push_back(i);
        }
        std::size_t within_met = 0;  // the intervals of `within_` up to and including the current one
        for (std::size_t p = 0; p < swept_.size(); ++p) {
            const interval a = swept_[p];
            const bool is_within = a.rank < last;
            within_met += is_within;
            const std::span<const interval> after =
                is_within ? std::span(swept_).subspan(p + 1) : std::span(within_).subspan(within_met);
            for (const interval& b : after) {
                if (b.lower > a.upper) break;
                counters.add(work::box_tests);
                visit(std::min(a.rank, b.rank), std::max(a.rank, b.rank));
            }
        }
    }

    std::vector<std::uint64_t> marks_;  // bit (i, j): the pair overlaps on the first two lists
    std::vector<std::uint32_t> rank_;   // by id
    std::vector<std::uint32_t> end_;    // by rank
    std::vector<interval> swept_;       // sorted intervals on an axis, of the block's ranks and those above
    std::vector<interval> within_;      // sorted intervals of the block's ranks only
};

static_assert(ListSweep<all_axes_sweep>);

}  // namespace aabb
