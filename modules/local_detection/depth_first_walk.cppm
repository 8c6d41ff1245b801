module;
#include <cassert>

export module aabb.local_detection:depth_first_walk;

import aabb.counters;
import aabb.std;
import :model;
import :triangle_query;

export namespace aabb {

/// Simultaneous depth-first traversal of two BVHs (paper, section 3), which opens the longer of two nodes first.
template <TreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class depth_first_walk {
public:
    using query = triangle_query<Tree, Triangle>;

    /// Passes each pair of intersecting triangles (a of A, b of B) to `emit` as a list of one, until it returns true.
    template <class Emit>
    void find_pairs(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                    walk_goal /*goal*/, Emit emit) {
        begin(test.image_error());
        push_if_overlapping(a, b, to_a, {a.root(), b.root(), to_a(b.bounds())}, new_node::both);
        static_cast<void>(test_pending(test, a, b, to_a, emit));
    }

    /// Passes each pair of intersecting triangles of one mesh to `emit`, in either order, until it returns true. Any
    /// two triangles lie below different children of exactly one node, so each node's children are traversed together.
    template <class Emit>
    void find_self_pairs(const query& test, const model<Tree>& m, Emit emit) {
        constexpr same_frame identity;
        begin(test.image_error());
        nodes_.assign(1, m.root());
        while (!nodes_.empty()) {
            const cursor node = nodes_.back();
            nodes_.pop_back();
            if (m.tree().is_leaf(node)) continue;
            const auto [left, right] = m.tree().children(node, m.triangles());
            nodes_.push_back(left);
            nodes_.push_back(right);
            push_if_overlapping(m, m, identity, {left, right, m.tree().bounds(right)}, new_node::both);
            if (test_pending(test, m, m, identity, emit)) return;
        }
        assert(stack_.empty());
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(stack_, nodes_); }

private:
    using cursor = typename Tree::cursor;

    /// A pair of nodes to be opened; the box of B's node is in A's frame.
    struct node_pair {
        cursor a;
        cursor b;
        box b_bounds;
    };

    /// The identity, for the traversal of a tree with itself.
    struct same_frame {
        [[nodiscard]] box operator()(const box& b) const noexcept { return b; }
        [[nodiscard]] triangle3f operator()(const triangle3f& t) const noexcept { return t; }
    };

    /// The nodes of a pair that are new. If only one is, its parent has been tested against the other node.
    enum class new_node : std::uint8_t { a, b, both };

    /// Discards the state of an earlier query, which may have stopped early.
    void begin(const vec3f& image_error) {
        require_ieee_arithmetic();
        image_error_ = image_error;
        stack_.clear();
        image_of_ = no_triangle;
    }

    /// Opens the pending pairs (`stack_`): tests the triangles of two leaves, or replaces the longer node by its
    /// children that overlap the other one.
    /// @param to_a maps boxes and triangles of B to A's frame
    /// @returns whether `emit`, called with each intersecting pair, returned true, which ends the walk
    template <class Frame, class Emit>
    [[nodiscard]] bool test_pending(const query& test, const model<Tree>& a, const model<Tree>& b, const Frame& to_a,
                                    Emit& emit) {
        const Tree& tree_a = a.tree();
        const Tree& tree_b = b.tree();
        while (!stack_.empty()) {
            const node_pair p = stack_.back();
            stack_.pop_back();
            counters_.add(work::node_visits);
            const bool a_is_leaf = tree_a.is_leaf(p.a);
            const bool b_is_leaf = tree_b.is_leaf(p.b);
            if (a_is_leaf && b_is_leaf) {
                if (!triangles_intersect(test, a, b, to_a, p)) continue;
                const index_pair triangles{tree_a.triangle(p.a), tree_b.triangle(p.b)};
                if (emit(std::span<const index_pair>(&triangles, 1))) return true;
            } else if (b_is_leaf || (!a_is_leaf && longest_extent(tree_a.bounds(p.a)) >= longest_extent(p.b_bounds))) {
                const auto [left, right] = tree_a.children(p.a, a.triangles());
                push_if_overlapping(a, b, to_a, {right, p.b, p.b_bounds}, new_node::a);
                push_if_overlapping(a, b, to_a, {left, p.b, p.b_bounds}, new_node::a);
            } else {
                const auto [left, right] = tree_b.children(p.b, b.triangles());
                push_if_overlapping(a, b, to_a, {p.a, right, bounds_in_a(b, to_a, right, p.b_bounds)}, new_node::b);
                push_if_overlapping(a, b, to_a, {p.a, left, bounds_in_a(b, to_a, left, p.b_bounds)}, new_node::b);
            }
        }
        return false;
    }

    template <class Frame>
    [[nodiscard]] bool triangles_intersect(const query& test, const model<Tree>& a, const model<Tree>& b,
                                           const Frame& to_a, const node_pair& leaves) {
        counters_.add(work::triangle_tests);
        const index_pair pair{a.tree().triangle(leaves.a), b.tree().triangle(leaves.b)};
        return test.intersects([&] { return pair; }, a.triangles().triangle(pair.a), triangle_in_a(b, to_a, leaves.b));
    }

    /// The triangle of a leaf of B in A's frame. The last one is cached, since a leaf meets many nodes of A in a row.
    template <class Frame>
    [[nodiscard]] const triangle3f& triangle_in_a(const model<Tree>& b, const Frame& to_a, const cursor& leaf) {
        const std::uint32_t triangle = b.tree().triangle(leaf);
        if (triangle != image_of_) image_ = to_a(b.triangles().triangle(triangle));
        image_of_ = triangle;
        return image_;
    }

    /// The box of a child of B's node in A's frame. For a leaf without a box, it is the parent's, or if the leaf test
    /// `triangle_aabb` was chosen, that of its triangle, grown by the rounding error of the triangle in A's frame.
    /// @param parent the parent's box in A's frame
    template <class Frame>
    [[nodiscard]] box bounds_in_a(const model<Tree>& b, const Frame& to_a, const cursor& child, const box& parent) {
        if constexpr (!Tree::has_leaf_boxes)
            if (b.tree().is_leaf(child))
                return b.tree().leaf_test() == leaf_test_choice::triangle_aabb
                           ? grown(bounds_of(triangle_in_a(b, to_a, child)))
                           : parent;
        return to_a(b.tree().bounds(child));
    }

    template <class Frame>
    void push_if_overlapping(const model<Tree>& a, const model<Tree>& b, const Frame& to_a, const node_pair& next,
                             new_node which_is_new) {
        if (may_overlap(a, b, to_a, next, which_is_new)) stack_.push_back(next);
    }

    /// Whether the boxes of two nodes overlap. In a layout without leaf boxes, `leaf_test` replaces them by the
    /// triangle (triangle_box) or, in `bounds`, by the triangle's box (triangle_aabb) or the parent's (none).
    /// @param which_is_new the node of the pair that replaces its parent, which has been tested
    template <class Frame>
    [[nodiscard]] bool may_overlap(const model<Tree>& a, const model<Tree>& b, const Frame& to_a, const node_pair& next,
                                   new_node which_is_new) {
        if constexpr (!Tree::has_leaf_boxes) {
            const leaf_test_choice test = a.tree().leaf_test();
            const bool a_is_leaf = a.tree().is_leaf(next.a);
            const bool b_is_leaf = b.tree().is_leaf(next.b);
            const bool tests_triangle_in_box =
                test == leaf_test_choice::triangle_box || test == leaf_test_choice::moller_triangle_box;
            // Without a box on either side, only the test of the two triangles remains.
            if (a_is_leaf && b_is_leaf && test != leaf_test_choice::triangle_aabb) return true;
            // The same box, the parent's, has been tested.
            if (test == leaf_test_choice::none && (which_is_new == new_node::a ? a_is_leaf : b_is_leaf)) return true;
            if (tests_triangle_in_box && a_is_leaf)
                return intersects_box(a.triangles().triangle(a.tree().triangle(next.a)), grown(next.b_bounds), test);
            if (tests_triangle_in_box && b_is_leaf)
                return intersects_box(triangle_in_a(b, to_a, next.b), grown(a.tree().bounds(next.a)), test);
        }
        counters_.add(work::box_tests);
        return overlaps(a.tree().bounds(next.a), next.b_bounds);
    }

    /// The box grown to cover rounding: a triangle meets it if the exact triangle meets the exact box. B's corners and
    /// the bounds of a box may be off by `image_error_` on each axis; without that error, floats are exact.
    [[nodiscard]] box grown(box b) const noexcept {
        for (int k = 0; k < 3; ++k) {
            if (image_error_[k] == 0) continue;
            // The second term exceeds the error of rounding the sum.
            const auto margin = [&](float bound) { return 2 * image_error_[k] + 0x1p-22F * std::abs(bound); };
            b.min[k] -= margin(b.min[k]);
            b.max[k] += margin(b.max[k]);
        }
        return b;
    }

    [[nodiscard]] bool intersects_box(const triangle3f& t, const box& b, leaf_test_choice test) {
        counters_.add(work::triangle_box_tests);
        return test == leaf_test_choice::triangle_box ? triangle_meets_box(t, b) : moller_triangle_meets_box(t, b);
    }

    /// The measure by which the node to open first is chosen.
    [[nodiscard]] static float longest_extent(const box& b) noexcept {
        const int k = longest_axis(b);
        return b.max[k] - b.min[k];
    }

    [[no_unique_address]] Counters counters_;
    std::vector<node_pair> stack_;
    std::vector<cursor> nodes_;  // nodes of one tree that are still to be tested against themselves
    static constexpr std::uint32_t no_triangle = 0xffffffff;
    std::uint32_t image_of_ = no_triangle;  // the triangle of B whose image is cached
    triangle3f image_{};
    vec3f image_error_{};
};

}  // namespace aabb
