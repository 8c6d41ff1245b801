export module aabb.wide_tree.batched_walk;

import aabb.std;
import aabb.wide_tree.child_pairs;
export import aabb.wide_tree.leaf_pairs;
import aabb.wide_tree.nearest_walk;
import aabb.wide_tree.triangle_batch;

export namespace aabb {

/// Traverses two trees simultaneously, level by level. Each step opens a batch of node pairs of the lowest level that
/// has any, so that the pairs of a batch do not depend on each other and few pairs are pending. Leaves are read and
/// transformed once for consecutive pairs, their triangles tested in batches. First-pair queries use `nearest_walk`.
template <WideTreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class batched_walk {
public:
    using query = triangle_query<Tree, Triangle>;

    static void require_ready(const model<Tree>& a, const model<Tree>& b) {
        require_ieee_arithmetic();
        a.require_fit();
        b.require_fit();
    }

    /// Passes intersecting pairs of triangles (a of A, b of B) to `emit`, in batches, until `emit` returns true.
    template <class Emit>
    void find_pairs(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                    walk_goal goal, Emit emit) {
        if (goal == walk_goal::first_pair) return find_first_pair(test, a, b, to_a, emit);
        find_all_pairs(test, a, b, to_a, query_kind::two_meshes, emit);
    }

    /// Finds the self-intersections of a mesh; each pair is reported once, in either order.
    template <class Emit>
    void find_self_pairs(const query& test, const model<Tree>& m, Emit emit) {
        find_all_pairs(test, m, m, pose_relative_to(m, {}, m, {}), query_kind::one_mesh, emit);
    }

    /// Appends the BVTT front of this pose, where later queries start: pairs of leaves with triangles within a margin
    /// of each other, up to `rounding_bound`, each with a mask of these pairs of triangles.
    /// @returns false if there are more than `most_pairs`, where it stops
    [[nodiscard]] bool collect_front(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                     double margin, std::size_t most_pairs, std::vector<front_pair>& pairs) {
        const float rounded_up = std::nextafter(static_cast<float>(margin), std::numeric_limits<float>::infinity());
        leaf_pairs_.begin(a, b, to_a, /*options=*/{}, rounded_up);
        const auto collect = [&](std::span<const std::uint32_t> leaves_a, std::span<const std::uint32_t> leaves_b) {
            const auto append = [&](std::size_t p, std::uint64_t mask) {
                pairs.push_back({leaves_a[p], leaves_b[p], mask});
                return pairs.size() > most_pairs;
            };
            return leaf_pairs_.for_each_within_margin(a, b, to_a, leaves_a, leaves_b, counters_, append);
        };
        return !descend_to_leaves(a, b, to_a, query_kind::two_meshes, margin, collect);
    }

    /// Works as `find_pairs`, but tests only the pairs of triangles in a front.
    /// @param pairs the front: pairs of leaves, each with a mask of the pairs of triangles to test
    /// @param leaves reads these leaves, and caches them during the query
    template <class Emit>
    void find_pairs_in_front(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                             std::span<const front_pair> pairs, front_leaves<Tree>& leaves, walk_goal goal, Emit emit) {
        const bool any_pair = goal == walk_goal::first_pair;
        const auto triangles_at = triangle_lookup(a, b);
        queue_.clear();
        const auto test_pair = [&](const front_pair& p, const triangle_block& block_a, const triangle_block& block_b) {
            queue_pairs(a.tree(), b.tree(), p, block_a, block_b);
            // If any pair will do, waiting for a full queue would read more leaves than necessary.
            return (any_pair || queue_.is_full()) && queue_.test_queued(test, /*flush=*/any_pair, triangles_at, emit);
        };
        if (!leaves.for_each_pair(a, b, to_a, pairs, leaf_pairs_.reader(), test_pair))
            static_cast<void>(queue_.test_queued(test, /*flush=*/true, triangles_at, emit));
    }

    [[nodiscard]] Counters& counters() noexcept { return counters_; }
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = sizeof *this + bytes_of(pairs_) + steps_.bytes() + child_pairs_.bytes() +
                            leaf_pairs_.bytes() + nearest_.bytes();
        for (const node_pairs& p : pairs_) total += bytes_of(p.a, p.b);
        return total;
    }

private:
    static constexpr std::size_t children = wide_node::most_children;
    static constexpr std::size_t most_children_of_pair = children * children;
    static constexpr std::size_t most_at_once = child_pairs<Tree>::most_at_once;
    /// A floating-point filter precedes exact tests only.
    static constexpr bool is_filtered = requires { requires Triangle::filtered; };

