/// A traversal of two trees down to pairs of triangles that may be near each other.
export module aabb.distance.near_walk;

export import aabb.distance.placed_boxes;
export import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// Simultaneous depth-first traversal of two BVHs in the world, relative to the translation of the first pose: opens
/// the longer of two nodes first, and of its children the nearer first. Boxes are moved to the world and contain the
/// vertices as they are given (`placed_boxes`), so that the poses may be any maps of full rank.
template <TreePolicy Tree, CounterPolicy Counters>
class near_walk {
public:
    /// Passes the indices of each pair of triangles whose squared distance may be at most `limit()` to `visit`, until
    /// it returns true.
    /// @param limit is read again for each pair of nodes, so that it may decrease meanwhile
    template <class Limit, class Visit>
    void find(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b, const Limit& limit,
              const Visit& visit) {
        require_ieee_arithmetic();
        const placed_boxes of_a(pose_a, {}, a.triangles().frame, a.bounds());
        const placed_boxes of_b(pose_b, pose_b.translation - pose_a.translation, b.triangles().frame, b.bounds());
        const boxd box_a = of_a(a.bounds()), box_b = of_b(b.bounds());
        stack_.assign(1, {a.root(), b.root(), box_a, box_b, squared_gap(box_a, box_b)});
        while (!stack_.empty()) {
            const node_pair p = stack_.back();
            stack_.pop_back();
            if (p.gap > limit()) continue;
            counters_.add(work::node_visits);
            const bool a_is_leaf = a.tree().is_leaf(p.a), b_is_leaf = b.tree().is_leaf(p.b);
            if (a_is_leaf && b_is_leaf) {
                counters_.add(work::triangle_tests);
                if (visit(a.tree().triangle(p.a), b.tree().triangle(p.b))) break;
            } else if (b_is_leaf || (!a_is_leaf && longest_extent(p.box_a) >= longest_extent(p.box_b))) {
                push_nearer_last(children_of(a, p.a), limit(), [&](const cursor& child) {
                    const boxd moved = of_a(bounds_of_node(a, child));
                    return node_pair{child, p.b, moved, p.box_b, squared_gap(moved, p.box_b)};
                });
            } else {
                push_nearer_last(children_of(b, p.b), limit(), [&](const cursor& child) {
                    const boxd moved = of_b(bounds_of_node(b, child));
                    return node_pair{p.a, child, p.box_a, moved, squared_gap(p.box_a, moved)};
                });
            }
        }
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(stack_); }

private:
    using cursor = typename Tree::cursor;

    /// A pair of nodes to be opened, with their boxes in the world and the squared gap of these.
    struct node_pair {
        cursor a;
        cursor b;
        boxd box_a;
        boxd box_b;
        double gap;
    };

    [[nodiscard]] static std::array<cursor, 2> children_of(const model<Tree>& m, const cursor& node) {
        return m.tree().children(node, m.triangles());
    }

    /// The box of a node; a leaf's is that of its triangle, since a layout may have none, or one of several leaves.
    [[nodiscard]] static box bounds_of_node(const model<Tree>& m, const cursor& node) {
        if (m.tree().is_leaf(node)) return bounds_of(m.triangles().triangle(m.tree().triangle(node)));
        return m.tree().bounds(node);
    }

    /// Pushes the pairs of both children that are near enough; the nearer one is opened next.
    template <class PairOf>
    void push_nearer_last(const std::array<cursor, 2>& children, double limit, const PairOf& pair_of) {
        counters_.add(work::box_tests, 2);
        const node_pair first = pair_of(children[0]), second = pair_of(children[1]);
        const bool first_is_nearer = first.gap < second.gap;
        for (const node_pair* const p : {first_is_nearer ? &second : &first, first_is_nearer ? &first : &second})
            if (!(p->gap > limit)) stack_.push_back(*p);
    }

    [[no_unique_address]] Counters counters_;
    std::vector<node_pair> stack_;
};

}  // namespace aabb
