export module aabb.local_detection:policies;

import aabb.geometry;
import aabb.policy;
import aabb.std;

export namespace aabb {

/// Node of a binary tree before a layout packs it. Nodes stand depth first: the left child of an internal node is next.
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
struct tree_builder {
    std::function<std::vector<build_node>(const mesh& m, leaf_arrangement arrangement)> build;
    std::function<balanced_order(const mesh& m)> order;
};

template <BuildPolicy Build>
[[nodiscard]] tree_builder built_by(const Build& by = {}) {
    return {[by](const mesh& m, leaf_arrangement arrangement) { return by.build(m, arrangement); },
            [by](const mesh& m) { return by.order(m); }};
}

/// What is tested in place of the box of a leaf that has none.
enum class leaf_test_choice : std::uint8_t {
    none,                ///< nothing: the triangles are tested at once
    triangle_box,        ///< the leaf's triangle against the other node's box, `triangle_meets_box`
    triangle_aabb,       ///< the triangle's own box, made on the fly
    moller_triangle_box  ///< as `triangle_box`, but Möller's original, which loses pairs that touch
};

/// What a walk is for: with `first_pair` it is stopped at the first.
enum class walk_goal : std::uint8_t { every_pair, first_pair };

/// Bytes of a tree, as allocated; the box of the root counts where the other boxes are made from it.
struct tree_bytes {
    std::size_t nodes;    ///< boxes, planes and symbols
    std::size_t indices;  ///< of children and triangles

    [[nodiscard]] constexpr std::size_t all() const noexcept { return nodes + indices; }
};

/// Whether a layout packs an order of triangles, not nodes.
template <class T>
concept BalancedTree = requires(T tree, const mesh& m, const balanced_order& order) { tree.pack(m, order); };

/// A bounding-volume tree over the triangles of a mesh, one triangle a leaf: a layout, which packs the nodes or
/// the order that a build made. One that wants leaves at certain places says `static constexpr leaf_arrangement
/// arrangement`. A cursor stands at a node; what it carries is the layout's own business. `bounds(cursor)` is a box
/// that holds the node's triangles; that of a leaf in a layout without leaf boxes is its parent's, or what
/// `leaf_test()` asks for. `refit` takes a mesh of the same triangles whose vertices have moved; it uses the boxes as
/// scratch. Trees are walked by `depth_first_walk`, but where a layout names another way: `template <class Triangle,
/// class Counters> using walk`.
template <class T>
concept TreePolicy =
    Strategy<T> && (BalancedTree<T> || requires(T tree, std::span<const build_node> nodes) { tree.pack(nodes); }) &&
    requires(T tree, const T built, const mesh& m, const typename T::cursor at, std::vector<box>& boxes) {
        tree.refit(m, boxes);
        { built.root(m) } -> std::same_as<typename T::cursor>;
        { built.is_leaf(at) } -> std::same_as<bool>;
        { built.children(at, m) } -> std::same_as<std::array<typename T::cursor, 2>>;
        { built.bounds(at) } -> std::convertible_to<box>;
        { built.triangle(at) } -> std::same_as<std::uint32_t>;
        { built.bytes() } -> std::same_as<tree_bytes>;
        { T::has_leaf_boxes } -> std::convertible_to<bool>;
    } && (T::has_leaf_boxes || requires(const T built) {
        { built.leaf_test() } -> std::same_as<leaf_test_choice>;
    });

/// How the nodes of a tree are to be built for it.
template <TreePolicy T>
inline constexpr leaf_arrangement leaf_arrangement_of = [] {
    if constexpr (requires { T::arrangement; })
        return T::arrangement;
    else
        return leaf_arrangement::any;
}();

/// Decides whether two closed triangles share a point. One that is always right may say `static constexpr bool filtered
/// = true`: where many pairs come at once, a filter may then decide on most of them.
template <class R>
concept TrianglePolicy = Strategy<R> && requires(const R policy, const triangle3f& s, const triangle3f& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A triangle test that also takes doubles as they are.
template <class R>
concept DoubleTrianglePolicy = TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A triangle test that also constructs what two triangles have in common, those of floats taken in double.
template <class R>
concept ConstructingTrianglePolicy =
    TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
        { policy.intersection(s, t) } -> std::same_as<triangle_intersection>;
    };

}  // namespace aabb
