module aabblab.measures;

import aabb.prepare.mean_extent;

namespace aabblab {

namespace {

/// Pairs of intervals that overlap: all but those of which one ends before the other begins.
double overlapping_pairs(std::vector<float> lower, std::vector<float> upper) {
    std::ranges::sort(lower);
    std::ranges::sort(upper);
    const auto n = static_cast<double>(lower.size());
    double apart = 0;
    std::size_t ended = 0;
    for (const float begin : lower) {
        while (ended < upper.size() && upper[ended] < begin) ++ended;
        apart += static_cast<double>(ended);
    }
    return n * (n - 1) / 2 - apart;
}

double longest_edge(const aabb::box& b) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, double{b.max[k]} - double{b.min[k]});
    return longest;
}

std::optional<double> size_ratio_of(std::span<const aabb::box> boxes) {
    std::vector<double> edges;
    for (const aabb::box& b : boxes) edges.push_back(longest_edge(b));
    const double longest = *std::ranges::max_element(edges);
    const auto median = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::ranges::nth_element(edges, median);
    return *median > 0 ? std::optional(longest / *median) : std::nullopt;
}

}  // namespace

box_measures measure_boxes(std::span<const aabb::box> boxes) {
    box_measures m;
    if (boxes.empty()) return m;
    const auto n = static_cast<double>(boxes.size());
    m.size_ratio = size_ratio_of(boxes);
    m.expected_pairs = n * (n - 1) / 2;
    aabb::typical_extent extents_of_boxes;
    for (const aabb::box& b : boxes) extents_of_boxes.add(b);
    m.typical_extent = extents_of_boxes();
    for (int k = 0; k < 3; ++k) {
        std::vector<float> lower;
        std::vector<float> upper;
        double extents = 0;
        for (const aabb::box& b : boxes) {
            lower.push_back(b.min[k]);
            upper.push_back(b.max[k]);
            extents += double{b.max[k]} - double{b.min[k]};
        }
        const double width = double{*std::ranges::max_element(upper)} - double{*std::ranges::min_element(lower)};
        if (width > 0) m.expected_pairs *= std::min(1.0, 2 * extents / n / width);
        m.overlaps[static_cast<std::size_t>(k)] = 2 * overlapping_pairs(std::move(lower), std::move(upper)) / n;
    }
    return m;
}

}  // namespace aabblab
