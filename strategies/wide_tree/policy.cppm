export module aabb.wide_tree.policy;

import aabb.std;
export import aabb.wide_tree.vertex_lists;
export import aabb.wide_tree.wide_node;

export namespace aabb {

/// A tree with eight children per node, stored level by level, for `batched_walk`. Child i of node n on level l is node
/// 8 n + i of level l - 1. On level 0 it is leaf 8 n + i, which has no node of its own and holds the triangles at
/// places 8 (8 n + i) to 8 (8 n + i) + 7, as far as they exist. The highest level has one node. All nodes are in one
/// array, level 0 first. A leaf's vertices come from the tree's vertex lists, if it has any. A tree that keeps fronts
/// keeps pairs of leaves from query to query (`bvtt_front`).
template <class T>
concept WideTreePolicy =
    TreePolicy<T> && requires(const T built, std::size_t level, std::uint32_t index, vertex_list& list) {
        { built.levels() } -> std::same_as<std::size_t>;
        { built.level(level) } -> std::same_as<const wide_node*>;
        { built.triangle_at(index) } -> std::same_as<std::uint32_t>;
        built.prefetch_vertices(index);
        built.prefetch_triangles(index);
        built.read_vertices(index, list);
        { built.keeps_fronts() } -> std::same_as<bool>;
    };

template <WideTreePolicy Tree>
[[nodiscard]] std::size_t nodes_of(const Tree& t) noexcept {
    return static_cast<std::size_t>(t.level(t.levels() - 1) - t.level(0)) + 1;
}

template <WideTreePolicy Tree>
[[nodiscard]] std::size_t leaves_of(const model<Tree>& m) noexcept {
    return (m.triangles().triangles.size() + vertex_lists::triangles - 1) / vertex_lists::triangles;
}

}  // namespace aabb
