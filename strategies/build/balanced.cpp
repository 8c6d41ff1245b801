module aabb.build.balanced;

import aabb.build.balanced_items;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

constexpr std::size_t leaf_triangles = balanced_order::leaf_triangles;
constexpr std::size_t bins = 256;

/// A range of items, and the array that currently holds them.
struct part {
    std::size_t begin;
    std::size_t end;
    box bounds;
    bool in_second;  ///< whether the items are in the second of the two arrays

    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

class balanced_order_builder {
public:
    balanced_order_builder(const mesh& m, axis_rule rule) : mesh_(m), rule_(rule) {
        const std::size_t n = m.triangles.size();
        memory_.resize(2 * n);  // for two arrays: each split moves items from one to the other
        items_ = {std::span(memory_).first(n), std::span(memory_).last(n)};
        bin_of_item_.resize(n);
        order_.triangles.resize(n);
        order_.bounds.resize((n + leaf_triangles - 1) / leaf_triangles);
    }

    /// Reads the triangles and splits them recursively down to leaves.
    [[nodiscard]] balanced_order build(std::uint32_t threads) {
        worker_threads workers(threads);
        const std::size_t n = mesh_.triangles.size();
        std::vector<box> bounds((n + share_size - 1) / share_size);
        workers.for_each_range(n, share_size, [&](std::size_t begin, std::size_t end) {
            bounds[begin / share_size] = read_items(begin, end).as_box();
        });
        box root = empty_box();
        for (const box& b : bounds) root = merged(root, b);
        split_recursively(
            workers, part{.begin = 0, .end = n, .bounds = root, .in_second = false},
            // The threads share a part while there are fewer parts than threads.
            [&](const part& p) { return split(p, p.size() > n / workers.count() ? workers : single_thread_); },
            [&](const part& p) { split_to_leaves(p); });
        order_.threads = threads;
        return std::move(order_);
    }

private:
    /// Fills the items of a range of triangles: each gets the triangle's box in the form of one SIMD vector.
    /// @returns the box of the range
    item_bounds read_items(std::size_t begin, std::size_t end) noexcept {
        item_bounds range;
        for (std::size_t t = begin; t < end; ++t) {
            const box b = bounds_of(mesh_.triangle(static_cast<std::uint32_t>(t)));
            balanced_item& item = items_[0][t];
            for (int k = 0; k < 3; ++k) {
                item.lower[static_cast<std::size_t>(k)] = b.min[k];
                item.negated_upper[static_cast<std::size_t>(k)] = -b.max[k];
            }
            item.triangle = static_cast<std::uint32_t>(t);
            item.unused = 0;
            range.take(item);
        }
        return range;
    }

    /// Splits a part down to leaves and writes these to the order. Halving bounds the depth of the recursion.
    void split_to_leaves(const part& p) {
        if (p.size() > leaf_triangles) {
            for (const part& half : split(p, single_thread_)) split_to_leaves(half);
            return;
        }
        for (std::size_t i = p.begin; i < p.end; ++i) order_.triangles[i] = items_[p.in_second][i].triangle;
        order_.bounds[p.begin / leaf_triangles] = p.bounds;
    }

    /// Splits a part by the centres of its items, and moves these to the other array. The left side gets the greatest
    /// power of two below the part's size, since a tree without indices must have full subtrees except the last.
    [[nodiscard]] std::array<part, 2> split(const part& p, worker_threads& workers) {
        const std::size_t left_count = std::bit_ceil(p.size()) / 2;
        const std::size_t middle = p.begin + left_count;
        const std::span from = items_[p.in_second].subspan(p.begin, p.size());
        const bool in_second = !p.in_second;
        const std::span to = items_[in_second].subspan(p.begin, p.size());
        if (p.size() <= few_items::most)
            split_few(from, to, p.bounds, left_count);
        else
            split_many(from, to, p.bounds, left_count, &bin_of_item_[p.begin], workers);
        return {part{p.begin, middle, bounds_of_items(to.first(left_count), workers), in_second},
                part{middle, p.end, bounds_of_items(to.subspan(left_count), workers), in_second}};
    }

    /// Merges the boxes of items after they were moved, when most are cached: merging while they are moved is slower.
    [[nodiscard]] static box bounds_of_items(std::span<const balanced_item> items, worker_threads& workers) {
        item_bounds bounds;
        if (workers.count() == 1) {
            bounds.take(items);
            return bounds.as_box();
        }
        std::vector<item_bounds> partial((items.size() + share_size - 1) / share_size);
        workers.for_each_range(items.size(), share_size, [&](std::size_t begin, std::size_t end) {
            partial[begin / share_size].take(items.subspan(begin, end - begin));
        });
        for (const item_bounds& b : partial) bounds.take(b);
        return bounds.as_box();
    }

