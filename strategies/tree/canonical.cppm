export module aabb.tree.canonical;

import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// The paper's canonical storage (section 3.2): internal nodes with a box and two child indices, 32 bytes; leaves with
/// a box and a triangle index, 28 bytes. 60 bytes per triangle. When to use: as the baseline of all other layouts.
class canonical_tree {
public:
    static constexpr std::string_view name = "canonical";
    static constexpr std::string_view summary = "internal nodes of 32 bytes, leaves of 28: a box in every node";
    static constexpr bool has_leaf_boxes = true;

    /// The index of an internal node, or with the top bit set that of a leaf.
    using cursor = std::uint32_t;

    /// Lays out internal nodes and leaves in two arrays. packed[i] is the cursor of node i: its index in its array,
    /// with a bit that marks leaves.
    void pack(std::span<const build_node> nodes) {
        internals_.clear();
        leaves_.clear();
        internals_.reserve(nodes.size() / 2);
        leaves_.reserve(nodes.size() / 2 + 1);
        std::vector<cursor> packed(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const bool is_leaf = nodes[i].is_leaf();
            packed[i] = static_cast<cursor>(is_leaf ? leaves_.size() | leaf_bit : internals_.size());
            if (is_leaf)
                leaves_.push_back({nodes[i].bounds, nodes[i].triangle});
            else
                internals_.push_back({nodes[i].bounds, {}});
        }
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!nodes[i].is_leaf()) internals_[packed[i]].child = {packed[i + 1], packed[nodes[i].right]};
    }

    /// Recomputes all boxes bottom-up.
    void refit(const mesh& m, std::vector<box>&) {
        for (leaf& l : leaves_) l.bounds = bounds_of(m.triangle(l.triangle));
        // Children are stored behind their parents, so that a reverse pass is bottom-up.
        for (std::size_t i = internals_.size(); i-- > 0;) {
            internal_node& node = internals_[i];
            node.bounds = merged(bounds(node.child[0]), bounds(node.child[1]));
        }
    }

    [[nodiscard]] inline cursor root(const mesh&) const noexcept { return internals_.empty() ? leaf_bit : 0; }
    [[nodiscard]] static inline bool is_leaf(cursor at) noexcept { return at & leaf_bit; }
    [[nodiscard]] inline std::array<cursor, 2> children(cursor at, const mesh&) const noexcept {
        return internals_[at].child;
    }
    [[nodiscard]] inline const box& bounds(cursor at) const noexcept {
        return is_leaf(at) ? leaves_[at & ~leaf_bit].bounds : internals_[at].bounds;
    }
    [[nodiscard]] inline std::uint32_t triangle(cursor at) const noexcept { return leaves_[at & ~leaf_bit].triangle; }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        return {sizeof(box) * (internals_.capacity() + leaves_.capacity()),
                sizeof(internal_node::child) * internals_.capacity() + sizeof(leaf::triangle) * leaves_.capacity()};
    }

private:
    static constexpr std::uint32_t leaf_bit = 0x80000000;

    struct internal_node {
        box bounds;
        std::array<cursor, 2> child;
    };
    static_assert(sizeof(internal_node) == 32);

    struct leaf {
        box bounds;
        std::uint32_t triangle;
    };
    static_assert(sizeof(leaf) == 28);

    std::vector<internal_node> internals_;  // depth first
    std::vector<leaf> leaves_;
};

static_assert(TreePolicy<canonical_tree>);

}  // namespace aabb
