export module aabb.local_detection:policies;

import aabb.geometry;
import aabb.policy;
import aabb.std;

export namespace aabb {

/// A node of a binary BVH before a layout packs it, in preorder: the left child directly follows an internal node.
struct build_node {
    box bounds;
    std::uint32_t right;     ///< index of the right child; 0 in a leaf
    std::uint32_t triangle;  ///< index of the triangle in a leaf; not read in internal nodes

    [[nodiscard]] bool is_leaf() const noexcept { return right == 0; }
};

/// A triangle during the build of a tree.
struct build_element {
    box bounds;
    vec3f centroid;
    std::uint32_t triangle;
};

/// The arrangement of leaves that a layout requires. `pairs`: the children of a node with an even number of triangles
/// have even numbers, for which the split moves by one triangle if necessary. This is for layouts in which a leaf
/// beside an internal node wastes memory.
enum class leaf_arrangement : std::uint8_t { any, pairs };

/// The split of a node: the first `left` triangles go to the left, in the order of their centroids along an axis (of
/// their indices if these are equal), or in their current order.
struct split_choice {
    static constexpr int in_current_order = -1;

    int axis;
    std::size_t left;
};

/// The triangles of a mesh in the order of the leaves of a balanced tree, eight per leaf: of more than eight triangles,
/// the greatest power of two below their number goes to the left. For layouts with implicit child indices.
struct balanced_order {
    static constexpr std::size_t leaf_triangles = 8;

    large_vector<std::uint32_t> triangles;  ///< index of the triangle in each place
    large_vector<box> bounds;               ///< box of each leaf
    std::uint32_t threads = 1;              ///< number of threads that may pack it
};

/// A copy of a mesh with triangles in the order of a tree's leaves, and vertices in the order of their use, unused ones
/// last: neighbours in space become neighbours in memory, and a layout need not store triangle indices.
[[nodiscard]] inline mesh in_leaf_order(const mesh& m, const balanced_order& order) {
    constexpr std::uint32_t unseen = 0xffffffff;
    std::vector<std::uint32_t> new_index(m.vertices.size(), unseen);
    mesh reordered;
    reordered.frame = m.frame;
    reordered.vertices.reserve(m.vertices.size());
    reordered.given.reserve(m.given.size());
    reordered.triangles.reserve(m.triangles.size());
    const auto place = [&](std::uint32_t v) {
        if (new_index[v] == unseen) {
            new_index[v] = static_cast<std::uint32_t>(reordered.vertices.size());
            reordered.vertices.push_back(m.vertices[v]);
            if (!m.given.empty()) reordered.given.push_back(m.given[v]);  // the vertex before rounding to floats
        }
        return new_index[v];
    };
    for (const std::uint32_t t : order.triangles) {
        std::array<std::uint32_t, 3> corners = m.triangles[t];
        for (std::uint32_t& v : corners) v = place(v);
        reordered.triangles.push_back(corners);
    }
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v) static_cast<void>(place(v));
    return reordered;
}

/// Builds what a layout packs: a binary tree with one triangle per leaf and n - 1 internal nodes for n triangles, in
/// the preorder of `build_node`; or the order of triangles in a balanced tree. Boxes are tight. The result is
/// deterministic across machines, and building ends on any mesh that `require_valid` accepts, equal centroids included.
template <class B>
concept TreeBuilder = requires(const B builder, const mesh& m, leaf_arrangement arrangement) {
    { builder.build(m, arrangement) } -> std::same_as<std::vector<build_node>>;
    { builder.order(m) } -> std::same_as<balanced_order>;
};

template <class B>
concept BuildPolicy = Strategy<B> && TreeBuilder<B>;

/// A type-erased builder, since layouts are compiled separately from builders.
struct tree_builder {
    std::function<std::vector<build_node>(const mesh& m, leaf_arrangement arrangement)> build;
    std::function<balanced_order(const mesh& m)> order;
};

/// Erases the type of a builder, which is copied into the result.
template <BuildPolicy Build>
[[nodiscard]] tree_builder as_tree_builder(const Build& builder = {}) {
    return {[builder](const mesh& m, leaf_arrangement arrangement) { return builder.build(m, arrangement); },
            [builder](const mesh& m) { return builder.order(m); }};
}

/// The test that replaces the box test of a leaf without a box.
enum class leaf_test_choice : std::uint8_t {
    none,                ///< no test: the triangles are tested at once
    triangle_box,        ///< the leaf's triangle against the other node's box, `triangle_meets_box`
    triangle_aabb,       ///< the triangle's box, computed on the fly
    moller_triangle_box  ///< Akenine-Möller's original `triangle_box`, with false negatives for touching pairs
};

/// The goal of a traversal; with `first_pair` it stops at the first pair.
enum class walk_goal : std::uint8_t { every_pair, first_pair };

/// Allocated bytes of a tree; the root's box counts if other boxes are relative to it.
struct tree_bytes {
    std::size_t nodes;    ///< boxes, planes and symbols
    std::size_t indices;  ///< indices of children and triangles
};

/// A layout that packs an order of triangles instead of nodes.
template <class T>
concept BalancedTree = requires(T tree, const mesh& m, const balanced_order& order) { tree.pack(m, order); };

/// A BVH over the triangles of a mesh with one triangle per leaf: a layout that packs the nodes or the order of a
/// builder. A layout that requires an arrangement of leaves declares `static constexpr leaf_arrangement arrangement`. A
/// cursor refers to a node; its content is private to the layout. `bounds(cursor)` is a box that contains the node's
/// triangles; for a leaf in a layout without leaf boxes, it is the parent's box, or what `leaf_test()` requires.
/// `refit` takes the same mesh after its vertices have moved, and uses the boxes as scratch memory. Trees are traversed
/// by `depth_first_walk` unless a layout declares `template <class Triangle, class Counters> using walk`, and searched
/// by `each_triangle_in`.
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

template <TreePolicy T>
inline constexpr leaf_arrangement leaf_arrangement_of = [] {
    if constexpr (requires { T::arrangement; })
        return T::arrangement;
    else
        return leaf_arrangement::any;
}();

/// Decides whether two closed triangles share a point. An exact test may declare `static constexpr bool filtered =
/// true`, so that a floating-point filter decides most pairs of a batch.
template <class R>
concept TrianglePolicy = Strategy<R> && requires(const R policy, const triangle3f& s, const triangle3f& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A triangle test that also takes triangles of doubles without rounding.
template <class R>
concept DoubleTrianglePolicy = TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// An exact triangle test that also decides on triangles of meshes at poses, in world coordinates that are not rounded.
template <class R>
concept PosedTrianglePolicy = DoubleTrianglePolicy<R> && requires(const R policy, const pose_pair& poses,
                                                                  const triangle3d& s, const triangle3d& t) {
    { policy.intersects(poses, s, t) } -> std::same_as<bool>;
};

/// A triangle test that also constructs the intersection of two triangles; floats are converted to double.
template <class R>
concept ConstructingTrianglePolicy =
    TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
        { policy.intersection(s, t) } -> std::same_as<triangle_intersection>;
    };

}  // namespace aabb
