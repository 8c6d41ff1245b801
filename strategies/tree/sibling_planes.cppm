export module aabb.tree.sibling_planes;

export import aabb.geometry;
import aabb.std;

export namespace aabb {

/// A position in a tree that does not store its nodes' boxes directly: the cursor carries the box.
struct box_cursor {
    static constexpr std::uint32_t leaf_bit = 0x80000000;

    box bounds;
    std::uint32_t index;  ///< of an internal node, or with the top bit set of a leaf or triangle

    [[nodiscard]] constexpr bool is_leaf() const noexcept { return index & leaf_bit; }
    [[nodiscard]] constexpr std::uint32_t leaf() const noexcept { return index & ~leaf_bit; }
};

/// The boxes of two siblings, lossless in six floats and six bits (paper, section 3.2, applied to both children of a
/// node at once). At least one child inherits each plane of the parent's box; the record stores the other child's
/// plane. The order is that of `box`: three lower planes, then three upper planes.
struct sibling_planes {
    std::array<float, 6> own;
};
static_assert(sizeof(sibling_planes) == 24);

/// Bit k of the symbol is set if the right child inherits the parent's plane k and the left child has its own.
inline constexpr std::uint8_t plane_bits = 0b11'1111;

/// The other two bits mark the left and the right child as leaves.
[[nodiscard]] constexpr std::uint8_t leaf_flag(std::size_t side) noexcept {
    return static_cast<std::uint8_t>(64U << side);
}

/// Encodes two siblings. Their union is the parent's box: a child inherits each of its planes, so only the other
/// child's is stored. Bit k of the symbol is set if the left child has its own plane k; the symbol's leaf flags stay.
constexpr void encode_siblings(const box& left, const box& right, sibling_planes& planes,
                               std::uint8_t& symbol) noexcept {
    symbol &= static_cast<std::uint8_t>(~plane_bits);
    for (int k = 0; k < 3; ++k) {
        const auto low = static_cast<std::size_t>(k);
        if (left.min[k] > right.min[k]) symbol |= static_cast<std::uint8_t>(1U << low);
        if (left.max[k] < right.max[k]) symbol |= static_cast<std::uint8_t>(8U << low);
        planes.own[low] = std::max(left.min[k], right.min[k]);
        planes.own[low + 3] = std::min(left.max[k], right.max[k]);
    }
}

/// Decodes two siblings, the left one first. Bit k of the symbol is set if the left child has its own plane k.
[[nodiscard]] constexpr std::array<box, 2> decode_siblings(const box& parent, const sibling_planes& planes,
                                                           unsigned symbol) noexcept {
    std::array<box, 2> boxes{};
    for (int k = 0; k < 3; ++k) {
        const auto low = static_cast<std::size_t>(k);
        const bool left_owns_lower = symbol >> low & 1;
        const bool left_owns_upper = symbol >> (low + 3) & 1;
        boxes[0].min[k] = left_owns_lower ? planes.own[low] : parent.min[k];
        boxes[1].min[k] = left_owns_lower ? parent.min[k] : planes.own[low];
        boxes[0].max[k] = left_owns_upper ? planes.own[low + 3] : parent.max[k];
        boxes[1].max[k] = left_owns_upper ? parent.max[k] : planes.own[low + 3];
    }
    return boxes;
}

}  // namespace aabb
