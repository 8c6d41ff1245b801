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
    std::size_t array;  ///< 0 or 1: the index of the array that holds the items

    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

class balanced_order_builder {
public:
    /// Allocates the result and the scratch memory: two arrays of items, since each split moves them to the other.
    balanced_order_builder(const mesh& m, axis_rule rule) : mesh_(m), rule_(rule) {
        const std::size_t n = m.triangles.size();
        both_arrays_.resize(2 * n);
        items_ = {std::span(both_arrays_).first(n), std::span(both_arrays_).last(n)};
        bin_of_item_.resize(n);
        order_.triangles.resize(n);
        order_.bounds.resize((n + leaf_triangles - 1) / leaf_triangles);  // one box per leaf
    }

    /// Reads the triangles and splits them down to leaves of eight; the number of threads does not change the result.
    [[nodiscard]] balanced_order build(std::uint32_t threads) {
        worker_threads workers(threads);
        const std::size_t n = mesh_.triangles.size();
        std::vector<box> share_bounds((n + share_size - 1) / share_size);
        workers.for_each_range(n, share_size, [&](std::size_t begin, std::size_t end) {
            share_bounds[begin / share_size] = read_items(begin, end).as_box();
        });
        box root = empty_box();
        for (const box& b : share_bounds) root = merged(root, b);
        split_recursively(
            workers, part{.begin = 0, .end = n, .bounds = root, .array = 0},
            // Splits a large part: with all threads while there are fewer parts than threads, then with one per part.
            [&](const part& p) { return split(p, p.size() > n / workers.count() ? workers : single_thread_); },
            // Finishes a small part in one thread.
            [&](const part& p) { split_to_leaves(p); });
        order_.threads = threads;
        return std::move(order_);
    }

private:
    /// Fills items and returns their box. Upper ends are negated, so that one minimum of two vectors merges two boxes.
    item_bounds read_items(std::size_t begin, std::size_t end) noexcept {
        item_bounds range;
        for (std::size_t t = begin; t < end; ++t) {
            const box b = bounds_of(mesh_.triangle(static_cast<std::uint32_t>(t)));
            boxed_triangle& item = items_[0][t];
            for (int k = 0; k < 3; ++k) {
                item.lower[static_cast<std::size_t>(k)] = b.min[k];
                item.negated_upper[static_cast<std::size_t>(k)] = -b.max[k];
            }
            item.triangle = static_cast<std::uint32_t>(t);
            item.unused = 0;  // pads the item to a vector
            range.take(item);
        }
        return range;
    }

    /// Splits a part down to leaves of eight. Recursion is logarithmic: the larger side of a split is a power of two.
    void split_to_leaves(const part& p) {
        if (p.size() > leaf_triangles) {
            for (const part& side : split(p, single_thread_)) split_to_leaves(side);
            return;
        }
        for (std::size_t i = p.begin; i < p.end; ++i) order_.triangles[i] = items_[p.array][i].triangle;
        order_.bounds[p.begin / leaf_triangles] = p.bounds;
    }

    /// Splits a part by the centres of its items along an axis, and moves these to the same range of the other array,
    /// those of the left side first. The left side gets the greatest power of two below the part's size: the tree
    /// computes the indices of children instead of storing them, so that every subtree but the last must be full.
    [[nodiscard]] std::array<part, 2> split(const part& p, worker_threads& workers) {
        const std::size_t left_count = std::bit_ceil(p.size()) / 2;
        const std::size_t middle = p.begin + left_count;
        const std::size_t other = 1 - p.array;
        const std::span from = items_[p.array].subspan(p.begin, p.size());
        const std::span to = items_[other].subspan(p.begin, p.size());
        if (p.size() <= few_items::most)  // each of at most 64 items is compared with all
            split_few(from, to, p.bounds, left_count);
        else
            split_many(from, to, p.bounds, left_count, &bin_of_item_[p.begin], workers);
        return {part{p.begin, middle, bounds_of_items(to.first(left_count), workers), other},
                part{middle, p.end, bounds_of_items(to.subspan(left_count), workers), other}};
    }

    /// The box of a side, merged after its items were moved, when most are in a cache: merging meanwhile is slower.
    [[nodiscard]] static box bounds_of_items(std::span<const boxed_triangle> items, worker_threads& workers) {
        item_bounds bounds;
        if (workers.count() == 1) {
            bounds.take(items);
            return bounds.as_box();
        }
        std::vector<item_bounds> share_bounds((items.size() + share_size - 1) / share_size);
        workers.for_each_range(items.size(), share_size, [&](std::size_t begin, std::size_t end) {
            share_bounds[begin / share_size].take(items.subspan(begin, end - begin));
        });
        for (const item_bounds& b : share_bounds) bounds.take(b);
        return bounds.as_box();
    }

    /// A split axis, and a mask of the items on the left.
    struct few_split {
        std::size_t axis;
        std::uint64_t left_mask;
    };

    /// The split of at most 64 items into the first `left_count` along an axis and the others: along the longest axis
    /// of their box, or if the rule is least area, along the axis whose split has the least surface-area cost.
    /// @returns the axis, and a mask in which bit i is set if item i goes to the left
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

