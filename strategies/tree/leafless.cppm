module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

export module aabb.tree.leafless;

import aabb;

export namespace aabb {

/// The canonical internal node without leaves: a leaf's triangle index stands in its parent where the node index stood
/// (paper, section 3.2, one half of the compression). About 32 bytes a triangle. When to use: as the half-step between
/// `canonical` and `compressed`.
class leafless_tree {
public:
    static constexpr std::string_view name = "leafless";
    static constexpr std::string_view summary =
        "internal nodes of 32 bytes, no leaves: triangle indices stand in the parent";

    static constexpr std::string_view leaves_out = "no leaves: no boxes of single triangles";

    enum class leaf_test_choice : std::uint8_t { none, triangle_aabb };
    struct config {
        /// What is tested in place of the removed leaf box. none: nothing, the triangles are tested at once, as the
        /// paper says. triangle_aabb: the triangle's own box, made on the fly.
        leaf_test_choice leaf_test = leaf_test_choice::none;
    };
    static constexpr std::tuple parameters{choice_parameter{"leaf_test", &config::leaf_test,
                                                            std::array<std::string_view, 2>{"none", "triangle_aabb"},
                                                            "what is tested in place of a leaf's box"}};

    leafless_tree() = default;
    explicit leafless_tree(const config& c) : config_(c) {}

    /// A node and the box to test for it. `index` is a triangle when the top bit is set, else an internal node.
    struct cursor {
        box bounds;
        std::uint32_t index;
    };

    void build(const mesh& m) {
        nodes_.clear();
        nodes_.reserve(m.triangles.size() - 1);
        const std::vector<build_node> nodes = build_balanced(m);
        std::vector<std::uint32_t> packed(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            packed[i] = nodes[i].is_leaf() ? nodes[i].triangle | leaf_bit : static_cast<std::uint32_t>(nodes_.size());
            if (!nodes[i].is_leaf()) nodes_.push_back({nodes[i].bounds, {}});
        }
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!nodes[i].is_leaf()) {
                nodes_[packed[i]].child[0] = packed[i + 1];
                nodes_[packed[i]].child[1] = packed[nodes[i].right];
            }
    }

    [[nodiscard]] cursor root(const mesh& m) const noexcept {
        return nodes_.empty() ? cursor{bounds_of(m.triangle(0)), leaf_bit} : cursor{nodes_[0].bounds, 0};
    }
    [[nodiscard]] static bool is_leaf(const cursor& at) noexcept { return at.index & leaf_bit; }
    [[nodiscard]] cursor child(const cursor& at, int side, const mesh& m) const noexcept {
        const std::uint32_t index = nodes_[at.index].child[side];
        if (!(index & leaf_bit)) return {nodes_[index].bounds, index};
        return {has_leaf_test() ? bounds_of(m.triangle(index & ~leaf_bit)) : at.bounds, index};
    }
    [[nodiscard]] static const box& bounds(const cursor& at) noexcept { return at.bounds; }
    [[nodiscard]] bool has_own_bounds(const cursor& at) const noexcept { return !is_leaf(at) || has_leaf_test(); }
    [[nodiscard]] static std::uint32_t triangle(const cursor& at) noexcept { return at.index & ~leaf_bit; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(nodes_); }

private:
    static constexpr std::uint32_t leaf_bit = 0x80000000;

    [[nodiscard]] bool has_leaf_test() const noexcept { return config_.leaf_test == leaf_test_choice::triangle_aabb; }

    struct node {
        box bounds;
        std::uint32_t child[2];
    };
    static_assert(sizeof(node) == 32);

    config config_;
    std::vector<node> nodes_;
};

static_assert(TreePolicy<leafless_tree>);

}  // namespace aabb
