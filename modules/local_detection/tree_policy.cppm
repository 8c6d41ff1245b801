export module aabb.local_detection:tree_policy;

import aabb.geometry;
import aabb.policy;
import aabb.std;
import :build_policy;

export namespace aabb {

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

}  // namespace aabb
