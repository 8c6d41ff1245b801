export module aabb.tree.compressed;

import aabb.std;
import aabb.tree.leafless_config;

export namespace aabb {

/// The paper's compressed storage (section 3.2, table 1), lossless: there are no leaves, and two siblings share one
/// record of six planes, 12 bytes per node. A node above two leaves needs no planes and no symbol byte: such nodes are
/// stored behind the others, as two triangle indices. That takes 20.5 bytes per triangle instead of table 1's 21.
/// Leaves come in pairs (`leaf_arrangement::pairs`), since a leaf beside an internal node would waste half a record.
/// When to use: for the least memory with exact boxes.
class compressed_tree : public leafless_layout {
public:
    static constexpr std::string_view name = "compressed";
    static constexpr std::string_view summary =
        "the tree of the paper's claims, lossless: no leaves, six planes and a symbol byte per two siblings";
    static constexpr leaf_arrangement arrangement = leaf_arrangement::pairs;

    using leafless_layout::leafless_layout;

    /// Lays out the internal nodes with the planes of their children; nodes above two leaves need none, and come last.
    /// packed[i] is the new index of node i, or the triangle of a leaf.
    void pack(std::span<const build_node> nodes) {
        // In preorder, the left child of node i is i + 1.
        const auto holds_leaves_only = [&](std::size_t i) {
            return nodes[i + 1].is_leaf() && nodes[nodes[i].right].is_leaf();
        };
        std::size_t with_planes = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) with_planes += !nodes[i].is_leaf() && !holds_leaves_only(i);
        nodes_.assign(with_planes, {});
        symbols_.assign(with_planes, 0);
        leaf_pairs_.assign(nodes.size() / 2 - with_planes, {});
        std::vector<std::uint32_t> packed(nodes.size());
        for (std::size_t i = 0, next = 0, next_pair = with_planes; i < nodes.size(); ++i)
            packed[i] = nodes[i].is_leaf() ? nodes[i].triangle
                                           : static_cast<std::uint32_t>(holds_leaves_only(i) ? next_pair++ : next++);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].is_leaf()) continue;
            const std::size_t right = nodes[i].right;
            child_pair& child =
                packed[i] < with_planes ? nodes_[packed[i]].child : leaf_pairs_[packed[i] - with_planes];
            child = {packed[i + 1], packed[right]};
            if (packed[i] >= with_planes) continue;  // above two leaves
            encode_siblings(nodes[i + 1].bounds, nodes[right].bounds, nodes_[packed[i]].planes, symbols_[packed[i]]);
            if (nodes[i + 1].is_leaf()) symbols_[packed[i]] |= leaf_flag(0);
            if (nodes[right].is_leaf()) symbols_[packed[i]] |= leaf_flag(1);
        }
        root_ = nodes[0].bounds;
    }

    /// Recomputes all boxes bottom-up from the mesh, and encodes their planes anew.
    /// @param boxes working memory: the boxes of the internal nodes
    void refit(const mesh& m, std::vector<box>& boxes) {
        boxes.resize(nodes_.size() + leaf_pairs_.size());
        const auto bounds_at = [&](std::size_t parent, std::size_t side) {
            const std::uint32_t child = nodes_[parent].child[side];
            return symbols_[parent] & leaf_flag(side) ? bounds_of(m.triangle(child)) : boxes[child];
        };
        for (std::size_t i = 0; i < leaf_pairs_.size(); ++i)
            boxes[nodes_.size() + i] =
                merged(bounds_of(m.triangle(leaf_pairs_[i][0])), bounds_of(m.triangle(leaf_pairs_[i][1])));
        // Children are stored behind their parents, so that a reverse pass is bottom-up.
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            const box left = bounds_at(i, 0);
            const box right = bounds_at(i, 1);
            boxes[i] = merged(left, right);
            encode_siblings(left, right, nodes_[i].planes, symbols_[i]);
        }
        root_ = boxes.empty() ? bounds_of(m.triangle(0)) : boxes[0];
    }

    [[nodiscard]] inline cursor root(const mesh& m) const noexcept {
        return nodes_.empty() && leaf_pairs_.empty() ? leaf_cursor(0, root_, m) : cursor{root_, 0};
    }
    /// Decodes the boxes of a node's children from its box and planes; nodes above two leaves, which come last, have
    /// none. A leaf gets the box of its parent or, if the leaf test needs it, of its triangle.
    [[nodiscard]] inline std::array<cursor, 2> children(const cursor& at, const mesh& m) const noexcept {
        const auto leaf = [&](std::uint32_t triangle) { return leaf_cursor(triangle, at.bounds, m); };
        if (at.index >= nodes_.size()) {
            const child_pair& pair = leaf_pairs_[at.index - nodes_.size()];
            return {leaf(pair[0]), leaf(pair[1])};
        }
        const node& parent = nodes_[at.index];
        const std::uint8_t symbol = symbols_[at.index];
        const auto [left, right] = decode_siblings(at.bounds, parent.planes, symbol);
        return {symbol & leaf_flag(0) ? leaf(parent.child[0]) : cursor{left, parent.child[0]},
                symbol & leaf_flag(1) ? leaf(parent.child[1]) : cursor{right, parent.child[1]}};
    }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        return {sizeof(root_) + sizeof(sibling_planes) * nodes_.capacity() + symbols_.capacity(),
                sizeof(child_pair) * (nodes_.capacity() + leaf_pairs_.capacity())};
    }

private:
    using child_pair = std::array<std::uint32_t, 2>;
    struct node {
        sibling_planes planes;
        child_pair child;
    };
    static_assert(sizeof(node) == 32);

    box root_{};
    std::vector<node> nodes_;  // depth first
    std::vector<std::uint8_t> symbols_;
    std::vector<child_pair> leaf_pairs_;  // the nodes above two leaves, as triangles
};

static_assert(TreePolicy<compressed_tree>);

}  // namespace aabb
