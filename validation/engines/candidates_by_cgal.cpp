module;
#include <CGAL/box_intersection_d.h>

module aabb.engines;

import :pairwise;

namespace aabb {

std::vector<index_pair> candidates_by_cgal(std::span<const box> a, std::span<const box> b) {
    constexpr std::uint64_t of_b = std::uint64_t{1} << 32;
    std::vector<numbered_box> boxes_a;
    std::vector<numbered_box> boxes_b;
    for (std::size_t i = 0; i < a.size(); ++i) boxes_a.push_back({a[i], i});
    for (std::size_t i = 0; i < b.size(); ++i) boxes_b.push_back({b[i], of_b | i});
    std::vector<index_pair> pairs;
    CGAL::box_intersection_d(
        boxes_a.begin(), boxes_a.end(), boxes_b.begin(), boxes_b.end(),
        [&](const numbered_box& s, const numbered_box& t) {
            pairs.push_back({static_cast<std::uint32_t>(s.number), static_cast<std::uint32_t>(t.number)});
        });
    return pairs;
}

}  // namespace aabb
