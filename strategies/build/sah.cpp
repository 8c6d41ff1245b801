module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

module aabb.build.sah;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.top_down;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

constexpr std::size_t sah_bins = 16;
constexpr std::size_t most_sorted = 64;

/// Triangles whose centroids lie in one slice of the node.
struct sah_bin {
    box bounds = empty_box();
    std::size_t count = 0;
};

/// Maps centroids to bins, a monotone function along the axis.
class sah_binning {
public:
    sah_binning(double low, double high) noexcept : low_(low), scale_(double{sah_bins} / (high - low)) {}

    [[nodiscard]] std::size_t operator()(float centroid) const noexcept {
        return std::min(sah_bins - 1, static_cast<std::size_t>((double{centroid} - low_) * scale_));
    }

private:
    double low_;
    double scale_;
};

/// A split and what it costs.
struct sah_split {
    split_choice choice;
    double cost = std::numeric_limits<double>::infinity();

    void take_cheaper(const sah_split& other) noexcept {
        if (other.cost < cost) *this = other;
    }
};

double cost_of(const box& bounds, std::size_t count) noexcept {
    return surface_area(bounds) * static_cast<double>(count);
}

/// The best split between bins along the axis; of as many on the left as is wanted, or nearly.
sah_split split_in_bins(std::span<const build_element> range, int axis, const box& centroids,
                        std::size_t wanted) noexcept {
    const sah_binning bin_of(centroids.min[axis], centroids.max[axis]);
    std::array<sah_bin, sah_bins> bins{};
    for (const build_element& e : range) {
        sah_bin& bin = bins[bin_of(e.centroid[axis])];
        bin.bounds = merged(bin.bounds, e.bounds);
        ++bin.count;
    }
    // Cost of all from a bin on.
    std::array<double, sah_bins> right{};
    sah_bin all;
    for (std::size_t i = sah_bins; i-- > 1;) {
        all.bounds = merged(all.bounds, bins[i].bounds);
        all.count += bins[i].count;
        right[i] = all.count == 0 ? 0 : cost_of(all.bounds, all.count);
    }
    sah_split best;
    std::size_t least_missed = range.size();
    all = {};
    for (std::size_t i = 0; i + 1 < sah_bins; ++i) {
        all.bounds = merged(all.bounds, bins[i].bounds);
        all.count += bins[i].count;
        if (all.count == 0 || all.count == range.size()) continue;
        const sah_split here{{axis, all.count}, cost_of(all.bounds, all.count) + right[i + 1]};
        if (wanted == any_number) {
            best.take_cheaper(here);
        } else {
            const std::size_t missed = all.count < wanted ? wanted - all.count : all.count - wanted;
            if (missed < least_missed) best = here;
            least_missed = std::min(least_missed, missed);
        }
    }
    // What a split elsewhere costs says nothing about this one.
    if (wanted != any_number && least_missed > range.size() / 4) return {};
    return best;
}

/// With so many on the left along the axis, for few elements.
sah_split split_at(std::span<const build_element> range, int axis, std::size_t left) {
    std::array<const build_element*, most_sorted> sorted;
    const auto end = std::ranges::transform(range, sorted.begin(), [](const build_element& e) { return &e; }).out;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(left);
    std::nth_element(sorted.begin(), middle, end,
                     [order = centroid_order{axis}](const auto* p, const auto* q) { return order(*p, *q); });
    const auto cost_between = [](auto from, auto to) {
        box all = empty_box();
        for (auto e = from; e != to; ++e) all = merged(all, (*e)->bounds);
        return cost_of(all, static_cast<std::size_t>(to - from));
    };
    return {{axis, left}, cost_between(sorted.begin(), middle) + cost_between(middle, end)};
}

split_choice split(std::span<const build_element> range, const box& bounds, std::size_t left) {
    box centroids = empty_box();
    for (const build_element& e : range) centroids = merged(centroids, bounds_of(e.centroid));
    sah_split best{median_split(range, bounds)};
    for (int axis = 0; axis < 3; ++axis)
        if (left != any_number && range.size() <= most_sorted)
            best.take_cheaper(split_at(range, axis, left));
        else if (centroids.min[axis] < centroids.max[axis])
            best.take_cheaper(split_in_bins(range, axis, centroids, left));
    return best.choice;
}

}  // namespace

std::vector<build_node> sah_build::build(const mesh& m, leaf_arrangement arrangement) {
    return build_top_down(m, arrangement, split);
}

}  // namespace aabb
