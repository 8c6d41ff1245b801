export module aabb.tree.quantized;

import aabb.std;
import aabb.tree.leafless_config;
import aabb.tree.quantized_planes;

export namespace aabb {

struct quantized_config : leafless_layout::config {
    unsigned bits = 8;
};

/// Like `compressed`, with quantised planes: there are no leaves, and two siblings share six planes, rounded outward.
/// Boxes are slightly larger than `canonical`'s, and always conservative. Nodes are stored depth first in one byte
/// array, so that only the right child needs an index. A node above two leaves is their triangles, 8 bytes; any other
/// node is an index, the symbol and six codes, 5 + 6 bits / 8 bytes. 8 bits take 9.5 bytes per triangle with paired
/// leaves (`leaf_arrangement::pairs`). When to use: if a binary tree must be small.
class quantized_tree : public leafless_layout {
public:
    static constexpr std::string_view name = "quantized";
    static constexpr std::string_view summary =
        "compressed further: planes of 4 to 16 bits, rounded outward, and one index per two siblings";
    static constexpr leaf_arrangement arrangement = leaf_arrangement::pairs;

    using config = quantized_config;
    static constexpr auto parameters = std::tuple_cat(
        leafless_layout::parameters,
        std::tuple{integer_parameter{"bits", &config::bits, quantized_planes::least_bits, quantized_planes::most_bits,
                                     "bits per plane: fewer take less memory and make boxes larger"}});

    quantized_tree() = default;
    explicit quantized_tree(const config& c) : leafless_layout(c), planes_(c.bits) {}

    /// Lays out the nodes, then encodes them relative to the decoded box of the parent, which comes first. packed[i] is
    /// the first byte of node i, or the triangle of a leaf. A node above two leaves (`pair_bytes`) has two triangles,
    /// marked by `pair_bit`; any other node is a record of an index, a symbol and codes.
    /// @throws input_error if the nodes take more than 2 GiB
    void pack(std::span<const build_node> nodes) {
        // In preorder, the left child of node i is i + 1.
        const auto holds_leaves_only = [&](std::size_t i) {
            return nodes[i + 1].is_leaf() && nodes[nodes[i].right].is_leaf();
        };
        std::vector<std::uint32_t> packed(nodes.size());
        std::size_t end = 0;
        std::size_t records = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            packed[i] = nodes[i].is_leaf() ? nodes[i].triangle : static_cast<std::uint32_t>(end);
            if (nodes[i].is_leaf()) continue;
            records += !holds_leaves_only(i);
            end += holds_leaves_only(i) ? pair_bytes : record_bytes();
            if (end > pair_bit) throw input_error("a quantized tree takes at most 2 GiB; this mesh needs more");
        }
        bytes_.assign(end, {});
        records_ = records;
        root_ = nodes[0].bounds;
        std::vector<box> decoded(nodes.size());
        decoded[0] = root_;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].is_leaf()) continue;
            const std::size_t at = packed[i];
            const std::size_t left = i + 1;
            const std::size_t right = nodes[i].right;
            if (holds_leaves_only(i)) {
                set_word(at, packed[left] | pair_bit);
                set_word(at + word_bytes, packed[right]);
                continue;
            }
            set_word(at, packed[nodes[left].is_leaf() ? left : right]);
            bytes_[at + symbol_offset] = static_cast<std::byte>((nodes[left].is_leaf() ? leaf_flag(0) : 0) |
                                                                (nodes[right].is_leaf() ? leaf_flag(1) : 0));
            const auto boxes = encode(at, decoded[i], nodes[left].bounds, nodes[right].bounds);
            decoded[left] = boxes[0];
            decoded[right] = boxes[1];
        }
    }

    /// Recomputes all boxes bottom-up, and encodes them again from the root down, since codes are relative to parents.
    /// @param boxes working memory: for each block of `pair_bytes` bytes, the box of the node that begins in it
    void refit(const mesh& m, std::vector<box>& boxes) {
        const auto bounds_at = [&](const child& c) {
            return c.is_leaf ? bounds_of(m.triangle(c.index)) : boxes[box_index(c.index)];
        };
        // The reverse pass is bottom-up, but cannot see where nodes begin, since a node above two leaves takes fewer
        // bytes than others. None takes fewer than `pair_bytes`, so at most one begins in each such block: the block's
        // number is that of the node's box, which holds the offset of its first byte in the block until it is computed.
        boxes.assign(box_index(bytes_.size()) + 1, empty_box());
        for (std::size_t at = 0; at < bytes_.size(); at += size_at(at))
            boxes[box_index(at)].min[0] = static_cast<float>(at % pair_bytes);
        for (std::size_t i = boxes.size(); i-- > 0;) {
            if (boxes[i] == empty_box()) continue;
            const auto [left, right] = children_at(i * pair_bytes + static_cast<std::size_t>(boxes[i].min[0]));
            boxes[i] = merged(bounds_at(left), bounds_at(right));
        }
        root_ = bytes_.empty() ? bounds_of(m.triangle(0)) : boxes[0];
        // The forward pass decodes parents before their children and replaces exact boxes by decoded ones.
        for (std::size_t at = 0; at < bytes_.size(); at += size_at(at)) {
            if (is_above_two_leaves(at)) continue;  // it stores no planes, only triangles
            const auto [left, right] = children_at(at);
            const auto decoded = encode(at, boxes[box_index(at)], bounds_at(left), bounds_at(right));
            if (!left.is_leaf) boxes[box_index(left.index)] = decoded[0];
            if (!right.is_leaf) boxes[box_index(right.index)] = decoded[1];
        }
    }

    [[nodiscard]] inline cursor root(const mesh& m) const noexcept {
        return bytes_.empty() ? leaf_cursor(0, root_, m) : cursor{root_, 0};
    }
    /// Decodes the boxes of a node's two children, from the node's box and the planes that it stores; nodes above two
    /// leaves store none. A leaf gets the box of its parent or, if the leaf test needs it, of its triangle.
    [[nodiscard]] inline std::array<cursor, 2> children(const cursor& at, const mesh& m) const noexcept {
        const auto [left, right] = children_at(at.index);
        const auto leaf = [&](std::uint32_t triangle) { return leaf_cursor(triangle, at.bounds, m); };
        if (left.is_leaf && right.is_leaf) return {leaf(left.index), leaf(right.index)};
        const auto boxes = decode(at.index, at.bounds);
        return {left.is_leaf ? leaf(left.index) : cursor{boxes[0], left.index},
                right.is_leaf ? leaf(right.index) : cursor{boxes[1], right.index}};
    }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        const std::size_t planes = records_ * (record_bytes() - word_bytes);
        return {sizeof(root_) + planes, bytes_.capacity() - planes};
    }

