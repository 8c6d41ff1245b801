export module aabb.wide_tree.front_walk;

import aabb.std;
import aabb.wide_tree.batched_walk;

export namespace aabb {

/// A batched walk with BVTT front tracking: if an earlier query's pairs of leaves are still valid, only these are
/// tested. The result of an inexact test depends on which boxes were tested before it, so that it gets no fronts.
template <WideTreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class front_walk {
public:
    /// Passes intersecting pairs of triangles (a of A, b of B) to `emit`, in batches, until `emit` returns true.
    template <class Emit>
    void between(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                 walk_goal goal, Emit emit) {
        if constexpr (requires { requires Triangle::filtered; })
            if (a.tree().keeps_fronts() && leaves_of(a) + leaves_of(b) >= front_cache::least_leaves)
                return follow(test, a, b, to_a, goal, emit);
        walk_.between(test, a, b, to_a, goal, emit);
    }

    /// Finds the self-intersections of a mesh; each pair is reported once, in either order.
    template <class Emit>
    void within(const Triangle& test, const model<Tree>& m, Emit emit) {
        walk_.within(test, m, emit);
    }

    [[nodiscard]] const Counters& counters() const noexcept { return walk_.counters(); }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = walk_.bytes() + (sizeof *this - sizeof walk_);
        if (fronts_) total += sizeof *fronts_ + fronts_->bytes();
        if (leaves_) total += sizeof *leaves_ + leaves_->bytes();
        return total;
    }

private:
    /// A first-pair query tries the last hit first, and builds a front only if nothing intersects.
    template <class Emit>
    void follow(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                walk_goal goal, const Emit& emit) {
        require_ieee_arithmetic();
        a.require_fit();
        b.require_fit();
        const model_pair of{{a.number(), b.number()}, {a.state(), b.state()}};
        const box_motion at = to_a.to_boxes();
        const double size = std::sqrt(std::min(area_of_leaf(a), area_of_leaf(b)));
        const double near = bvtt_front::most_step * size;
        // If rounding alone moves B further than that, a front is not worth its cost.
        if (!(2 * rounding_bound(at) <= near)) return walk_.between(test, a, b, to_a, goal, emit);

        if (!fronts_) fronts_ = std::make_unique<front_cache>();
        bvtt_front& front = fronts_->find(of, at, b.bounds(), near);
        const bvtt_front::outlook outlook = front.note(of, at, b.bounds(), size);
        const auto is_kept = [&] {
            return outlook.margin && front.make(of, at, *outlook.margin, [&](std::vector<front_pair>& pairs) {
                return walk_.near(a, b, to_a, *outlook.margin, leaves_of(a) + leaves_of(b), pairs);
            });
        };
        if (goal == walk_goal::every_pair) {
            if (outlook.holds || is_kept())
                serve(test, a, b, to_a, front, goal, emit);
            else
                walk_.between(test, a, b, to_a, goal, emit);
            return;
        }
        if (front.hit) {
            walk_.counters().add(work::triangle_tests);
            if (test.intersects(a.triangles().triangle(front.hit->a), to_a(b.triangles().triangle(front.hit->b)))) {
                emit(std::span<const index_pair>(&*front.hit, 1));
                return;
            }
            front.hit.reset();
        }
        const auto emit_and_keep = [&](std::span<const index_pair> hits) {
            front.hit = hits.front();
            return emit(hits);
        };
        if (outlook.holds) return serve(test, a, b, to_a, front, goal, emit_and_keep);
        walk_.between(test, a, b, to_a, goal, emit_and_keep);
        if (!front.hit) static_cast<void>(is_kept());
    }

    template <class Emit>
    void serve(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
               const bvtt_front& front, walk_goal goal, const Emit& emit) {
        if (front.pairs().empty()) return;
        if (!leaves_) leaves_ = std::make_unique<front_leaves<Tree>>();
        walk_.among(test, a, b, to_a, front.pairs(), *leaves_, goal, emit);
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
