export module aabb.tree.compressed_literal;

import aabb.std;
import aabb.tree.leafless_config;

export namespace aabb {

/// The paper's table 1 to the letter: every internal node stores three planes, two child indices and a symbol byte; it
/// inherits the other three planes from its parent. A node that differs from its parent in more than three planes keeps
/// those that make its box smallest: boxes stay conservative, but some are larger than `canonical`'s. There are no
/// leaves; 21 bytes per triangle. When to use: to measure what the literal table 1 costs.
class compressed_literal_tree : public leafless_layout {
public:
    static constexpr std::string_view name = "compressed_literal";
    static constexpr std::string_view summary =
        "table 1 of the paper to the letter: three planes per node, the rest from its parent, some boxes larger";

    using leafless_layout::leafless_layout;

    /// Lays out the internal nodes in preorder of their parents, siblings side by side, and encodes each box relative
    /// to its parent's. packed[i] is the new index of node i, or the triangle of a leaf.
    void pack(std::span<const build_node> nodes) {
        nodes_.assign(nodes.size() / 2, {});
        symbols_.assign(nodes_.size(), 0);
        std::vector<std::uint32_t> packed(nodes.size());
        std::uint32_t next = 1;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].is_leaf()) continue;
            const std::array children{i + 1, std::size_t{nodes[i].right}};
            for (std::size_t side = 0; side < 2; ++side) {
                const build_node& child = nodes[children[side]];
                packed[children[side]] = child.is_leaf() ? child.triangle : next++;
                nodes_[packed[i]].child[side] = packed[children[side]];
                if (child.is_leaf()) symbols_[packed[i]] |= leaf_flag(side);
            }
        }
        root_ = nodes[0].bounds;
        std::vector<box> boxes(nodes_.size());
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!nodes[i].is_leaf()) boxes[packed[i]] = nodes[i].bounds;
        encode(boxes);
    }

    /// Recomputes all boxes bottom-up from the mesh, and encodes them anew.
    /// @param boxes working memory: the boxes of the internal nodes
    void refit(const mesh& m, std::vector<box>& boxes) {
        boxes.resize(nodes_.size());
        const auto bounds_at = [&](std::size_t parent, std::size_t side) {
            const std::uint32_t child = nodes_[parent].child[side];
            return holds_leaf(parent, side) ? bounds_of(m.triangle(child)) : boxes[child];
        };
        // Children are stored behind their parents, so that a reverse pass is bottom-up.
        for (std::size_t i = nodes_.size(); i-- > 0;) boxes[i] = merged(bounds_at(i, 0), bounds_at(i, 1));
        root_ = boxes.empty() ? bounds_of(m.triangle(0)) : boxes[0];
        encode(boxes);
    }

    [[nodiscard]] inline cursor root(const mesh& m) const noexcept {
        return nodes_.empty() ? leaf_cursor(0, root_, m) : cursor{root_, 0};
    }
    /// Decodes the boxes of a node's two children, from the node's box and the planes that each child stores. A leaf
    /// gets the box of its parent or, if the leaf test needs it, of its triangle.
    [[nodiscard]] inline std::array<cursor, 2> children(const cursor& at, const mesh& m) const noexcept {
        const auto child = [&](std::size_t side) {
            const std::uint32_t index = nodes_[at.index].child[side];
            if (holds_leaf(at.index, side)) return leaf_cursor(index, at.bounds, m);
            return cursor{decoded(at.bounds, nodes_[index].planes, symbols_[index]), index};
        };
        return {child(0), child(1)};
    }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        return {sizeof(root_) + sizeof(node::planes) * nodes_.capacity() + symbols_.capacity(),
                sizeof(node::child) * nodes_.capacity()};
    }

private:
    using three_planes = std::array<float, 3>;
    struct node {
        three_planes planes;
        std::array<std::uint32_t, 2> child;
    };
    static_assert(sizeof(node) == 20);

    [[nodiscard]] inline bool holds_leaf(std::size_t parent, std::size_t side) const noexcept {
        return symbols_[parent] & leaf_flag(side);
    }

    /// The planes of a box in the order of the symbol's bits: three lower planes, then three upper planes.
    [[nodiscard]] static constexpr float& plane(box& b, unsigned k) noexcept {
        return k < 3 ? b.min[static_cast<int>(k)] : b.max[static_cast<int>(k) - 3];
    }

    /// The parent's box, in which `planes` replace those whose bits are set, in order.
    [[nodiscard]] static constexpr box decoded(const box& parent, const three_planes& planes,
                                               unsigned symbol) noexcept {
        box result = parent;
        std::size_t used = 0;
        for (unsigned k = 0; k < 6; ++k)
            if (symbol >> k & 1) plane(result, k) = planes[used++];
        return result;
    }

    /// @param exact the box of each internal node; replaced by the decoded boxes.
    void encode(std::vector<box>& exact) noexcept {
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            for (std::size_t side = 0; side < 2; ++side)
                if (!holds_leaf(i, side)) encode_child(nodes_[i].child[side], exact[i], exact[nodes_[i].child[side]]);
    }

    /// Encodes a node: of its six planes, keeps the three that make the smallest box; the other three are its parent's.
    /// The symbol has a bit for each plane that is kept.
    /// @param bounds the exact box, which the decoded one replaces
    void encode_child(std::size_t at, const box& parent, box& bounds) noexcept {
        double least = std::numeric_limits<double>::infinity();
        box best = parent;
        for (unsigned bits = 0; bits <= plane_bits; ++bits) {
            if (std::popcount(bits) != 3) continue;
            three_planes planes{};
            std::size_t used = 0;
            for (unsigned k = 0; k < 6; ++k)
                if (bits >> k & 1) planes[used++] = plane(bounds, k);
            const box candidate = decoded(parent, planes, bits);
            // A flat box may have the same area as the exact one without being equal to it.
            const double area = candidate == bounds ? -1 : surface_area(candidate);
            if (area < least) {
                least = area;
                best = candidate;
                nodes_[at].planes = planes;
                symbols_[at] = static_cast<std::uint8_t>((symbols_[at] & ~plane_bits) | bits);
            }
        }
        bounds = best;
    }

    box root_{};
    std::vector<node> nodes_;
    std::vector<std::uint8_t> symbols_;
};

static_assert(TreePolicy<compressed_literal_tree>);

}  // namespace aabb