private:
    static constexpr std::uint32_t pair_bit = 0x80000000;
    static constexpr std::size_t word_bytes = 4;
    static constexpr std::size_t pair_bytes = 2 * word_bytes;
    static constexpr std::size_t symbol_offset = word_bytes;
    static constexpr std::size_t codes_offset = symbol_offset + 1;
    static_assert(quantized_planes::read_beyond <= pair_bytes);

    struct child {
        std::uint32_t index;  // the child's first byte, or its triangle
        bool is_leaf;
    };

    [[nodiscard]] inline std::size_t record_bytes() const noexcept { return codes_offset + planes_.bytes(); }
    [[nodiscard]] inline std::uint32_t word(std::size_t at) const noexcept {
        std::uint32_t value = 0;
        std::memcpy(&value, &bytes_[at], sizeof value);
        return value;
    }
    void set_word(std::size_t at, std::uint32_t value) noexcept { std::memcpy(&bytes_[at], &value, sizeof value); }
    [[nodiscard]] inline bool is_above_two_leaves(std::size_t at) const noexcept { return word(at) & pair_bit; }
    [[nodiscard]] inline std::size_t size_at(std::size_t at) const noexcept {
        return is_above_two_leaves(at) ? pair_bytes : record_bytes();
    }
    [[nodiscard]] inline unsigned symbol_at(std::size_t at) const noexcept {
        return std::to_integer<unsigned>(bytes_[at + symbol_offset]);
    }
    /// The index of a node's box in a refit: nodes have at least 8 bytes, so that no two begin in the same eight.
    [[nodiscard]] static std::size_t box_index(std::size_t at) noexcept { return at / pair_bytes; }

    /// The children of the node at a byte. It stores one index: the first byte of the right child, or the triangle of
    /// the left one if that is a leaf. The other child is the next node. A node above two leaves stores both triangles.
    [[nodiscard]] inline std::array<child, 2> children_at(std::size_t at) const noexcept {
        const std::uint32_t first = word(at);
        if (first & pair_bit)
            return {child{.index = first & ~pair_bit, .is_leaf = true},
                    child{.index = word(at + word_bytes), .is_leaf = true}};
        const auto next = static_cast<std::uint32_t>(at + record_bytes());
        const unsigned symbol = symbol_at(at);
        if (symbol & leaf_flag(0))
            return {child{.index = first, .is_leaf = true}, child{.index = next, .is_leaf = false}};
        return {child{.index = next, .is_leaf = false}, child{.index = first, .is_leaf = (symbol & leaf_flag(1)) != 0}};
    }

    /// Decodes the children's boxes from their parent's.
    [[nodiscard]] inline std::array<box, 2> decode(std::size_t at, const box& parent) const noexcept {
        return decode_siblings(parent, planes_.decode(parent, &bytes_[at + codes_offset]), symbol_at(at));
    }

    /// Writes the six planes that only one of a node's two children has, as codes relative to the node's box, and the
    /// symbol: a bit per plane says which child has it. The symbol's leaf flags stay.
    /// @returns the children's decoded boxes
    std::array<box, 2> encode(std::size_t at, const box& parent, const box& left, const box& right) noexcept {
        sibling_planes planes{};
        auto symbol = static_cast<std::uint8_t>(symbol_at(at));
        encode_siblings(left, right, planes, symbol);
        bytes_[at + symbol_offset] = static_cast<std::byte>(symbol);
        planes_.encode(parent, planes, &bytes_[at + codes_offset]);
        return decode(at, parent);
    }

    quantized_planes planes_{config{}.bits};
    box root_{};
    std::size_t records_ = 0;  // nodes with planes
    // A node with planes is never the last one, so that reading a few bytes beyond its codes stays in the array.
    std::vector<std::byte> bytes_;
};

static_assert(TreePolicy<quantized_tree>);

}  // namespace aabb
