export module aabb.wide_tree.batched_walk;

import aabb.std;
import aabb.wide_tree.child_pairs;
export import aabb.wide_tree.leaf_pairs;
import aabb.wide_tree.nearest_walk;
import aabb.wide_tree.triangle_batch;

export namespace aabb {

/// Traverses two trees simultaneously, level by level. Each step opens a batch of node pairs of the lowest level that
/// has any, so that the pairs of a batch do not depend on each other and few pairs are pending. Leaves are read and
/// transformed once for consecutive pairs, and their triangles are tested in batches. Queries for the first pair use
/// `nearest_walk`.
template <WideTreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class batched_walk {
public:
    /// Passes intersecting pairs of triangles (a of A, b of B) to `emit`, in batches, until `emit` returns true.
    template <class Emit>
    void between(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                 walk_goal goal, Emit emit) {
        if (goal == walk_goal::first_pair) return find(test, a, b, to_a, emit);
        walk(test, a, b, to_a, extent::two_meshes, emit);
    }

    /// Finds the self-intersections of a mesh; each pair is reported once, in either order.
    template <class Emit>
    void within(const Triangle& test, const model<Tree>& m, Emit emit) {
        walk(test, m, m, relative_pose({}, {}, m.bounds()), extent::one_mesh, emit);
    }

    /// Appends the pairs of leaves with triangles within a margin of each other, less rounding (`rounding_bound`).
    /// @returns false if there are more than `most`, where it stops
    [[nodiscard]] bool near(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, double margin,
                            std::size_t most, std::vector<front_pair>& pairs) {
        leaves_.begin(a, b, to_a, false, false,
                      std::nextafter(static_cast<float>(margin), std::numeric_limits<float>::infinity()));
        return !descend(a, b, to_a, extent::two_meshes, margin,
                        [&](std::span<const std::uint32_t> of_a, std::span<const std::uint32_t> of_b) {
                            return leaves_.for_each_within_margin(a, b, to_a, of_a, of_b, counters_,
                                                                  [&](std::size_t p, std::uint64_t which) {
                                                                      pairs.push_back({of_a[p], of_b[p], which});
                                                                      return pairs.size() > most;
                                                                  });
                        });
    }

    /// The same as `between`, restricted to these pairs of leaves.
    template <class Emit>
    void among(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
               std::span<const front_pair> pairs, front_leaves<Tree>& leaves, walk_goal goal, Emit emit) {
        const bool any_pair = goal == walk_goal::first_pair;
        const auto triangles_at = naming(a, b);
        waiting_.clear();
        const auto test_pair = [&](const front_pair& p, const triangle_block& of_a, const triangle_block& of_b) {
            queue_pairs(a.tree(), b.tree(), p, of_a, of_b);
            return (any_pair || waiting_.is_full()) && waiting_.decide(test, any_pair, triangles_at, emit);
        };
        if (!leaves(a, b, to_a, pairs, leaves_.reader(), test_pair))
            static_cast<void>(waiting_.decide(test, true, triangles_at, emit));
    }

    [[nodiscard]] Counters& counters() noexcept { return counters_; }
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total =
            sizeof *this + bytes_of(pairs_) + steps_.bytes() + children_.bytes() + leaves_.bytes() + nearest_.bytes();
        for (const node_pairs& p : pairs_) total += bytes_of(p.a, p.b);
        return total;
    }

private:
    static constexpr std::size_t children = wide_node::most_children;
    static constexpr std::size_t most_children_of_pair = children * children;
    static constexpr std::size_t most_at_once = child_pairs<Tree>::most_at_once;
    /// Only exact tests have a floating-point filter in front.
    static constexpr bool is_filtered = requires { requires Triangle::filtered; };

    enum class extent : std::uint8_t { two_meshes, one_mesh };

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

    template <class Emit>
    void walk(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, extent what,
              const Emit& emit) {
        const auto triangles_at = naming(a, b);
        waiting_.clear();
        bool reached_leaves = false;
        const bool stopped =
            descend(a, b, to_a, what, 0, [&](std::span<const std::uint32_t> of_a, std::span<const std::uint32_t> of_b) {
                if (!reached_leaves) leaves_.begin(a, b, to_a, what == extent::one_mesh, !is_filtered, 0);
                reached_leaves = true;
                return test_leaves(test, a, b, to_a, what, of_a, of_b, triangles_at, emit);
            });
        if (!stopped) static_cast<void>(waiting_.decide(test, true, triangles_at, emit));
    }

