module aabb.build.midpoint;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

split_choice midpoint_split(std::span<const build_element> range, const box& bounds) {
    const int axis = longest_axis(bounds);
    // In double, so that the sum cannot overflow.
    const double middle = (double{bounds.min[axis]} + double{bounds.max[axis]}) / 2;
    const auto below = std::ranges::count_if(range, [&](const build_element& e) { return e.centroid[axis] < middle; });
    const auto left = static_cast<std::size_t>(below);
    return left == 0 || left == range.size() ? median_split(range, bounds) : split_choice{axis, left};
}

}  // namespace aabb
