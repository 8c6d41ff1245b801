module aabb.build.mean;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

split_choice mean_split(std::span<const build_element> range, const box& bounds) {
    const int axis = longest_axis(bounds);
    double sum = 0;
    for (const build_element& e : range) sum += e.centroid[axis];
    const double mean = sum / static_cast<double>(range.size());
    const auto below = std::ranges::count_if(range, [&](const build_element& e) { return e.centroid[axis] < mean; });
    const auto left = static_cast<std::size_t>(below);
    return left == 0 || left == range.size() ? median_split(range, bounds) : split_choice{axis, left};
}

}  // namespace aabb
