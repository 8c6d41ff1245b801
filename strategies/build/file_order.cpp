module aabb.build.file_order;

import aabb.base;
import aabb.build.top_down;

namespace aabb {

std::vector<build_node> file_order_build::build(const mesh& m, leaf_arrangement arrangement) const {
    const auto halves = [](std::span<const build_element> range, const box&) {
        return split_choice{split_choice::as_they_stand, std::bit_ceil(range.size()) / 2};
    };
    return build_top_down(m, arrangement, halves, threads);
}

balanced_order file_order_build::order(const mesh& m) const {
    constexpr std::size_t in_leaf = balanced_order::leaf_triangles;
    const std::size_t n = m.triangles.size();
    balanced_order made{large_vector<std::uint32_t>(n), large_vector<box>((n + in_leaf - 1) / in_leaf, empty_box()),
                        threads};
    std::iota(made.triangles.begin(), made.triangles.end(), 0U);
    worker_threads(threads).for_each_range(n, least_shared, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            box& leaf = made.bounds[t / in_leaf];
            leaf = merged(leaf, bounds_of(m.triangle(static_cast<std::uint32_t>(t))));
        }
    });
    return made;
}

}  // namespace aabb