    /// A split axis, and a mask of the items on the left.
    struct few_split {
        std::size_t axis;
        std::uint64_t left_mask;
    };

    /// Splits few items along the longest axis, or if the rule is least area, along that with the least exact cost.
    [[nodiscard]] few_split best_split(const few_items& items, const box& bounds,
                                       std::size_t left_count) const noexcept {
        const auto longest = static_cast<std::size_t>(longest_axis(bounds));
        few_split best{longest, items.mask_of_first(left_count, longest)};
        if (rule_ == axis_rule::longest) return best;
        double least_cost = items.cost_of(best.left_mask);
        for (const std::size_t axis : {(longest + 1) % 3, (longest + 2) % 3}) {
            const std::uint64_t left_mask = items.mask_of_first(left_count, axis);
            if (const double cost = items.cost_of(left_mask); cost < least_cost) {
                least_cost = cost;
                best = {axis, left_mask};
            }
        }
        return best;
    }

    /// Splits few items, in their order within each side. Exact centres resolve ties, which make the left too large.
    void split_few(std::span<const balanced_item> from, std::span<balanced_item> to, const box& bounds,
                   std::size_t left_count) const noexcept {
        auto [axis, left_mask] = best_split(few_items(from), bounds, left_count);
        while (std::popcount(left_mask) != static_cast<int>(left_count)) left_mask &= ~last_item(from, left_mask, axis);
        std::size_t next_left = 0, next_right = left_count;
        for (std::size_t i = 0; i < from.size(); ++i) {
            const bool is_left = left_mask >> i & 1;
            to[is_left ? next_left : next_right] = from[i];
            next_left += is_left;
            next_right += !is_left;
        }
    }

    /// The bit of the last item in the mask, in the order of exact centres along the axis.
    [[nodiscard]] static std::uint64_t last_item(std::span<const balanced_item> items, std::uint64_t mask,
                                                 std::size_t axis) noexcept {
        auto last = static_cast<std::size_t>(std::countr_zero(mask));
        for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1)
            if (const auto i = static_cast<std::size_t>(std::countr_zero(rest));
                centre_order{axis}(items[last], items[i]))
                last = i;
        return std::uint64_t{1} << last;
    }

    /// The axis along which to split many items: the longest, or by the other rule that with the least estimated cost.
    [[nodiscard]] std::size_t best_axis(std::span<const balanced_item> items, const box& bounds,
                                        std::size_t left_count) const noexcept {
        const auto longest = static_cast<std::size_t>(longest_axis(bounds));
        if (rule_ == axis_rule::longest) return longest;
        const std::size_t step = (items.size() + binned_items::most - 1) / binned_items::most;
        const std::array<double, 3> costs = binned_items(items, step, bounds).costs(left_count / step);
        std::size_t best = longest;
        for (const std::size_t axis : {(longest + 1) % 3, (longest + 2) % 3})
            if (costs[axis] < costs[best]) best = axis;
        return best;
    }

    /// A part of the items of a range that is split; one thread at a time works on it.
    struct share {
        std::size_t begin;
        std::size_t end;
        std::array<std::uint32_t, bins> count{};
        std::array<std::size_t, 3> next{};  // output positions below, in and above the bin that is split
    };

    /// Splits many items by a histogram; several threads take shares of `share_size` items, or the rest, in turn.
    void split_many(std::span<balanced_item> from, std::span<balanced_item> to, const box& bounds,
                    std::size_t left_count, std::uint8_t* bin_of_item, worker_threads& workers) const {
        if (workers.count() == 1) {
            share all_items{0, from.size()};
            return split_by_histogram(from, to, bounds, left_count, bin_of_item, workers, std::span(&all_items, 1));
        }
        std::vector<share> shares;
        for (std::size_t begin = 0; begin < from.size(); begin += share_size)
            shares.push_back({begin, std::min(from.size(), begin + share_size)});
        split_by_histogram(from, to, bounds, left_count, bin_of_item, workers, shares);
    }

