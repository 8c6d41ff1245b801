export module aabb.local_detection:build_policy;

import aabb.base;
import aabb.geometry;
import aabb.policy;
import aabb.std;

export namespace aabb {

/// Node of a binary tree before a layout packs it. Nodes stand in depth-first order: the left child of an internal node
/// is the next node.
struct build_node {
    box bounds;
    std::uint32_t right;     ///< index of the right child; 0 in a leaf
    std::uint32_t triangle;  ///< index of the triangle in a leaf

    [[nodiscard]] bool is_leaf() const noexcept { return right == 0; }
};

/// A triangle on its way into a tree.
struct build_element {
    box bounds;
    vec3f centroid;
    std::uint32_t triangle;
};

/// Where a layout wants leaves to be. `pairs`: a node of an even number of triangles has two children of even numbers;
/// the split moves by one triangle where it must. For layouts in which a leaf beside an internal node wastes memory.
enum class leaf_arrangement : std::uint8_t { any, pairs };

/// How a node's triangles are split: in the order of their centroids along an axis (and of their indices where those
/// are equal), or as they stand, the first `left` go to the left.
struct split_choice {
    static constexpr int as_they_stand = -1;

    int axis;
    std::size_t left;
};

/// The triangles of a mesh in the order of the leaves of a balanced tree, eight a leaf: of more than eight, as many go
/// to the left as the greatest power of two below their number. For layouts in which places follow from numbers.
struct balanced_order {
    static constexpr std::size_t leaf_triangles = 8;

    large_vector<std::uint32_t> triangles;  ///< by place
    large_vector<box> bounds;               ///< of the triangles of each leaf
    std::uint32_t threads = 1;              ///< how many may pack it
};

/// The mesh with its triangles in this order, and its vertices in the order in which these come upon them; those of
/// none stand last. What is near in space is then near in memory, and a layout need not say which triangle stands
/// where.
[[nodiscard]] inline mesh in_leaf_order(const mesh& m, const balanced_order& order) {
    constexpr std::uint32_t unseen = 0xffffffff;
    std::vector<std::uint32_t> number(m.vertices.size(), unseen);
    mesh made;
    made.vertices.reserve(m.vertices.size());
    made.triangles.reserve(m.triangles.size());
    const auto place = [&](std::uint32_t v) {
        if (number[v] == unseen) {
            number[v] = static_cast<std::uint32_t>(made.vertices.size());
            made.vertices.push_back(m.vertices[v]);
        }
        return number[v];
    };
    for (const std::uint32_t t : order.triangles) {
        std::array<std::uint32_t, 3> corners = m.triangles[t];
        for (std::uint32_t& v : corners) v = place(v);
        made.triangles.push_back(corners);
    }
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v) static_cast<void>(place(v));
    return made;
}

/// Makes what a layout packs: a binary tree, in which n triangles give n - 1 internal nodes, one triangle a leaf, in
/// the order that `build_node` says; or the order of triangles in a balanced tree. Boxes are the smallest ones. The
/// same for the same mesh on every machine; it ends on any mesh that `require_valid` accepts, however many centroids
/// are equal.
template <class B>
concept TreeBuilder = requires(const B builder, const mesh& m, leaf_arrangement arrangement) {
    { builder.build(m, arrangement) } -> std::same_as<std::vector<build_node>>;
    { builder.order(m) } -> std::same_as<balanced_order>;
};

template <class B>
concept BuildPolicy = Strategy<B> && TreeBuilder<B>;

/// A build whose type is not known where it is used: layouts are compiled apart from builds.
class tree_builder {
public:
    tree_builder() = default;
    tree_builder(const tree_builder&) = delete;
    tree_builder& operator=(const tree_builder&) = delete;
    virtual ~tree_builder() = default;

    [[nodiscard]] virtual std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const = 0;
    [[nodiscard]] virtual balanced_order order(const mesh& m) const = 0;
};

template <BuildPolicy Build>
class built_by final : public tree_builder {
public:
    explicit built_by(Build build = {}) : build_(std::move(build)) {}
    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const override {
        return build_.build(m, arrangement);
    }
    [[nodiscard]] balanced_order order(const mesh& m) const override { return build_.order(m); }

private:
    [[no_unique_address]] Build build_;
};

}  // namespace aabb
