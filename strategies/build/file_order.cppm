export module aabb.build.file_order;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.threaded;
import aabb.std;

export namespace aabb {

/// Triangles stay as they stand in the mesh: a node's first ones, as many as the greatest power of two below their
/// number, go to the left. When to use: for meshes that were written in the order of a tree's leaves (`in_leaf_order`,
/// `./aabblab order`), of which `implicit` then need not say which triangle stands where.
struct file_order_build : threaded_build {
    using threaded_build::threaded_build;

    static constexpr std::string_view name = "file_order";
    static constexpr std::string_view summary = "halves of the mesh's own order, for meshes written leaf by leaf";

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const;
    [[nodiscard]] balanced_order order(const mesh& m) const;
};

static_assert(BuildPolicy<file_order_build>);

}  // namespace aabb
