module;
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

module aabb.build.balanced;

import aabb.base;
import aabb.geometry;
import aabb.local_detection;
import aabb.build.balanced_item;
import aabb.build.binned_items;
import aabb.build.few_items;
import aabb.build.halving;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

constexpr std::size_t leaf_triangles = balanced_order::leaf_triangles;
constexpr std::size_t bins = 256;

/// A range of places, and where its items are.
struct part {
    std::size_t begin;
    std::size_t end;
    box bounds;
    bool in_second;  ///< of the two arrays

    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

class balancer {
public:
    balancer(const mesh& m, axis_rule rule) : mesh_(m), rule_(rule) {
        const std::size_t n = m.triangles.size();
        for (auto& items : items_) items.resize(n);
        bin_.resize(n);
        order_.triangles.resize(n);
        order_.bounds.resize((n + leaf_triangles - 1) / leaf_triangles);
    }

    [[nodiscard]] balanced_order order(std::uint32_t threads) {
        worker_threads workers(threads);
        const std::size_t n = mesh_.triangles.size();
        std::vector<box> bounds((n + least_shared - 1) / least_shared);
        workers.for_each_range(n, least_shared, [&](std::size_t begin, std::size_t end) {
            bounds[begin / least_shared] = read(begin, end).as_box();
        });
        box all = empty_box();
        for (const box& b : bounds) all = merged(all, b);
        halve(
            workers, part{0, n, all, false},
            // Where there are fewer parts than threads, these share one.
            [&](const part& p) { return split(p, p.size() > n / workers.count() ? workers : alone_); },
            [&](const part& p) { finish(p); });
        order_.threads = threads;
        return std::move(order_);
    }

private:
    item_bounds read(std::size_t begin, std::size_t end) noexcept {
        item_bounds all;
        for (std::size_t t = begin; t < end; ++t) {
            const box b = bounds_of(mesh_.triangle(static_cast<std::uint32_t>(t)));
            balanced_item& made = items_[0][t];
            for (int k = 0; k < 3; ++k) {
                made.lower[static_cast<std::size_t>(k)] = b.min[k];
                made.negated_upper[static_cast<std::size_t>(k)] = -b.max[k];
            }
            made.triangle = static_cast<std::uint32_t>(t);
            made.unused = 0;
            all.take(made);
        }
        return all;
    }

    /// Calls itself no deeper than a number has bits.
    void finish(const part& p) {
        if (p.size() > leaf_triangles) {
            for (const part& half : split(p, alone_)) finish(half);
            return;
        }
        for (std::size_t i = p.begin; i < p.end; ++i) order_.triangles[i] = items_[p.in_second][i].triangle;
        order_.bounds[p.begin / leaf_triangles] = p.bounds;
    }

    [[nodiscard]] std::array<part, 2> split(const part& p, worker_threads& workers) {
        const std::size_t middle = p.begin + std::bit_ceil(p.size()) / 2;
        const std::span from = std::span(items_[p.in_second]).subspan(p.begin, p.size());
        const std::span to = std::span(items_[!p.in_second]).subspan(p.begin, p.size());
        const auto bounds = p.size() <= few_items::most
                                ? split_few(from, to, p.bounds, middle - p.begin)
                                : split_many(from, to, p.bounds, middle - p.begin, &bin_[p.begin], workers);
        return {part{p.begin, middle, bounds[0].as_box(), !p.in_second},
                part{middle, p.end, bounds[1].as_box(), !p.in_second}};
    }

    /// An axis, and the items before which fewer than `left` others lie along it; with ties there may be more than
    /// `left` of them.
    struct few_split {
        std::size_t axis;
        std::uint64_t first;
    };

    [[nodiscard]] few_split best_split(const few_items& items, const box& bounds, std::size_t left) const noexcept {
        const auto longest = static_cast<std::size_t>(longest_axis(bounds));
        few_split best{longest, items.first(longest, left)};
        if (rule_ == axis_rule::longest) return best;
        double least = items.cost_of(best.first);
        for (const std::size_t axis : {(longest + 1) % 3, (longest + 2) % 3}) {
            const std::uint64_t first = items.first(axis, left);
            if (const double cost = items.cost_of(first); cost < least) {
                least = cost;
                best = {axis, first};
            }
        }
        return best;
    }

    [[nodiscard]] std::array<item_bounds, 2> split_few(std::span<const balanced_item> from, std::span<balanced_item> to,
                                                       const box& bounds, std::size_t left) const noexcept {
        auto [axis, first] = best_split(few_items(from), bounds, left);
        while (std::popcount(first) != static_cast<int>(left)) first &= ~last_of(from, first, axis);
        std::array<std::size_t, 2> next{left, 0};
        std::array<item_bounds, 2> halves;
        for (std::size_t i = 0; i < from.size(); ++i) {
            const bool is_first = first >> i & 1;
            to[next[is_first]++] = from[i];
            halves[0].take_if(is_first, from[i]);
            halves[1].take_if(!is_first, from[i]);
        }
        return halves;
    }

    /// The bit of the last of those items.
    [[nodiscard]] static std::uint64_t last_of(std::span<const balanced_item> items, std::uint64_t which,
                                               std::size_t axis) noexcept {
        auto last = static_cast<std::size_t>(std::countr_zero(which));
        for (std::uint64_t rest = which; rest != 0; rest &= rest - 1)
            if (const auto i = static_cast<std::size_t>(std::countr_zero(rest));
                centre_order{axis}(items[last], items[i]))
                last = i;
        return std::uint64_t{1} << last;
    }

