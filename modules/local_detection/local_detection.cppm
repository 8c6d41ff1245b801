export module aabb.local_detection;

export import :depth_first_walk;
export import :model;
export import :policies;
export import :tree_validation;
export import :triangle_query;
export import :triangles_in_box;

export import aabb.counters;
export import aabb.geometry;
export import aabb.policy;
import aabb.std;

namespace aabb::detail {

template <class Tree, class Triangle, class Counters>
typename Tree::template walk<Triangle, Counters> walk_in(int);
template <class Tree, class Triangle, class Counters>
depth_first_walk<Tree, Triangle, Counters> walk_in(...);

}  // namespace aabb::detail

export namespace aabb {

/// The narrow phase (local detection in the paper, section 3): traverses two BVHs together down to pairs of triangles,
/// in A's frame (`relative_pose`); exact triangle tests decide at the poses themselves. Nothing is allocated once the
/// buffers have grown to the largest query. Every query throws input_error as `require_ieee_arithmetic` and
/// `relative_pose` do.
template <TreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters = no_counters>
class local_detection {
    static_assert(aabb::is_accepted<sentence_of<Tree, Triangle>()>);

public:
    local_detection()
        requires std::default_initializable<Triangle>
    = default;
    explicit local_detection(Triangle triangle) : triangle_(std::move(triangle)) {}

    /// Appends every pair of intersecting triangles (a of A, b of B) once, in unspecified order; none if it throws.
    void all_pairs(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b,
                   std::vector<index_pair>& pairs) {
        append_guard guard(pairs);
        walk(a, pose_a, b, pose_b, walk_goal::every_pair, [&](std::span<const index_pair> batch) {
            pairs.insert(pairs.end(), batch.begin(), batch.end());
            return false;  // continues
        });
        guard.keep();
    }

    /// The number of pairs of intersecting triangles, without storing them.
    [[nodiscard]] std::uint64_t count_pairs(const model<Tree>& a, const pose& pose_a, const model<Tree>& b,
                                            const pose& pose_b) {
        std::uint64_t count = 0;
        walk(a, pose_a, b, pose_b, walk_goal::every_pair, [&](std::span<const index_pair> batch) {
            count += batch.size();
            return false;  // continues
        });
        return count;
    }

    /// The first pair of intersecting triangles that the traversal finds, if there is one; it stops there.
    [[nodiscard]] std::optional<index_pair> first_pair(const model<Tree>& a, const pose& pose_a, const model<Tree>& b,
                                                       const pose& pose_b) {
        std::optional<index_pair> first;
        walk(a, pose_a, b, pose_b, walk_goal::first_pair, [&](std::span<const index_pair> batch) {
            first = batch.front();
            return true;  // stops
        });
        return first;
    }

    /// Appends each intersecting pair a < b of a mesh once, also those that share a vertex; none if it throws.
    void self_pairs(const model<Tree>& m, std::vector<index_pair>& pairs) {
        append_guard guard(pairs);
        each_self_pair(m, [&](index_pair pair) {
            pairs.push_back(pair);
            return false;  // continues
        });
        guard.keep();
    }

    /// Passes each pair of intersecting triangles a < b of one mesh to `take` as it is found, until it returns true.
    template <class Take>
    void each_self_pair(const model<Tree>& m, const Take& take) {
        const relative_pose identity = pose_relative_to(m, {}, m, {});
        const pose_pair unposed;
        const triangle_query<Tree, Triangle> test(triangle_, m, m, unposed, identity);
        walk_.find_self_pairs(test, m, [&](std::span<const index_pair> batch) {
            return std::ranges::any_of(batch, [&](const index_pair& p) { return take(ordered_pair(p.a, p.b)); });
        });
    }

    [[nodiscard]] const Counters& counters() const noexcept { return walk_.counters(); }
    [[nodiscard]] std::size_t bytes() const noexcept { return walk_.bytes(); }

private:
    /// Traverses the trees of both meshes together, and passes pairs of intersecting triangles (a of A, b of B) to
    /// `emit` in batches until it returns true. Works in A's frame, or in B's if B leaves the range of float in A's.
    template <class Emit>
    void walk(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b, walk_goal goal,
              Emit emit) {
        std::optional<relative_pose> to_a;  // maps B to A's frame
        try {
            to_a.emplace(pose_relative_to(a, pose_a, b, pose_b));
        } catch (const input_error&) {
            return walk_in_frame_of_b(a, pose_a, b, pose_b, goal, emit);
        }
        const pose_pair poses{pose_a, pose_b};
        walk_.find_pairs(triangle_query<Tree, Triangle>(triangle_, a, b, poses, *to_a), a, b, *to_a, goal, emit);
    }

    /// Walks in B's frame, with the meshes swapped: a huge mesh can leave the range of float in the frame of a tiny
    /// one, not the other way round. So the order of the meshes does not decide whether a query is rejected.
    template <class Emit>
    void walk_in_frame_of_b(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b,
                            walk_goal goal, Emit emit) {
        const relative_pose to_b = pose_relative_to(b, pose_b, a, pose_a);
        const pose_pair poses{pose_b, pose_a};
        std::vector<index_pair> swapped;  // a batch, in the order (a of A, b of B) again
        walk_.find_pairs(triangle_query<Tree, Triangle>(triangle_, b, a, poses, to_b), b, a, to_b, goal,
                         [&](std::span<const index_pair> batch) {
                             swapped.clear();
                             for (const auto& [of_b, of_a] : batch) swapped.push_back({of_a, of_b});
                             return emit(std::span<const index_pair>(swapped));
                         });
    }

    [[no_unique_address]] Triangle triangle_;
    decltype(detail::walk_in<Tree, Triangle, Counters>(0)) walk_;
};

}  // namespace aabb
