module;
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

export module aabb:local_detection;

import :counters;
import :geometry;
import :mesh;
import :policy;
import :pose;

export namespace aabb {

/// Decides whether two closed triangles share a point.
template <class R>
concept TrianglePolicy = Strategy<R> && requires(const R policy, const triangle3f& s, const triangle3f& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A triangle test that also takes doubles as they are.
template <class R>
concept DoubleTrianglePolicy = TrianglePolicy<R> && requires(const R policy, const triangle3d& s, const triangle3d& t) {
    { policy.intersects(s, t) } -> std::same_as<bool>;
};

/// A bounding-volume tree over the triangles of a mesh, one triangle a leaf. A cursor stands at a node; what it carries
/// is the layout's own business. `bounds(cursor)` is a box that holds the node's triangles; `has_own_bounds(cursor)`
/// says whether that box is worth a test of its own, or only the parent's again.
template <class T>
concept TreePolicy =
    Strategy<T> && requires(T tree, const T built, const mesh& m, const typename T::cursor at, int side) {
        tree.build(m);
        { built.root(m) } -> std::same_as<typename T::cursor>;
        { built.is_leaf(at) } -> std::same_as<bool>;
        { built.child(at, side, m) } -> std::same_as<typename T::cursor>;
        { built.bounds(at) } -> std::convertible_to<box>;
        { built.has_own_bounds(at) } -> std::same_as<bool>;
        { built.triangle(at) } -> std::same_as<std::uint32_t>;
        { built.bytes() } -> std::same_as<std::size_t>;
    };

/// A mesh with its tree, built once in the mesh's own frame. The mesh must outlive it.
template <TreePolicy Tree>
class model {
public:
    /// @throws input_error on a mesh that `require_valid` refuses.
    explicit model(const mesh& m, Tree tree = {}) : mesh_(&m), tree_(std::move(tree)) {
        require_valid(m);
        tree_.build(m);
    }

    [[nodiscard]] const mesh& triangles() const noexcept { return *mesh_; }
    [[nodiscard]] const Tree& tree() const noexcept { return tree_; }
    [[nodiscard]] box bounds() const { return tree_.bounds(tree_.root(*mesh_)); }

private:
    const mesh* mesh_;
    Tree tree_;
};

/// Local detection (paper, section 3): walks two trees together, box against box, down to pairs of triangles. The work
/// is done in A's frame (`relative_pose`). Nothing is allocated once the stack has grown to the deepest query.
template <TreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters = no_counters>
class local_detection {
    static_assert(detail::is_accepted<detail::sentence_of<Tree, Triangle>()>);

public:
    local_detection()
        requires std::default_initializable<Triangle>
    = default;
    explicit local_detection(Triangle triangle) : triangle_(std::move(triangle)) {}

    /// Appends every pair of intersecting triangles (a of A, b of B), each once, in no particular order.
    void all_pairs(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b,
                   std::vector<index_pair>& pairs) {
        walk(a, pose_a, b, pose_b, [&](index_pair found) {
            pairs.push_back(found);
            return false;
        });
    }

    /// Any one intersecting pair.
    [[nodiscard]] std::optional<index_pair> first_pair(const model<Tree>& a, const pose& pose_a, const model<Tree>& b,
                                                       const pose& pose_b) {
        std::optional<index_pair> first;
        walk(a, pose_a, b, pose_b, [&](index_pair found) {
            first = found;
            return true;
        });
        return first;
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(stack_); }

private:
    using cursor = typename Tree::cursor;

    /// A pair of nodes still to be opened; the box of B's node stands in A's frame.
    struct node_pair {
        cursor a;
        cursor b;
        box b_bounds;
    };

    /// `emit` takes a pair and says whether to stop.
    template <class Emit>
    void walk(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b, Emit emit) {
        const relative_pose to_a(pose_a, pose_b, b.bounds());
        const Tree& tree_a = a.tree();
        const Tree& tree_b = b.tree();
        stack_.clear();
        push_if_near(tree_a, {tree_a.root(a.triangles()), tree_b.root(b.triangles()), to_a(b.bounds())}, true);
        while (!stack_.empty()) {
            const node_pair at = stack_.back();
            stack_.pop_back();
            counters_.add(work::node_visits);
            const bool a_is_leaf = tree_a.is_leaf(at.a);
            const bool b_is_leaf = tree_b.is_leaf(at.b);
            if (a_is_leaf && b_is_leaf) {
                counters_.add(work::triangle_tests);
                const index_pair candidate{tree_a.triangle(at.a), tree_b.triangle(at.b)};
                if (triangle_.intersects(a.triangles().triangle(candidate.a),
                                         to_a(b.triangles().triangle(candidate.b))) &&
                    emit(candidate))
                    return;
            } else if (b_is_leaf || (!a_is_leaf && length(tree_a.bounds(at.a)) >= length(at.b_bounds))) {
                for (int side = 1; side >= 0; --side) {
                    const cursor child = tree_a.child(at.a, side, a.triangles());
                    push_if_near(tree_a, {child, at.b, at.b_bounds}, tree_a.has_own_bounds(child));
                }
            } else {
                for (int side = 1; side >= 0; --side) {
                    const cursor child = tree_b.child(at.b, side, b.triangles());
                    const bool own = tree_b.has_own_bounds(child);
                    push_if_near(tree_a, {at.a, child, own ? to_a(tree_b.bounds(child)) : at.b_bounds}, own);
                }
            }
        }
    }

    /// `worth_testing`: one of the boxes has not been tested against the other yet.
    void push_if_near(const Tree& tree_a, const node_pair& next, bool worth_testing) {
        if (worth_testing) {
            counters_.add(work::box_tests);
            if (!overlaps(tree_a.bounds(next.a), next.b_bounds)) return;
        }
        stack_.push_back(next);
    }

    /// Of two nodes the longer one is opened first.
    [[nodiscard]] static float length(const box& b) noexcept {
        const int k = longest_axis(b);
        return b.max[k] - b.min[k];
    }

    [[no_unique_address]] Triangle triangle_;
    [[no_unique_address]] Counters counters_;
    std::vector<node_pair> stack_;
};

}  // namespace aabb