    /// Finds any one pair: tests each pair of leaves before it reads the next.
    template <class Emit>
    void find(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
              const Emit& emit) {
        require_ready(a, b);
        const auto triangles_at = naming(a, b);
        waiting_.clear();
        bool reached_leaves = false;
        nearest_(a, b, to_a, counters_, [&](const std::uint32_t& of_a, const std::uint32_t& of_b) {
            if (!reached_leaves) leaves_.begin(a, b, to_a, false, !is_filtered, 0);
            reached_leaves = true;
            return test_leaves(test, a, b, to_a, extent::two_meshes, {&of_a, 1}, {&of_b, 1}, triangles_at, emit) ||
                   waiting_.decide(test, true, triangles_at, emit);
        });
    }

    /// Descends to the pairs of leaves whose boxes overlap.
    /// @param margin the distance up to which boxes count as overlapping
    /// @param at_leaves called with a batch of pairs, as leaves of A and leaves of B; returns whether to stop
    /// @returns whether `at_leaves` stopped the walk
    template <class AtLeaves>
    bool descend(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, extent what, double margin,
                 const AtLeaves& at_leaves) {
        begin(a, b, to_a, margin);
        for (std::size_t step = 0;;) {
            if (pairs_[step].size == 0) {
                step = steps_.size();
                while (step > 0 && pairs_[step - 1].size == 0) --step;
                if (step == 0) return false;
                --step;
            }
            node_pairs& from = pairs_[step];
            const std::size_t end = from.size;
            const bool is_last = step + 1 == steps_.size();
            const std::size_t begin = is_last ? 0 : end - std::min(end, most_at_once);
            from.size = begin;
            counters_.add(work::node_visits, end - begin);
            if (!is_last) {
                open(a.tree(), b.tree(), what, step, begin, end);
                ++step;
                continue;
            }
            if (at_leaves(std::span(from.a).subspan(begin, end - begin), std::span(from.b).subspan(begin, end - begin)))
                return true;
        }
    }

    static void require_ready(const model<Tree>& a, const model<Tree>& b) {
        require_ieee_arithmetic();
        a.require_fit();
        b.require_fit();
    }

    void begin(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, double margin) {
        require_ready(a, b);
        steps_.begin({a.tree().levels(), b.tree().levels()});
        if (pairs_.size() < steps_.size()) pairs_.resize(steps_.size());
        for (node_pairs& p : pairs_) p.size = 0;
        pairs_[0].make_room();
        pairs_[0].a[0] = pairs_[0].b[0] = 0;
        pairs_[0].size = 1;
        children_.begin(a.tree(), b.tree(), to_a, a.bounds(), margin);
    }

    /// Maps places in two leaves to triangles of the meshes.
    [[nodiscard]] static auto naming(const model<Tree>& a, const model<Tree>& b) {
        return [&](std::uint32_t leaf_a, std::uint32_t i, std::uint32_t leaf_b, std::uint32_t j) {
            return index_pair{a.tree().triangle_at(children * leaf_a + i), b.tree().triangle_at(children * leaf_b + j)};
        };
    }

    /// Pushes the overlapping pairs of children to the next step, which is a stack; pairs of leaves are taken all at
    /// once.
    void open(const Tree& a, const Tree& b, extent what, std::size_t step, std::size_t begin, std::size_t end) {
        const wide_node* const nodes_a = a.level(steps_[step].a - 1);
        const wide_node* const nodes_b = b.level(steps_[step].b - 1);
        const bool opens_a = steps_.opens_a(step);
        const bool opens_b = steps_.opens_b(step);
        const node_pairs& from = pairs_[step];
        node_pairs& to = pairs_[step + 1];
        const std::span some_a = std::span(from.a).subspan(begin, end - begin);
        const std::span some_b = std::span(from.b).subspan(begin, end - begin);
        for (auto [pair, met] : children_(nodes_a, some_a, nodes_b, some_b, counters_)) {
            to.make_room();
            const std::uint32_t node_a = some_a[pair];
            const std::uint32_t node_b = some_b[pair];
            if (what == extent::one_mesh && node_a == node_b) met &= each_pair_once;
            const std::uint64_t to_open = steps_.opened(step, met);
            const std::uint32_t first_a = opens_a ? children * node_a : node_a;
            const std::uint32_t first_b = opens_b ? children * node_b : node_b;
            alignas(64) std::array<std::uint8_t, most_children_of_pair> places{};
            simd::store_set_bits(places.data(), to_open);
            const auto count = static_cast<std::size_t>(std::popcount(to_open));
            std::size_t p = 0;
            do {  // almost always one iteration, so that the branch is predicted
                const auto place =
                    __builtin_convertvector(simd::load_eight<simd::eight_bytes>(&places[p]), simd::eight_words);
                simd::store_eight(&to.a[to.size + p], first_a + (place & 7U));
                simd::store_eight(&to.b[to.size + p], first_b + (place >> 3U));
                p += children;
            } while (p < count);
            to.size += count;
        }
    }