    enum class query_kind : std::uint8_t { two_meshes, one_mesh };

    /// The pending node pairs of one step of the descent.
    struct node_pairs {
        std::vector<std::uint32_t> a;
        std::vector<std::uint32_t> b;
        std::size_t size = 0;

        /// Makes room for all pairs of children of one more pair.
        inline void make_room() {
            if (size + most_children_of_pair <= a.size()) return;
            b.resize(2 * size + most_children_of_pair);
            a.resize(2 * size + most_children_of_pair);
        }
    };

    /// Descends to the leaves, and tests all pairs of triangles whose boxes overlap, in batches.
    template <class Emit>
    void find_all_pairs(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                        query_kind kind, const Emit& emit) {
        const auto triangles_at = triangle_lookup(a, b);
        queue_.clear();
        bool reached_leaves = false;
        const auto test_batch = [&](std::span<const std::uint32_t> leaves_a, std::span<const std::uint32_t> leaves_b) {
            if (!std::exchange(reached_leaves, true)) begin_leaves(test, a, b, to_a, kind);
            return test_leaves(test, a, b, to_a, kind, leaves_a, leaves_b, triangles_at, emit);
        };
        if (!descend_to_leaves(a, b, to_a, kind, /*margin=*/0, test_batch))
            static_cast<void>(queue_.test_queued(test, /*flush=*/true, triangles_at, emit));
    }

    /// Finds any one pair: tests each pair of leaves, nearest ones first (`nearest_walk`), before it reads the next.
    template <class Emit>
    void find_first_pair(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                         const Emit& emit) {
        require_ready(a, b);
        const auto triangles_at = triangle_lookup(a, b);
        queue_.clear();
        bool reached_leaves = false;
        constexpr query_kind kind = query_kind::two_meshes;
        const auto test_pair = [&](const std::uint32_t& leaf_a, const std::uint32_t& leaf_b) {
            if (!std::exchange(reached_leaves, true)) begin_leaves(test, a, b, to_a, kind);
            return test_leaves(test, a, b, to_a, kind, {&leaf_a, 1}, {&leaf_b, 1}, triangles_at, emit) ||
                   queue_.test_queued(test, /*flush=*/true, triangles_at, emit);
        };
        nearest_.for_each_leaf_pair(a, b, to_a, counters_, test_pair);
    }

    /// Prepares the caches at the first leaves of a query: distant meshes need none. An inexact test gets only
    /// triangles whose boxes in float overlap, since its result must not depend on quantized boxes.
    void begin_leaves(const query& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                      query_kind kind) {
        leaf_pairs_.begin(a, b, to_a,
                          {.shares_corners = kind == query_kind::one_mesh, .rejects_by_exact_boxes = !is_filtered},
                          test.greatest_error());
    }

