export module aabb.tree.shared_planes;

import aabb.local_detection;
import aabb.std;
import aabb.tree.sibling_planes;

export namespace aabb {

/// Shared planes with leaves: each internal node stores the six planes that its two children do not inherit, so that
/// all boxes, including those of leaves, are lossless (paper, section 3.2, the other half of the compression). 37 bytes
/// per triangle. When to use: as the intermediate step between `canonical` and `compressed`.
class shared_planes_tree {
public:
    static constexpr std::string_view name = "shared_planes";
    static constexpr std::string_view summary = "leaves kept, planes shared: six floats and six bits per two siblings";
    static constexpr bool has_leaf_boxes = true;

    using cursor = box_cursor;

    /// Lays out internal nodes and leaves in two arrays, and encodes the planes of each two siblings. packed[i] is the
    /// index of node i in its array.
    void pack(std::span<const build_node> nodes) {
        const std::size_t internals = nodes.size() / 2;  // a binary tree of n leaves has n - 1
        nodes_.assign(internals, {});
        symbols_.assign(internals, 0);
        leaves_.clear();
        leaves_.reserve(internals + 1);
        std::vector<std::uint32_t> packed(nodes.size());
        std::uint32_t internal = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            packed[i] = nodes[i].is_leaf() ? static_cast<std::uint32_t>(leaves_.size()) : internal++;
            if (nodes[i].is_leaf()) leaves_.push_back(nodes[i].triangle);
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].is_leaf()) continue;
            const std::array children{i + 1, std::size_t{nodes[i].right}};  // nodes are in preorder
            for (std::size_t side = 0; side < 2; ++side) {
                nodes_[packed[i]].child[side] = packed[children[side]];
                if (nodes[children[side]].is_leaf()) symbols_[packed[i]] |= leaf_flag(side);
            }
            encode_siblings(nodes[children[0]].bounds, nodes[children[1]].bounds, nodes_[packed[i]].planes,
                            symbols_[packed[i]]);
        }
        root_ = nodes[0].bounds;
    }

    /// Recomputes all boxes bottom-up, and encodes the planes of each two siblings anew. A node's symbol says which
    /// child has which of these planes (the other child inherits its parent's), and which children are leaves.
    /// @param boxes working memory: the boxes of the internal nodes
    void refit(const mesh& m, std::vector<box>& boxes) {
        boxes.resize(nodes_.size());
        const auto bounds_at = [&](std::size_t parent, std::size_t side) {
            const std::uint32_t child = nodes_[parent].child[side];
            return symbols_[parent] & leaf_flag(side) ? bounds_of(m.triangle(leaves_[child])) : boxes[child];
        };
        // Children are stored behind their parents, so that a reverse pass is bottom-up.
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            const box left = bounds_at(i, 0);
            const box right = bounds_at(i, 1);
            boxes[i] = merged(left, right);
            encode_siblings(left, right, nodes_[i].planes, symbols_[i]);
        }
        root_ = nodes_.empty() ? bounds_of(m.triangle(0)) : boxes[0];
    }

    [[nodiscard]] inline cursor root(const mesh&) const noexcept {
        return {root_, nodes_.empty() ? cursor::leaf_bit : 0};
    }
    [[nodiscard]] static inline bool is_leaf(const cursor& at) noexcept { return at.is_leaf(); }
    /// Decodes the boxes of a node's two children, from the node's box and the planes that it stores.
    [[nodiscard]] inline std::array<cursor, 2> children(const cursor& at, const mesh&) const noexcept {
        const node& parent = nodes_[at.index];
        const std::uint32_t symbol = symbols_[at.index];
        const auto [left, right] = decode_siblings(at.bounds, parent.planes, symbol);
        // The leaf flags are the two top bits of the symbol.
        return {cursor{left, parent.child[0] | (symbol << 25 & cursor::leaf_bit)},
                cursor{right, parent.child[1] | (symbol << 24 & cursor::leaf_bit)}};
    }
    [[nodiscard]] static inline const box& bounds(const cursor& at) noexcept { return at.bounds; }
    [[nodiscard]] inline std::uint32_t triangle(const cursor& at) const noexcept { return leaves_[at.leaf()]; }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        return {sizeof(root_) + sizeof(sibling_planes) * nodes_.capacity() + symbols_.capacity(),
                sizeof(node::child) * nodes_.capacity() + sizeof(std::uint32_t) * leaves_.capacity()};
    }

private:
    struct node {
        sibling_planes planes;
        std::array<std::uint32_t, 2> child;
    };
    static_assert(sizeof(node) == 32);

    box root_{};
    std::vector<node> nodes_;  // depth first
    std::vector<std::uint8_t> symbols_;
    std::vector<std::uint32_t> leaves_;  // triangles
};

static_assert(TreePolicy<shared_planes_tree>);

}  // namespace aabb