    /// Queues the pairs of triangles of these leaves whose boxes overlap, and tests them when a batch is full.
    /// @returns whether to stop
    template <class TrianglesAt, class Emit>
    [[nodiscard]] bool test_leaves(const Triangle& test, const model<Tree>& a, const model<Tree>& b,
                                   const relative_pose& to_a, extent what, std::span<const std::uint32_t> leaves_a,
                                   std::span<const std::uint32_t> leaves_b, const TrianglesAt& triangles_at,
                                   const Emit& emit) {
        // Inlined, because a call would cost up to a tenth of the work in it.
        const auto take = [&](std::size_t p, const read_leaf& of_a, const read_leaf& of_b,
                              std::uint64_t met) __attribute__((always_inline)) {
            if (what == extent::one_mesh) {
                if (leaves_a[p] == leaves_b[p]) met &= each_pair_once & distinct_children;
                if (emit_adjacent(met, leaves_a[p], leaves_b[p], triangles_at, emit)) return true;
                if (met == 0) return false;
            }
            queue_pairs(a.tree(), b.tree(), {leaves_a[p], leaves_b[p], met}, of_a.block, of_b.block);
            return waiting_.is_full() && waiting_.decide(test, false, triangles_at, emit);
        };
        return leaves_(a, b, to_a, leaves_a, leaves_b, counters_, take);
    }

    /// Queues pairs of triangles for the test, and prefetches the indices of the triangles.
    [[gnu::always_inline]] inline void queue_pairs(const Tree& a, const Tree& b, const front_pair& p,
                                                   const triangle_block& of_a, const triangle_block& of_b) {
        counters_.add(work::triangle_tests, static_cast<std::uint64_t>(std::popcount(p.which)));
        waiting_.add(p.which, p.leaf_a, of_a, p.leaf_b, of_b);
        a.prefetch_triangles(p.leaf_a);
        b.prefetch_triangles(p.leaf_b);
    }

    /// Reports adjacent triangles without a test, because an exact test always accepts a shared corner.
    /// @param met the overlapping pairs; reported pairs are removed
    /// @returns whether to stop
    template <class TrianglesAt, class Emit>
    [[nodiscard]] bool emit_adjacent(std::uint64_t& met, std::uint32_t leaf_a, std::uint32_t leaf_b,
                                     const TrianglesAt& triangles_at, const Emit& emit) const {
        if constexpr (is_filtered) {
            const std::uint64_t shared = leaves_.neighbours(leaf_a, leaf_b);
            std::array<index_pair, most_children_of_pair> neighbours;
            std::size_t count = 0;
            for (std::uint64_t left = met & shared; left != 0; left &= left - 1) {
                const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
                neighbours[count++] = triangles_at(leaf_a, place & 7U, leaf_b, place >> 3U);
            }
            met &= ~shared;
            return count != 0 && emit(std::span<const index_pair>(neighbours).first(count));
        }
        return false;
    }

    /// Pairs of children of the same node: i <= j, and i != j.
    static constexpr std::uint64_t each_pair_once = 0xff7f3f1f0f070301;
    static constexpr std::uint64_t distinct_children = 0x7fbfdfeff7fbfdfe;

    [[no_unique_address]] Counters counters_;
    level_steps steps_;
    std::vector<node_pairs> pairs_;  // by step
    child_pairs<Tree> children_;
    leaf_pairs<Tree> leaves_;
    triangle_batch<Triangle> waiting_;
    nearest_walk<Tree> nearest_;
};

}  // namespace aabb
