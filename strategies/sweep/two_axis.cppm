export module aabb.sweep.two_axis;

import aabb.global_search;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Sweep and prune along two sorted lists: the sweep along one keeps the active boxes in the order of the other, so
/// that a box is tested only against the active ones whose intervals may overlap its own on both axes. After Capannini
/// and Larsson, "Efficient collision culling by a succinct bi-dimensional sweep and prune algorithm" (SCCG 2016), and
/// their adaptive version of 2018, as described by others: theirs keeps ends in a tree with many bits per node and
/// plans for several threads. Here a bitmap over the places in the second list marks active boxes, and an ended box is
/// removed lazily, when it is visited again. When to use: many boxes at a time along every axis.
///
/// The range of candidates before a box follows from the prefix maximum of upper ends in the second list. Boxes more
/// than four times as long there as the mean would inflate it, so they are kept in a separate list, and each box is
/// tested against all active ones of these.
class two_axis_sweep {
public:
    static constexpr std::string_view name = "two_axis";
    static constexpr std::string_view summary =
        "sweeps along one axis and keeps the active boxes in the order of a second one";

    /// Chooses the two axes of greatest variance, one to sweep, one (kept) to order the active boxes. Boxes longer
    /// there than four mean extents would widen the ranges of candidates, and get a list of their own (`long_active_`).
    /// @returns the axes that need sorted lists
    axis_set axes(std::span<const box> boxes, const membership& objects) {
        const spread along = spread_of(boxes, objects);
        swept_axis_ = swept_.choose(along, every_axis);
        const axis_set swept = axis_set{1} << swept_axis_;
        kept_axis_ = kept_.choose(along, every_axis & ~swept);
        longest_short_ =
            static_cast<float>(std::min(4 * along.extent[kept_axis_], double{std::numeric_limits<float>::max()}));
        return swept | axis_set{1} << kept_axis_;
    }

    /// Tests each box, in the order of the swept list, against active ones near it on the kept axis, and activates it.
    template <class Subset, CounterPolicy Counters>
    void sweep(const Subset& subset, std::vector<index_pair>& pairs, Counters& counters) {
        const auto& list = subset.lists[static_cast<std::size_t>(swept_axis_)];
        if (list.size() < 2) return;
        rank_boxes(subset, subset.lists[static_cast<std::size_t>(kept_axis_)]);  // a rank is the place in this list
        std::uint64_t tests = 0;
        for (const auto& e : list) {
            tests += test_and_activate<Subset>(rank_[e.id]);
            if (pair_count_ > pairs_per_append)
                append_pairs(pairs);  // pairs are buffered, to be written without branches
        }
        append_pairs(pairs);
        counters.add(work::box_tests, tests);
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return bytes_of(ranked_, first_word_, reached_, rank_, active_, word_begins_, long_active_, pairs_,
                        candidates_);
    }

private:
    using quad = float __attribute__((vector_size(16)));
    static constexpr std::size_t bits = 64;  // per word of the bitmap
    static constexpr std::size_t pairs_per_append = 2048;

    /// A box with permuted axes; aligned, so that none straddles two cache lines.
    struct alignas(32) ranked_box {
        quad bounds;  ///< on the kept and the third axis: max, max, -min, -min
        float begin;  ///< on the swept axis
        float end;
        std::uint32_t id;
        axis_set owned;
    };
    static_assert(sizeof(ranked_box) == 32);

    [[nodiscard]] inline bool is_long(const ranked_box& b) const noexcept {
        return b.bounds[0] + b.bounds[2] > longest_short_;
    }

