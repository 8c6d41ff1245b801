export module aabb.local_detection:triangles_in_box;

import aabb.std;
import :model;

export namespace aabb {

/// Passes the triangles of a mesh whose boxes overlap a given one to `take`, and perhaps some others, until it returns
/// true. A layout may declare a member `each_triangle_in`, which does the same in less time.
/// @param region in the frame of the mesh's floats
/// @throws input_error as `model::require_fit`
template <TreePolicy Tree, class Take>
void each_triangle_in(const model<Tree>& m, const box& region, const Take& take) {
    m.require_fit();
    const Tree& tree = m.tree();
    if constexpr (requires { tree.each_triangle_in(m.triangles(), region, take); }) {
        tree.each_triangle_in(m.triangles(), region, take);
    } else {
        constexpr std::size_t usual_depth = 64;
        std::vector<typename Tree::cursor> open;
        open.reserve(usual_depth);
        open.push_back(m.root());
        while (!open.empty()) {
            const typename Tree::cursor node = open.back();
            open.pop_back();
            if (!overlaps(tree.bounds(node), region)) continue;
            if (tree.is_leaf(node)) {
                if (take(tree.triangle(node))) return;
                continue;
            }
            for (const typename Tree::cursor& child : tree.children(node, m.triangles())) open.push_back(child);
        }
    }
}

}  // namespace aabb
