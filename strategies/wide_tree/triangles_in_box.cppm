export module aabb.wide_tree.triangles_in_box;

import aabb.std;
export import aabb.wide_tree.triangle_block;

export namespace aabb {

/// Passes the triangles whose boxes overlap a given one to `take`, until it returns true. The children of a node are
/// tested at once, and so are the triangles of a leaf.
/// @param region in the frame of the mesh's floats
template <WideTreePolicy Tree, class Take>
void each_triangle_in_box(const Tree& tree, const mesh& m, const box& region, const Take& take) {
    struct node {
        std::size_t level;
        std::uint32_t index;
    };
    constexpr std::uint32_t children = wide_node::most_children;
    // The most levels of 2^31 triangles, eight per leaf. Of all but one of the opened nodes on the path to a leaf, at
    // most seven children wait.
    constexpr std::size_t most_levels = 10, most_open = (children - 1) * most_levels + 1;
    std::array<node, most_open> open;
    std::size_t count = 0;
    open[count++] = {tree.levels() - 1, 0};
    while (count > 0) {
        const auto [level, index] = open[--count];
        for (std::uint32_t rest = tree.level(level)[index].children_in(region); rest != 0; rest &= rest - 1) {
            const std::uint32_t child = children * index + static_cast<std::uint32_t>(std::countr_zero(rest));
            if (level > 0) {
                open[count++] = {level - 1, child};
                continue;
            }
            vertex_list vertices;
            tree.read_vertices(child, vertices);
            triangle_block leaf;
            leaf.load(m, tree, child, vertices);
            for (std::uint32_t in_box = leaf.triangles_in(region); in_box != 0; in_box &= in_box - 1)
                if (take(tree.triangle_at(children * child + static_cast<std::uint32_t>(std::countr_zero(in_box)))))
                    return;
        }
    }
}

}  // namespace aabb