    /// Descends both trees at once to the pairs of leaves whose boxes overlap. Each iteration takes a batch of the last
    /// step that has pending pairs (`pairs_`), so that few are pending: it opens the nodes for the next step, or passes
    /// on all pairs of leaves.
    /// @param margin the distance up to which boxes count as overlapping
    /// @param at_leaves called with a batch of pairs, as leaves of A and leaves of B; returns whether to stop
    /// @returns whether `at_leaves` stopped the walk
    template <class AtLeaves>
    bool descend_to_leaves(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, query_kind kind,
                           double margin, const AtLeaves& at_leaves) {
        begin(a, b, to_a, margin);
        for (std::size_t step = 0;;) {
            while (pairs_[step].size == 0)  // and so are all later steps
                if (step-- == 0) return false;
            node_pairs& from = pairs_[step];
            const std::size_t end = from.size;
            const bool is_last = step + 1 == steps_.size();
            const std::size_t begin = is_last ? 0 : end - std::min(end, most_at_once);
            from.size = begin;
            counters_.add(work::node_visits, end - begin);
            if (!is_last) {
                open_nodes(a.tree(), b.tree(), kind, step, begin, end);
                ++step;
                continue;
            }
            if (at_leaves(std::span(from.a).subspan(begin, end - begin), std::span(from.b).subspan(begin, end - begin)))
                return true;
        }
    }

    /// Starts a query with one pending pair, the roots.
    void begin(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, double margin) {
        require_ready(a, b);
        steps_.begin({a.tree().levels(), b.tree().levels()});
        if (pairs_.size() < steps_.size()) pairs_.resize(steps_.size());
        for (node_pairs& p : pairs_) p.size = 0;
        pairs_[0].make_room();
        pairs_[0].a[0] = pairs_[0].b[0] = 0;
        pairs_[0].size = 1;
        child_pairs_.begin(a.tree(), b.tree(), to_a, a.bounds(), margin);
    }

    /// Maps places in two leaves to triangles of the meshes.
    [[nodiscard]] static auto triangle_lookup(const model<Tree>& a, const model<Tree>& b) {
        return [&](std::uint32_t leaf_a, std::uint32_t i, std::uint32_t leaf_b, std::uint32_t j) {
            return index_pair{a.tree().triangle_at(children * leaf_a + i), b.tree().triangle_at(children * leaf_b + j)};
        };
    }

    /// Opens the node pairs `begin` to `end` of a step: appends overlapping pairs of children to the next step. A step
    /// opens both nodes or only the higher one. Child i of node n is node 8 n + i of the level below.
    void open_nodes(const Tree& a, const Tree& b, query_kind kind, std::size_t step, std::size_t begin,
                    std::size_t end) {
        const wide_node* const nodes_a = a.level(steps_[step].a - 1);
        const wide_node* const nodes_b = b.level(steps_[step].b - 1);
        const bool opens_a = steps_.opens_a(step);
        const bool opens_b = steps_.opens_b(step);
        const node_pairs& from = pairs_[step];
        node_pairs& to = pairs_[step + 1];
        const std::span batch_a = std::span(from.a).subspan(begin, end - begin);
        const std::span batch_b = std::span(from.b).subspan(begin, end - begin);
        for (auto [pair, mask] : child_pairs_.find_overlapping(nodes_a, batch_a, nodes_b, batch_b, counters_)) {
            to.make_room();
            const std::uint32_t node_a = batch_a[pair];
            const std::uint32_t node_b = batch_b[pair];
            // A node against itself has each pair of children twice.
            if (kind == query_kind::one_mesh && node_a == node_b) mask &= each_pair_once;
            const std::uint64_t to_open = steps_.pairs_to_open(step, mask);
            const std::uint32_t first_a = opens_a ? children * node_a : node_a;
            const std::uint32_t first_b = opens_b ? children * node_b : node_b;
            alignas(64) std::array<std::uint8_t, most_children_of_pair> bits{};  // 8 j + i: children i of A and j of B
            simd::store_set_bits(bits.data(), to_open);
            const auto count = static_cast<std::size_t>(std::popcount(to_open));
            std::size_t p = 0;
            do {  // eight pairs; almost always one iteration, so that the branch is predicted
                const auto bit =
                    __builtin_convertvector(simd::load_eight<simd::eight_bytes>(&bits[p]), simd::eight_words);
                simd::store_eight(&to.a[to.size + p], first_a + (bit & 7U));
                simd::store_eight(&to.b[to.size + p], first_b + (bit >> 3U));
                p += children;
            } while (p < count);
            to.size += count;
        }
    }

