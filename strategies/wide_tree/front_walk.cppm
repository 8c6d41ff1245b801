export module aabb.wide_tree.front_walk;

import aabb.std;
import aabb.wide_tree.batched_walk;

export namespace aabb {

/// A batched walk with BVTT front tracking: if an earlier query's pairs of leaves are still valid, only these are
/// tested. The result of an inexact test depends on which boxes were tested before it, so that it gets no fronts.
template <WideTreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class front_walk {
public:
    using query = triangle_query<Tree, Triangle>;

    /// Passes intersecting pairs of triangles (a of A, b of B) to `emit`, in batches, until `emit` returns true.
    template <class Emit>
    void find_pairs(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                    walk_goal goal, Emit emit) {
        if constexpr (requires { requires Triangle::filtered; })
            if (a.tree().keeps_fronts() && to_a.is_rigid() && leaves_of(a) + leaves_of(b) >= front_cache::least_leaves)
                return find_pairs_with_front(test, a, b, to_a, goal, emit);
        walk_.find_pairs(test, a, b, to_a, goal, emit);
    }

    /// Finds the self-intersections of a mesh; each pair is reported once, in either order.
    template <class Emit>
    void find_self_pairs(const query& test, const model<Tree>& m, Emit emit) {
        walk_.find_self_pairs(test, m, emit);
    }

    [[nodiscard]] const Counters& counters() const noexcept { return walk_.counters(); }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = walk_.bytes() + (sizeof *this - sizeof walk_);
        if (fronts_) total += sizeof *fronts_ + fronts_->bytes();
        if (leaves_) total += sizeof *leaves_ + leaves_->bytes();
        return total;
    }

private:
    /// Finds pairs by BVTT front tracking. A front is the list of the pairs of leaves within a margin at an earlier
    /// pose: while B has moved by no more than the margin since, it has every pair that meets now, and only these are
    /// tested. Otherwise a new front is built if that is worth its cost, or the walk starts at the roots. A query for
    /// any one pair tries the last hit first, and builds a front only if there is no hit.
    template <class Emit>
    void find_pairs_with_front(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                               walk_goal goal, const Emit& emit) {
        batched_walk<Tree, Triangle, Counters>::require_ready(a, b);
        const model_pair models{.numbers = {a.number(), b.number()}, .states = {a.state(), b.state()}};
        const box_motion motion = to_a.to_boxes();
        const double leaf_size = std::sqrt(std::min(area_of_leaf(a), area_of_leaf(b)));
        const double near = bvtt_front::most_step * leaf_size;
        // If rounding alone moves B further than that, a front is not worth its cost.
        if (!(2 * rounding_bound(motion) <= near)) return walk_.find_pairs(test, a, b, to_a, goal, emit);

        if (!fronts_) fronts_ = std::make_unique<front_cache>();
        bvtt_front& front = fronts_->find(models, motion, b.bounds(), near);
        const bvtt_front::decision decision = front.record_query(models, motion, b.bounds(), leaf_size);
        const std::size_t most_pairs = leaves_of(a) + leaves_of(b);  // a front of more is given up
        const auto builds_front = [&] {
            return decision.margin &&
                   front.build(models, motion, *decision.margin, [&](std::vector<front_pair>& pairs) {
                       return walk_.collect_front(a, b, to_a, *decision.margin, most_pairs, pairs);
                   });
        };
        if (goal == walk_goal::every_pair) {
            if (decision.is_valid || builds_front())
                test_front(test, a, b, to_a, front, goal, emit);
            else
                walk_.find_pairs(test, a, b, to_a, goal, emit);
            return;
        }
        if (emit_last_hit(test, a, b, to_a, front, emit)) return;
        const auto emit_and_keep = [&](std::span<const index_pair> hits) {
            front.hit = hits.front();
            return emit(hits);
        };
        if (decision.is_valid) return test_front(test, a, b, to_a, front, goal, emit_and_keep);
        walk_.find_pairs(test, a, b, to_a, goal, emit_and_keep);
        if (!front.hit) static_cast<void>(builds_front());
    }

    /// Emits the last reported first pair if it still intersects, or else forgets it; returns whether it was emitted.
    template <class Emit>
    [[nodiscard]] bool emit_last_hit(const query& test, const model<Tree>& a, const model<Tree>& b,
                                     const relative_pose& to_a, bvtt_front& front, const Emit& emit) {
        if (!front.hit) return false;
        const index_pair hit = *front.hit;
        walk_.counters().add(work::triangle_tests);
        if (!test.intersects([&] { return hit; }, a.triangles().triangle(hit.a), to_a(b.triangles().triangle(hit.b)))) {
            front.hit.reset();
            return false;
        }
        emit(std::span<const index_pair>(&hit, 1));
        return true;
    }

    template <class Emit>
    void test_front(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                    const bvtt_front& front, walk_goal goal, const Emit& emit) {
        if (front.pairs().empty()) return;
        if (!leaves_) leaves_ = std::make_unique<front_leaves<Tree>>();
        walk_.find_pairs_in_front(test, a, b, to_a, front.pairs(), *leaves_, goal, emit);
    }

    /// An estimate: the area of the mesh's box, divided among its leaves.
    [[nodiscard]] static double area_of_leaf(const model<Tree>& m) {
        return surface_area(m.bounds()) / static_cast<double>(leaves_of(m));
    }

    batched_walk<Tree, Triangle, Counters> walk_;
    // Both are created on first use.
    std::unique_ptr<front_cache> fronts_;
    std::unique_ptr<front_leaves<Tree>> leaves_;
};

}  // namespace aabb
