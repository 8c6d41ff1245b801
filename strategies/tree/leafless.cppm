export module aabb.tree.leafless;

import aabb.std;
import aabb.tree.leafless_config;

export namespace aabb {

/// The canonical internal nodes without leaves: the parent stores a leaf's triangle index in place of the node index
/// (paper, section 3.2, one half of the compression). 32 bytes per triangle. When to use: as the intermediate step
/// between `canonical` and `compressed`.
class leafless_tree : public leafless_layout {
public:
    static constexpr std::string_view name = "leafless";
    static constexpr std::string_view summary =
        "internal nodes of 32 bytes, no leaves: parents store the triangle indices";

    using leafless_layout::leafless_layout;

    /// Lays out the internal nodes in preorder. packed[i] is the new index of node i, or a leaf's triangle and a bit.
    void pack(std::span<const build_node> nodes) {
        nodes_.clear();
        nodes_.reserve(nodes.size() / 2);
        std::vector<std::uint32_t> packed(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            packed[i] =
                nodes[i].is_leaf() ? nodes[i].triangle | cursor::leaf_bit : static_cast<std::uint32_t>(nodes_.size());
            if (!nodes[i].is_leaf()) nodes_.push_back({nodes[i].bounds, {}});
        }
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!nodes[i].is_leaf()) nodes_[packed[i]].child = {packed[i + 1], packed[nodes[i].right]};
    }

    /// Recomputes all boxes bottom-up.
    void refit(const mesh& m, std::vector<box>&) {
        const auto bounds_at = [&](std::uint32_t child) {
            return child & cursor::leaf_bit ? bounds_of(m.triangle(child & ~cursor::leaf_bit)) : nodes_[child].bounds;
        };
        // Children are stored behind their parents, so that a reverse pass is bottom-up.
        for (std::size_t i = nodes_.size(); i-- > 0;)
            nodes_[i].bounds = merged(bounds_at(nodes_[i].child[0]), bounds_at(nodes_[i].child[1]));
    }

    [[nodiscard]] inline cursor root(const mesh& m) const noexcept {
        return nodes_.empty() ? leaf_cursor(0, bounds_of(m.triangle(0)), m) : cursor{nodes_[0].bounds, 0};
    }
    /// The children of an internal node; the cursor of a leaf has the box of its parent, or of its triangle.
    [[nodiscard]] inline std::array<cursor, 2> children(const cursor& at, const mesh& m) const noexcept {
        const auto child = [&](std::uint32_t index) {
            if (!(index & cursor::leaf_bit)) return cursor{nodes_[index].bounds, index};
            return leaf_cursor(index & ~cursor::leaf_bit, at.bounds, m);
        };
        const node& parent = nodes_[at.index];
        return {child(parent.child[0]), child(parent.child[1])};
    }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        return {sizeof(box) * nodes_.capacity(), sizeof(node::child) * nodes_.capacity()};
    }

private:
    struct node {
        box bounds;
        std::array<std::uint32_t, 2> child;  // nodes, or triangles with the top bit set
    };
    static_assert(sizeof(node) == 32);

    std::vector<node> nodes_;  // depth first
};

static_assert(TreePolicy<leafless_tree>);

}  // namespace aabb
