module aabblab.measures;

import aabb.global_search;

namespace aabblab {

namespace {

/// An object: pairs in the order of the frame before that stand in the wrong order now.
double inversions_of(std::span<const aabb::box> before, std::span<const aabb::box> after, int axis) {
    std::vector<std::uint32_t> order(before.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t id) { return before[id].min[axis]; });
    std::vector<aabb::projection> list;
    for (const std::uint32_t id : order) list.push_back({after[id].min[axis], id});
    aabb::inversion_counter counter;
    return static_cast<double>(counter.count(list)) / static_cast<double>(list.size());
}

}  // namespace

motion_measures measure_motion(std::span<const aabb::box> before, std::span<const aabb::box> after, std::size_t axis) {
    motion_measures m;
    if (before.empty()) return m;
    const auto n = static_cast<double>(before.size());
    double ways = 0;
    double moved = 0;
    std::vector<double> squares(before.size());
    for (int k = 0; k < 3; ++k) {
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const double lower = double{after[i].min[k]} - double{before[i].min[k]};
            const double upper = double{after[i].max[k]} - double{before[i].max[k]};
            squares[i] += (lower + upper) * (lower + upper) / 4;
            least = std::min(least, lower);
            most = std::max(most, upper);
        }
        m.relative = std::max(m.relative, (most - least) / 2);
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        ways += std::sqrt(squares[i]);
        moved += before[i] == after[i] ? 0 : 1;
    }
    m.displacement = ways / n;
    m.at_rest = 1 - moved / n;
    m.inversions = inversions_of(before, after, static_cast<int>(axis));
    return m;
}

}  // namespace aabblab