    /// Moves at most 64 items to `to`, the `left_count` of the left side first, each side in its order. The mask
    /// compares centres rounded to 16 bits; if ties put too many items into it, the last by exact centres are removed.
    void split_few(std::span<const boxed_triangle> from, std::span<boxed_triangle> to, const box& bounds,
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

    /// The bit of the last item in the order of centres along the axis, among the items whose bit is set in the mask.
    [[nodiscard]] static std::uint64_t last_item(std::span<const boxed_triangle> items, std::uint64_t mask,
                                                 std::size_t axis) noexcept {
        auto last = static_cast<std::size_t>(std::countr_zero(mask));
        for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1)  // clears the lowest bit
            if (const auto i = static_cast<std::size_t>(std::countr_zero(rest));
                centre_order{axis}(items[last], items[i]))
                last = i;
        return std::uint64_t{1} << last;
    }

    /// The axis along which to split many items: the longest, or if the rule is least area, the one whose split has the
    /// least surface-area cost, estimated from a sample of every `step`-th item, at most 256.
    [[nodiscard]] std::size_t best_axis(std::span<const boxed_triangle> items, const box& bounds,
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

    /// Moves many items to `to`, the `left_count` of the left side first. Threads take shares of `share_size` items.
    /// @param bin_of_item scratch memory, one byte per item
    void split_many(std::span<boxed_triangle> from, std::span<boxed_triangle> to, const box& bounds,
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

    /// Assigns each item to the bin floor((centre - low) * scale), clamped to the first and the last bin.
    /// @param scale bins per unit of length
    /// @returns the number of items in each bin
    static std::array<std::uint32_t, bins> count_in_bins(std::span<const boxed_triangle> items, std::size_t axis,
                                                         float low, float scale, std::uint8_t* bin_of_item) noexcept {
        // Four histograms, used in turn: adjacent items mostly share a bin, so that increments of a single counter
        // would wait for each other.
        constexpr std::size_t turns = 4;
        std::array<std::array<std::uint32_t, bins>, turns> counts{};
        const auto take = [&](std::size_t i, std::size_t turn) {
            // NaN if all centres are equal; the comparison below then chooses bin 0.
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

    /// Moves the items, the `left_count` first along an axis before the others, each side in its order. The first pass
    /// counts a histogram of centres, which yields the bin of item `left_count`; the second moves each item below, into
    /// or above that bin, whose items alone are split by comparisons.
    /// @param bin_of_item scratch memory, one byte per item
    /// @param shares the items of each unit of multithreaded work
    void split_by_histogram(std::span<boxed_triangle> from, std::span<boxed_triangle> to, const box& bounds,
                            std::size_t left_count, std::uint8_t* bin_of_item, worker_threads& workers,
                            std::span<share> shares) const {
        const std::size_t axis = best_axis(from, bounds, left_count);
        const float low = bounds.min[static_cast<int>(axis)];
        const float scale = bins / (bounds.max[static_cast<int>(axis)] - low);
        workers.for_each_index(shares.size(), [&](std::size_t s, std::size_t) {
            const std::size_t first = shares[s].begin;
            const std::span items = from.subspan(first, shares[s].end - first);
            shares[s].count = count_in_bins(items, axis, low, scale, bin_of_item + first);
        });
        std::array<std::uint32_t, bins> count{};
        for (const share& s : shares)
            for (std::size_t b = 0; b < bins; ++b) count[b] += s.count[b];
        std::size_t begin = 0;  // number of items below the bin
        std::size_t split_bin = 0;
        while (begin + count[split_bin] <= left_count) begin += count[split_bin++];
        const std::size_t size = count[split_bin];

        // Where the next items below, in and above the bin go; each share gets a range of its own in all three.
        std::array<std::size_t, 3> next{0, begin, begin + size};
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
        split_by_selection(to.subspan(begin, size), from.subspan(begin, size), left_count - begin, axis);
    }

    /// Splits items in place, the `left_count` first along the axis before the others, by selection. The order of each
    /// side is restored from `copy`, scratch memory, since that of `nth_element` depends on the library.
    static void split_by_selection(std::span<boxed_triangle> items, std::span<boxed_triangle> copy,
                                   std::size_t left_count, std::size_t axis) {
        std::ranges::copy(items, copy.begin());
        const auto middle = items.begin() + static_cast<std::ptrdiff_t>(left_count);
        std::ranges::nth_element(items, middle, centre_order{axis});
        const boxed_triangle first_of_right = *middle;
        std::array<std::size_t, 2> next_of_side{0, left_count};
        for (const boxed_triangle& item : copy) {
            const bool is_right = !centre_order{axis}(item, first_of_right);
            items[next_of_side[is_right]++] = item;
        }
    }

    const mesh& mesh_;
    axis_rule rule_;
    large_vector<boxed_triangle> both_arrays_;
    std::array<std::span<boxed_triangle>, 2> items_;  // the two arrays, in this memory
    large_vector<std::uint8_t> bin_of_item_;
    balanced_order order_;
    worker_threads single_thread_{1};
};

}  // namespace

balanced_order order_balanced(const mesh& m, axis_rule rule, std::uint32_t threads) {
    return balanced_order_builder(m, rule).build(threads);
}

}  // namespace aabb