    /// Queues the pairs of triangles of these leaves whose boxes overlap, and tests the queue whenever it is full.
    /// @param leaves_a,leaves_b each leaf of A is paired with the leaf of B at the same index
    /// @returns whether `emit` wants to stop
    template <class TrianglesAt, class Emit>
    [[nodiscard]] bool test_leaves(const query& test, const model<Tree>& a, const model<Tree>& b,
                                   const relative_pose& to_a, query_kind kind, std::span<const std::uint32_t> leaves_a,
                                   std::span<const std::uint32_t> leaves_b, const TrianglesAt& triangles_at,
                                   const Emit& emit) {
        // Inlined, because a call would cost up to a tenth of the work in it.
        const auto test_pair = [&](std::size_t p, const read_leaf& leaf_a, const read_leaf& leaf_b,
                                   std::uint64_t mask) __attribute__((always_inline)) {
            if (kind == query_kind::one_mesh) {
                // A leaf against itself: each pair once, and no triangle with itself.
                if (leaves_a[p] == leaves_b[p]) mask &= each_pair_once & distinct_children;
                if (emit_adjacent(mask, leaves_a[p], leaves_b[p], triangles_at, emit)) return true;
                if (mask == 0) return false;
            }
            queue_pairs(a.tree(), b.tree(), {leaves_a[p], leaves_b[p], mask}, leaf_a.block, leaf_b.block);
            return queue_.is_full() && queue_.test_queued(test, /*flush=*/false, triangles_at, emit);
        };
        return leaf_pairs_.for_each_meeting(a, b, to_a, leaves_a, leaves_b, counters_, test_pair);
    }

    /// Queues pairs of triangles for the test, and prefetches the indices of the triangles.
    [[gnu::always_inline]] inline void queue_pairs(const Tree& a, const Tree& b, const front_pair& p,
                                                   const triangle_block& block_a, const triangle_block& block_b) {
        counters_.add(work::triangle_tests, static_cast<std::uint64_t>(std::popcount(p.mask)));
        queue_.add(p.mask, p.leaf_a, block_a, p.leaf_b, block_b);
        a.prefetch_triangles(p.leaf_a);
        b.prefetch_triangles(p.leaf_b);
    }

    /// Reports adjacent triangles without a test, because an exact test always accepts a shared corner.
    /// @param mask the overlapping pairs (bit 8 j + i); reported pairs are removed
    /// @returns whether to stop
    template <class TrianglesAt, class Emit>
    [[nodiscard]] bool emit_adjacent(std::uint64_t& mask, std::uint32_t leaf_a, std::uint32_t leaf_b,
                                     const TrianglesAt& triangles_at, const Emit& emit) const {
        if constexpr (is_filtered) {  // the test is exact
            const std::uint64_t sharing = leaf_pairs_.pairs_sharing_corners(leaf_a, leaf_b);
            std::array<index_pair, most_children_of_pair> adjacent;
            std::size_t count = 0;
            for (std::uint64_t rest = mask & sharing; rest != 0; rest &= rest - 1) {
                const auto bit = static_cast<std::uint32_t>(std::countr_zero(rest));
                adjacent[count++] = triangles_at(leaf_a, bit & 7U, leaf_b, bit >> 3U);
            }
            mask &= ~sharing;
            return count != 0 && emit(std::span<const index_pair>(adjacent).first(count));
        }
        return false;
    }

    /// Pairs of children of the same node: i <= j, and i != j.
    static constexpr std::uint64_t each_pair_once = 0xff7f3f1f0f070301;
    static constexpr std::uint64_t distinct_children = 0x7fbfdfeff7fbfdfe;

    [[no_unique_address]] Counters counters_;
    level_steps steps_;
    std::vector<node_pairs> pairs_;  // by step
    child_pairs<Tree> child_pairs_;
    leaf_pairs<Tree> leaf_pairs_;
    triangle_batch<Triangle> queue_;
    nearest_walk<Tree> nearest_;
};

}  // namespace aabb