    [[nodiscard]] std::size_t best_axis(std::span<const balanced_item> items, const box& bounds,
                                        std::size_t left) const noexcept {
        const auto longest = static_cast<std::size_t>(longest_axis(bounds));
        if (rule_ == axis_rule::longest) return longest;
        const std::size_t step = (items.size() + binned_items::most - 1) / binned_items::most;
        const binned_items some(items, step, bounds);
        const auto cost_of = [&](std::size_t axis) { return some.cost_of(axis, left / step); };
        std::size_t best = longest;
        double least = cost_of(longest);
        for (const std::size_t axis : {(longest + 1) % 3, (longest + 2) % 3})
            if (const double cost = cost_of(axis); cost < least) {
                least = cost;
                best = axis;
            }
        return best;
    }

    /// What falls to one thread of a range that is split.
    struct share {
        std::size_t begin;
        std::size_t end;
        std::array<std::uint32_t, bins> count{};
        std::array<std::size_t, 3> next{};  // places for what lies below, in and above the bin that is split
        std::array<item_bounds, 2> halves{};
    };

    /// By how many centres lie in each bin: only those of one bin have to be put in order.
    [[nodiscard]] std::array<item_bounds, 2> split_many(std::span<balanced_item> from, std::span<balanced_item> to,
                                                        const box& bounds, std::size_t left, std::uint8_t* bin,
                                                        worker_threads& workers) const {
        if (workers.count() == 1) {
            share whole{0, from.size()};
            return split_shared(from, to, bounds, left, bin, workers, std::span(&whole, 1));
        }
        std::vector<share> shares;
        for (std::size_t begin = 0; begin < from.size(); begin += least_shared)
            shares.push_back({begin, std::min(from.size(), begin + least_shared)});
        return split_shared(from, to, bounds, left, bin, workers, shares);
    }

    [[nodiscard]] std::array<item_bounds, 2> split_shared(std::span<balanced_item> from, std::span<balanced_item> to,
                                                          const box& bounds, std::size_t left, std::uint8_t* bin,
                                                          worker_threads& workers, std::span<share> shares) const {
        const std::size_t axis = best_axis(from, bounds, left);
        const float low = bounds.min[static_cast<int>(axis)];
        const float scale = bins / (bounds.max[static_cast<int>(axis)] - low);
        workers.for_each_index(shares.size(), [&](std::size_t s, std::size_t) {
            share& mine = shares[s];
            for (std::size_t i = mine.begin; i < mine.end; ++i) {
                // Not a number where all are equal.
                const float place = (from[i].centre(axis) - low) * scale;
                bin[i] = static_cast<std::uint8_t>(place > 0 ? std::min(place, float{bins - 1}) : 0);
                ++mine.count[bin[i]];
            }
        });
        std::array<std::uint32_t, bins> count{};
        for (const share& s : shares)
            for (std::size_t b = 0; b < bins; ++b) count[b] += s.count[b];
        std::size_t begin = 0;
        std::size_t at = 0;
        while (begin + count[at] <= left) begin += count[at++];
        const std::size_t end = begin + count[at];

        std::array<std::size_t, 3> next{0, begin, end};
        for (share& s : shares) {
            s.next = next;
            std::size_t below = 0;
            for (std::size_t b = 0; b < at; ++b) below += s.count[b];
            next[0] += below;
            next[1] += s.count[at];
            next[2] += s.end - s.begin - below - s.count[at];
        }
        workers.for_each_index(shares.size(), [&](std::size_t s, std::size_t) {
            std::array<std::size_t, 3> place = shares[s].next;
            std::array<item_bounds, 2> halves;
            for (std::size_t i = shares[s].begin; i < shares[s].end; ++i) {
                const std::size_t side = std::size_t{bin[i] >= at} + (bin[i] > at);
                to[place[side]++] = from[i];
                halves[0].take_if(side == 0, from[i]);
                halves[1].take_if(side == 2, from[i]);
            }
            shares[s].halves = halves;
        });
        std::array<item_bounds, 2> halves;
        for (const share& s : shares)
            for (std::size_t h = 0; h < 2; ++h) halves[h].take(s.halves[h]);
        // In the order in which they came, whatever the library makes of it: what was read is no longer needed.
        const std::span between = to.subspan(begin, end - begin);
        const std::span came = from.subspan(begin, end - begin);
        std::ranges::copy(between, came.begin());
        const auto middle = between.begin() + static_cast<std::ptrdiff_t>(left - begin);
        std::ranges::nth_element(between, middle, centre_order{axis});
        const balanced_item first_of_right = *middle;
        std::array<std::size_t, 2> place{begin, left};
        for (const balanced_item& one : came) {
            const bool is_right = !centre_order{axis}(one, first_of_right);
            to[place[is_right]++] = one;
            halves[is_right].take(one);
        }
        return halves;
    }

    const mesh& mesh_;
    axis_rule rule_;
    std::array<std::vector<balanced_item, large_pages<balanced_item>>, 2> items_;
    std::vector<std::uint8_t, large_pages<std::uint8_t>> bin_;
    balanced_order order_;
    worker_threads alone_{1};
};

}  // namespace

balanced_order order_by_halves(const mesh& m, axis_rule rule, std::uint32_t threads) {
    return balancer(m, rule).order(threads);
}

}  // namespace aabb