    void append_pairs(std::vector<index_pair>& pairs) {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(pair_count_));
        pair_count_ = 0;
    }

    /// Ranks boxes on the kept axis, and finds for each the first word of the bitmap that may hold candidates: lower
    /// ranks may overlap it only from where the greatest upper end so far (`reached_`) is not below its lower end.
    template <class Subset, class List>
    void rank_boxes(const Subset& subset, const List& list) {
        const std::size_t n = list.size();
        ranked_.resize(n);
        first_word_.resize(n);
        reached_.resize(n);
        if (rank_.size() < subset.boxes.size()) rank_.resize(subset.boxes.size());
        word_begins_.resize((n + bits - 1) / bits);
        active_.assign(word_begins_.size(), 0);
        long_active_.clear();
        pair_count_ = 0;
        // A box adds at most one pair per other box, and a rejected pair is overwritten by the next.
        if (pairs_.size() < n + pairs_per_append) pairs_.resize(n + pairs_per_append);
        if (candidates_.size() < n + 1) candidates_.resize(n + 1);
        const int third = 3 - swept_axis_ - kept_axis_;
        float reached = -std::numeric_limits<float>::infinity();
        std::size_t first = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const box& b = subset.boxes[list[i].id];
            // Lower ends are negated, so that one comparison of vectors tests both axes.
            ranked_[i] = {{b.max[kept_axis_], b.max[third], -b.min[kept_axis_], -b.min[third]},
                          b.min[swept_axis_],
                          b.max[swept_axis_],
                          list[i].id,
                          Subset::owned(list[i])};
            rank_[list[i].id] = static_cast<std::uint32_t>(i);
            if (i % bits == 0) word_begins_[i / bits] = b.min[kept_axis_];
            if (!is_long(ranked_[i])) reached = std::max(reached, b.max[kept_axis_]);
            reached_[i] = reached;
            while (first < i && reached_[first] < b.min[kept_axis_]) ++first;
            first_word_[i] = static_cast<std::uint32_t>(first / bits);
        }
    }

    /// Lists the active ranks, set bits of the bitmap, from a word up to the last that begins at or below `last` on the
    /// kept axis. Up to three bits per word are extracted without branches, since their number is hard to predict.
    /// @returns the number of candidates
    std::size_t list_candidates(std::size_t word, float last) noexcept {
        std::size_t count = 0;
        for (; word < active_.size() && word_begins_[word] <= last; ++word) {
            std::uint64_t left = active_[word];
            const auto take = [&] {
                candidates_[count] =
                    static_cast<std::uint32_t>(word * bits) + static_cast<std::uint32_t>(std::countr_zero(left));
                count += static_cast<std::size_t>(left != 0);
                left &= left - 1;
            };
            take();
            take();
            take();
            while (left != 0) take();
        }
        return count;
    }

    /// Compares a box with the active boxes near it on the kept axis and all long ones, removes those that have ended,
    /// and activates it. Branch-free, since outcomes are hard to predict: a pair that does not overlap is overwritten.
    /// @returns the number of tests
    template <class Subset>
    std::size_t test_and_activate(std::uint32_t rank) {
        const ranked_box a = ranked_[rank];
        const quad lower = {-a.bounds[2], -a.bounds[3], -a.bounds[0], -a.bounds[1]};  // min, min, -max, -max
        const auto overlaps = [&](const ranked_box& b) {
            return static_cast<std::size_t>(b.end >= a.begin) &
                   static_cast<std::size_t>(__builtin_reduce_and(lower <= b.bounds) != 0) &
                   static_cast<std::size_t>(Subset::owns(a.owned, b.owned));
        };
        const std::size_t short_count = list_candidates(first_word_[rank], a.bounds[0]);
        std::size_t count = pair_count_;
        for (std::size_t c = 0; c < short_count; ++c) {
            const std::uint32_t other = candidates_[c];
            const ranked_box& b = ranked_[other];
            pairs_[count] = ordered_pair(a.id, b.id);
            count += overlaps(b);
            active_[other / bits] &= ~(std::uint64_t{b.end < a.begin} << other % bits);
        }
        const std::size_t long_count = long_active_.size();
        std::size_t stay = 0;
        for (std::size_t c = 0; c < long_count; ++c) {
            const ranked_box& b = ranked_[long_active_[c]];
            pairs_[count] = ordered_pair(a.id, b.id);
            count += overlaps(b);
            long_active_[stay] = long_active_[c];
            stay += static_cast<std::size_t>(b.end >= a.begin);
        }
        long_active_.resize(stay);
        pair_count_ = count;
        if (is_long(a))
            long_active_.push_back(rank);
        else
            active_[rank / bits] |= std::uint64_t{1} << rank % bits;
        return short_count + long_count;
    }

    chosen_axis swept_;
    chosen_axis kept_;
    int swept_axis_ = 0;
    int kept_axis_ = 1;
    float longest_short_ = 0;  // greatest extent of a box that is not long, on the kept axis
    // Indexed by rank, the place in the kept list:
    std::vector<ranked_box> ranked_;
    std::vector<std::uint32_t> first_word_;  // the first word of active_ with candidates of the box
    std::vector<float> reached_;             // prefix maximum of the upper ends of boxes that are not long
    std::vector<std::uint32_t> rank_;        // by id
    std::vector<std::uint64_t> active_;      // bitmap of active boxes that are not long
    std::vector<float> word_begins_;         // lower end of the first box of each word of active_
    std::vector<std::uint32_t> long_active_;
    std::vector<std::uint32_t> candidates_;  // of the current box
    std::vector<index_pair> pairs_;          // pairs that are not yet reported
    std::size_t pair_count_ = 0;
};

static_assert(ListSweep<two_axis_sweep>);

}  // namespace aabb
