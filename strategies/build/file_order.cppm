export module aabb.build.file_order;

import aabb.build.top_down;
import aabb.std;

export namespace aabb {

/// Keeps the triangles in the order of the mesh: the first ones of a node, up to the greatest power of two below their
/// number, go to the left. When to use: for meshes that were written in the order of a tree's leaves (`in_leaf_order`,
/// `./aabblab order`), for which `implicit` needs no triangle indices.
struct file_order_build : threaded_build {
    using threaded_build::threaded_build;

    static constexpr std::string_view name = "file_order";
    static constexpr std::string_view summary =
        "halves the mesh's own order of triangles, for meshes that are stored leaf by leaf";

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const {
        const auto halves = [](std::span<const build_element> range, const box&) {
            return split_choice{split_choice::in_current_order, std::bit_ceil(range.size()) / 2};
        };
        return build_top_down(m, arrangement, halves, threads);
    }

    /// Keeps the order of the triangles in the mesh, and computes the boxes of the leaves, each of eight successive
    /// triangles. Threads process shares of a multiple of eight triangles, so that no two of them write to one box.
    [[nodiscard]] balanced_order order(const mesh& m) const {
        constexpr std::size_t in_leaf = balanced_order::leaf_triangles;
        const std::size_t n = m.triangles.size();
        balanced_order order_of_file{.triangles = large_vector<std::uint32_t>(n),
                                     .bounds = large_vector<box>((n + in_leaf - 1) / in_leaf, empty_box()),
                                     .threads = threads};
        std::iota(order_of_file.triangles.begin(), order_of_file.triangles.end(), 0U);  // the identity
        worker_threads(threads).for_each_range(n, share_size, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                box& leaf = order_of_file.bounds[t / in_leaf];
                leaf = merged(leaf, bounds_of(m.triangle(static_cast<std::uint32_t>(t))));
            }
        });
        return order_of_file;
    }
};

static_assert(BuildPolicy<file_order_build>);

}  // namespace aabb
