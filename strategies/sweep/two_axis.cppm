export module aabb.sweep.two_axis;

import aabb.global_search;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// Two sorted lists: while boxes are met along one, those met and not yet left are kept in the order of the other, and
/// a box is tested only against those of them that can reach it on both axes. After Capannini and Larsson, "Efficient
/// collision culling by a succinct bi-dimensional sweep and prune algorithm" (SCCG 2016), and their adaptive one of
/// 2018, from what others write of both: theirs keeps ends in a tree of many bits a node and plans for several threads.
/// Here one bit stands for a box, by its place in the second list, words of them are walked over, and a box is found to
/// have ended only when it is met again. When to use: many boxes at a time along every axis.
///
/// How far back a box must look follows from the greatest upper end so far in the second list. Boxes four times as long
/// there as the mean would spoil that for all behind them: they are kept apart, and each box is tested against all of
/// those that are active.
class two_axis_sweep {
public:
    static constexpr std::string_view name = "two_axis";
    static constexpr std::string_view summary =
        "sweeps one axis and keeps the boxes at hand in the order of a second one";

    axis_set axes(std::span<const box> boxes, const membership& objects) {
        const spread along = spread_of(boxes, objects);
        swept_axis_ = swept_.choose(along, every_axis);
        const axis_set swept = axis_set{1} << swept_axis_;
        kept_axis_ = kept_.choose(along, every_axis & ~swept);
        longest_short_ =
            static_cast<float>(std::min(4 * along.extent[kept_axis_], double{std::numeric_limits<float>::max()}));
        return swept | axis_set{1} << kept_axis_;
    }

    template <class Subset, CounterPolicy Counters>
    void sweep(const Subset& subset, std::vector<index_pair>& pairs, Counters& counters) {
        const auto& met = subset.lists[static_cast<std::size_t>(swept_axis_)];
        if (met.size() < 2) return;
        rank(subset, subset.lists[static_cast<std::size_t>(kept_axis_)]);
        std::uint64_t tests = 0;
        for (const auto& e : met) {
            tests += meet<Subset>(rank_[e.id]);
            if (found_ > enough) report(pairs);
        }
        report(pairs);
        counters.add(work::box_tests, tests);
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return bytes_of(ranked_, first_word_, reached_, rank_, active_, word_begins_, long_active_, pairs_,
                        candidates_);
    }

private:
    using quad = float __attribute__((vector_size(16)));
    static constexpr std::size_t bits = 64;  // of a word
    static constexpr std::size_t enough = 2048;

    /// A box as the sweep sees it; aligned, so that none lies across two cache lines.
    struct alignas(32) ranked_box {
        quad bounds;  ///< on the axis kept in order and the third: max, max, -min, -min
        float begin;  ///< on the swept axis
        float end;
        std::uint32_t id;
        axis_set owned;
    };
    static_assert(sizeof(ranked_box) == 32);

    [[nodiscard]] static inline bool all_at_most(quad lower, quad upper) noexcept {
        return __builtin_reduce_and(lower <= upper) != 0;
    }

    [[nodiscard]] inline bool is_long(const ranked_box& b) const noexcept {
        return b.bounds[0] + b.bounds[2] > longest_short_;
    }