    /// Assigns items to bins of equal width by their centres along the axis, from `low` on, at `scale` bins per length.
    /// @param bin_of_item receives the bin of each item
    /// @returns the histogram
    static std::array<std::uint32_t, bins> count_in_bins(std::span<const balanced_item> items, std::size_t axis,
                                                         float low, float scale, std::uint8_t* bin_of_item) noexcept {
        // Several histograms: adjacent items mostly share a bin, so that increments of a single one would stall.
        constexpr std::size_t turns = 4;
        std::array<std::array<std::uint32_t, bins>, turns> counts{};
        const auto take = [&](std::size_t i, std::size_t turn) {
            // NaN if all centres are equal.
            const float at = (items[i].centre(axis) - low) * scale;
            bin_of_item[i] = static_cast<std::uint8_t>(at > 0 ? std::min(at, float{bins - 1}) : 0);
            ++counts[turn][bin_of_item[i]];
        };
        std::size_t i = 0;
        for (; i + turns <= items.size(); i += turns)
            for (std::size_t turn = 0; turn < turns; ++turn) take(i + turn, turn);
        for (; i < items.size(); ++i) take(i, 0);
        for (std::size_t b = 0; b < bins; ++b)
            for (std::size_t turn = 1; turn < turns; ++turn) counts[0][b] += counts[turn][b];
        return counts[0];
    }

    /// Splits in two passes over the items: the histogram yields the bin in which the split lies, then each item is
    /// moved below, into or above that bin, and only the items of that bin are sorted. Each side keeps its order.
    void split_by_histogram(std::span<balanced_item> from, std::span<balanced_item> to, const box& bounds,
                            std::size_t left_count, std::uint8_t* bin_of_item, worker_threads& workers,
                            std::span<share> shares) const {
        const std::size_t axis = best_axis(from, bounds, left_count);
        const float low = bounds.min[static_cast<int>(axis)];
        const float scale = bins / (bounds.max[static_cast<int>(axis)] - low);
        workers.for_each_index(shares.size(), [&](std::size_t s, std::size_t) {
            share& own = shares[s];
            own.count =
                count_in_bins(from.subspan(own.begin, own.end - own.begin), axis, low, scale, bin_of_item + own.begin);
        });
        std::array<std::uint32_t, bins> count{};
        for (const share& s : shares)
            for (std::size_t b = 0; b < bins; ++b) count[b] += s.count[b];
        std::size_t begin = 0;
        std::size_t split_bin = 0;
        while (begin + count[split_bin] <= left_count) begin += count[split_bin++];
        const std::size_t end = begin + count[split_bin];

        std::array<std::size_t, 3> next{0, begin, end};  // where the next items below, in and above that bin go
        for (share& s : shares) {
            s.next = next;
            std::size_t below = 0;
            for (std::size_t b = 0; b < split_bin; ++b) below += s.count[b];
            next[0] += below;
            next[1] += s.count[split_bin];
            next[2] += s.end - s.begin - below - s.count[split_bin];
        }
        workers.for_each_index(shares.size(), [&](std::size_t s, std::size_t) {
            // Copied to registers, since loads of recently stored values stall.
            auto [below, within, above] = shares[s].next;
            for (std::size_t i = shares[s].begin; i < shares[s].end; ++i) {
                const bool is_below = bin_of_item[i] < split_bin;
                const bool is_above = bin_of_item[i] > split_bin;
                to[is_below ? below : is_above ? above : within] = from[i];
                below += is_below;
                above += is_above;
                within += !is_below && !is_above;
            }
        });
        // Restores the original order, so that the result does not depend on the library; `from` is free by now.
        const std::span between = to.subspan(begin, end - begin);
        const std::span original = from.subspan(begin, end - begin);
        std::ranges::copy(between, original.begin());
        const auto middle = between.begin() + static_cast<std::ptrdiff_t>(left_count - begin);
        std::ranges::nth_element(between, middle, centre_order{axis});
        const balanced_item first_of_right = *middle;
        std::array<std::size_t, 2> next_of_side{begin, left_count};
        for (const balanced_item& item : original) {
            const bool is_right = !centre_order{axis}(item, first_of_right);
            to[next_of_side[is_right]++] = item;
        }
    }

    const mesh& mesh_;
    axis_rule rule_;
    large_vector<balanced_item> memory_;
    std::array<std::span<balanced_item>, 2> items_;
    large_vector<std::uint8_t> bin_of_item_;
    balanced_order order_;
    worker_threads single_thread_{1};
};

}  // namespace

balanced_order order_balanced(const mesh& m, axis_rule rule, std::uint32_t threads) {
    return balanced_order_builder(m, rule).build(threads);
}

}  // namespace aabb