    void report(std::vector<index_pair>& pairs) {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(found_));
        found_ = 0;
    }

    /// Numbers boxes by their place in the list that keeps them in order, and finds how far back each must look there.
    template <class Subset, class List>
    void rank(const Subset& subset, const List& list) {
        const std::size_t n = list.size();
        ranked_.resize(n);
        first_word_.resize(n);
        reached_.resize(n);
        if (rank_.size() < subset.boxes.size()) rank_.resize(subset.boxes.size());
        word_begins_.resize((n + bits - 1) / bits);
        active_.assign(word_begins_.size(), 0);
        long_active_.clear();
        found_ = 0;
        // A box meets each of the others once at most, and one entry is written over by the next.
        if (pairs_.size() < n + enough) pairs_.resize(n + enough);
        if (candidates_.size() < n + 1) candidates_.resize(n + 1);
        const int third = 3 - swept_axis_ - kept_axis_;
        float reached = -std::numeric_limits<float>::infinity();
        std::size_t first = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const box& b = subset.boxes[list[i].id];
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

    /// Lists the active boxes from a word on, up to the words that begin beyond a place. Most words have a few bits,
    /// how many cannot be foreseen.
    std::size_t candidates(std::size_t word, float last) noexcept {
        std::size_t found = 0;
        for (; word < active_.size() && word_begins_[word] <= last; ++word) {
            std::uint64_t left = active_[word];
            const auto take = [&] {
                candidates_[found] =
                    static_cast<std::uint32_t>(word * bits) + static_cast<std::uint32_t>(std::countr_zero(left));
                found += static_cast<std::size_t>(left != 0);
                left &= left - 1;
            };
            take();
            take();
            take();
            while (left != 0) take();
        }
        return found;
    }

    /// Tests a box against those that it can reach, and puts it among them. Without a branch a test: neither whether
    /// two boxes overlap nor whether one has ended can be foreseen.
    /// @returns how many it was tested against
    template <class Subset>
    std::size_t meet(std::uint32_t rank) {
        const ranked_box a = ranked_[rank];
        const quad lower = {-a.bounds[2], -a.bounds[3], -a.bounds[0], -a.bounds[1]};
        const auto overlaps = [&](const ranked_box& b) {
            return static_cast<std::size_t>(b.end >= a.begin) & static_cast<std::size_t>(all_at_most(lower, b.bounds)) &
                   static_cast<std::size_t>(Subset::owns(a.owned, b.owned));
        };
        const std::size_t near = candidates(first_word_[rank], a.bounds[0]);
        std::size_t found = found_;
        for (std::size_t c = 0; c < near; ++c) {
            const std::uint32_t other = candidates_[c];
            const ranked_box& b = ranked_[other];
            pairs_[found] = ordered_pair(a.id, b.id);
            found += overlaps(b);
            active_[other / bits] &= ~(std::uint64_t{b.end < a.begin} << other % bits);
        }
        const std::size_t far = long_active_.size();
        std::size_t stay = 0;
        for (std::size_t c = 0; c < far; ++c) {
            const ranked_box& b = ranked_[long_active_[c]];
            pairs_[found] = ordered_pair(a.id, b.id);
            found += overlaps(b);
            long_active_[stay] = long_active_[c];
            stay += static_cast<std::size_t>(b.end >= a.begin);
        }
        long_active_.resize(stay);
        found_ = found;
        if (is_long(a))
            long_active_.push_back(rank);
        else
            active_[rank / bits] |= std::uint64_t{1} << rank % bits;
        return near + far;
    }

    chosen_axis swept_;
    chosen_axis kept_;
    int swept_axis_ = 0;
    int kept_axis_ = 1;
    float longest_short_ = 0;  // on the axis kept in order
    // By the place in the list that keeps boxes in order:
    std::vector<ranked_box> ranked_;
    std::vector<std::uint32_t> first_word_;  // of active_ in which a box that this one overlaps may stand
    std::vector<float> reached_;             // the greatest upper end of those up to here that are not long
    std::vector<std::uint32_t> rank_;        // by id
    std::vector<std::uint64_t> active_;      // a bit for each box that was met, is not long, and was not seen to end
    std::vector<float> word_begins_;         // the lower end of the first box of a word of active_
    std::vector<std::uint32_t> long_active_;
    std::vector<std::uint32_t> candidates_;  // of the box at hand
    std::vector<index_pair> pairs_;          // found, not yet reported
    std::size_t found_ = 0;
};

static_assert(ListSweep<two_axis_sweep>);

}  // namespace aabb
