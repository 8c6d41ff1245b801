module;
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

export module aabb.local_detection:batched_walk;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.simd;
import :child_overlaps;
import :model;
import :triangle_batch;
import :triangle_block;
import :triangle_policy;
import :walk_goal;
import :wide_node;
import :wide_tree_policy;

export namespace aabb {

/// Walks two trees together, level by level: some node pairs of the lowest level that has any are opened at a time, so
/// that no step waits for the one before, and few pairs are kept. Triangles are read and moved once for all the leaves
/// that they meet one after the other, and tested in batches.
template <WideTreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class batched_walk {
public:
    /// Hands each pair of intersecting triangles (a of A, b of B) to `emit`, until that returns true.
    template <class Emit>
    void between(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                 walk_goal goal, Emit emit) {
        walk(test, a, b, to_a, extent::two_meshes, goal, emit);
    }

    /// Those of one mesh, in either order.
    template <class Emit>
    void within(const Triangle& test, const model<Tree>& m, Emit emit) {
        walk(test, m, m, relative_pose({}, {}, m.bounds()), extent::one_mesh, walk_goal::every_pair, emit);
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t all =
            sizeof waiting_ + bytes_of(pairs_) + bytes_of(steps_) + bytes_of(blocks_a_) + bytes_of(blocks_b_);
        for (const node_pairs& p : pairs_) all += bytes_of(p.a) + bytes_of(p.b);
        return all;
    }

private:
    static constexpr std::size_t children = wide_node::most_children;
    static constexpr std::size_t most_children_of_pair = children * children;
    static constexpr std::size_t most_at_once = 32;
    static constexpr std::size_t most_blocks = 32;  // a power of two

    enum class extent : std::uint8_t { two_meshes, one_mesh };

    /// Of which levels the nodes of a pair are.
    struct levels {
        std::size_t a;
        std::size_t b;
    };

    /// Node pairs of the same levels, still to be opened.
    struct node_pairs {
        std::vector<std::uint32_t> a;
        std::vector<std::uint32_t> b;
        std::size_t size = 0;

        /// For all pairs of children of one more pair.
        inline void make_room() {
            if (size + most_children_of_pair <= a.size()) return;
            b.resize(2 * size + most_children_of_pair);
            a.resize(2 * size + most_children_of_pair);
        }
    };

    /// The triangles of a leaf, of one query.
    struct kept_block {
        std::uint64_t query_and_leaf = 0;
        triangle_block block;
    };

    template <class Emit>
    void walk(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, extent what,
              walk_goal goal, Emit emit) {
        begin(a, b);
        // For the first pair few at a time: what lies beyond it is not needed.
        const std::size_t at_once = goal == walk_goal::first_pair ? 1 : most_at_once;
        const child_overlaps overlaps(to_a);
        const auto emit_pair = [&](std::uint32_t leaf_a, std::uint32_t i, std::uint32_t leaf_b, std::uint32_t j) {
            return emit(
                index_pair{a.tree().triangle_at(children * leaf_a + i), b.tree().triangle_at(children * leaf_b + j)});
        };
        for (std::size_t step = 0;;) {
            node_pairs& from = pairs_[step];
            if (from.size == 0) {
                if (step == 0) break;
                --step;
                continue;
            }
            const std::size_t end = from.size;
            const std::size_t begin = end - std::min(end, at_once);
            from.size = begin;
            counters_.add(work::node_visits, end - begin);
            if (step + 1 < steps_.size()) {
                open(a.tree(), b.tree(), overlaps, what, step, begin, end);
                ++step;
            } else {
                if (test_leaves(test, a, b, to_a, what, begin, end, emit_pair)) return;
                if (goal == walk_goal::first_pair && waiting_.decide(test, true, emit_pair)) return;
            }
        }
        static_cast<void>(waiting_.decide(test, true, emit_pair));
    }

    void begin(const model<Tree>& a, const model<Tree>& b) {
        require_ieee_arithmetic();
        a.require_fit();
        b.require_fit();
        steps_.clear();
        // The higher of two nodes is opened first, until both are leaves.
        levels now{a.tree().levels() - 1, b.tree().levels() - 1};
        steps_.push_back(now);
        while (now.a > 0 || now.b > 0) {
            const std::size_t higher = std::max(now.a, now.b);
            if (now.a == higher) --now.a;
            if (now.b == higher) --now.b;
            steps_.push_back(now);
        }
        if (pairs_.size() < steps_.size()) pairs_.resize(steps_.size());
        for (node_pairs& p : pairs_) p.size = 0;
        pairs_[0].make_room();
        pairs_[0].a[0] = pairs_[0].b[0] = 0;
        pairs_[0].size = 1;
        make_room(blocks_a_, a);
        make_room(blocks_b_, b);
        waiting_.clear();
        ++query_;
    }

    /// Those pairs of children that may meet go to the next step.
    void open(const Tree& a, const Tree& b, const child_overlaps& overlaps, extent what, std::size_t step,
              std::size_t begin, std::size_t end) {
        const levels at = steps_[step];
        const wide_node* const nodes_a = a.level(at.a);
        const wide_node* const nodes_b = b.level(at.b);
        const bool opens_a = steps_[step + 1].a < at.a;
        const bool opens_b = steps_[step + 1].b < at.b;
        const node_pairs& from = pairs_[step];
        node_pairs& to = pairs_[step + 1];
        for (std::size_t i = begin; i < end; ++i) {
            to.make_room();
            const std::uint32_t node_a = from.a[i];
            const std::uint32_t node_b = from.b[i];
            const wide_node& of_a = nodes_a[node_a];
            const wide_node& of_b = nodes_b[node_b];
            counters_.add(work::box_tests, std::uint64_t{of_a.children} * of_b.children);
            std::uint64_t met = overlaps(of_a, of_b);
            if (what == extent::one_mesh && node_a == node_b) met &= not_twice;
            if (!opens_a) met = any_of_columns(met);
            if (!opens_b) met = any_of_rows(met);
            const std::uint32_t first_a = opens_a ? children * node_a : node_a;
            const std::uint32_t first_b = opens_b ? children * node_b : node_b;
            alignas(64) std::array<std::uint8_t, most_children_of_pair> places{};
            simd::store_places(places.data(), met);
            const auto count = static_cast<std::size_t>(std::popcount(met));
            for (std::size_t p = 0; p < count; p += children) {
                const auto place =
                    __builtin_convertvector(simd::load_eight<simd::eight_bytes>(&places[p]), simd::eight_words);
                simd::store_eight(&to.a[to.size + p], first_a + (place & 7U));
                simd::store_eight(&to.b[to.size + p], first_b + (place >> 3U));
            }
            to.size += count;
        }
    }

    /// Pairs of leaves: those of their triangles that may meet wait for the test.
    /// @returns whether to stop
    template <class Emit>
    [[nodiscard]] bool test_leaves(const Triangle& test, const model<Tree>& a, const model<Tree>& b,
                                   const relative_pose& to_a, extent what, std::size_t begin, std::size_t end,
                                   const Emit& emit) {
        const node_pairs& from = pairs_[steps_.size() - 1];
        const wide_node* const leaves_a = a.tree().level(0);
        for (std::size_t p = begin; p < end; ++p) {
            const std::uint32_t leaf_a = from.a[p];
            const std::uint32_t leaf_b = from.b[p];
            const triangle_block& of_b = block(blocks_b_, b, leaf_b, [&](triangle_block& fresh) {
                fresh.move(to_a);
                fresh.bound();
            });
            counters_.add(work::box_tests, std::uint64_t{leaves_a[leaf_a].children} * of_b.triangles);
            std::uint64_t met = child_overlaps::leaves(leaves_a[leaf_a], of_b);
            if (what == extent::one_mesh && leaf_a == leaf_b) met &= not_twice & not_itself;
            if (met == 0) continue;
            counters_.add(work::triangle_tests, static_cast<std::uint64_t>(std::popcount(met)));
            waiting_.add(met, leaf_a, block(blocks_a_, a, leaf_a, [](triangle_block&) {}), leaf_b, of_b);
            if (waiting_.is_full() && waiting_.decide(test, false, emit)) return true;
        }
        return false;
    }

    /// As many as leaves, if they are few, else `most_blocks`.
    static void make_room(std::vector<kept_block>& kept, const model<Tree>& m) {
        const std::size_t leaves = (m.triangles().triangles.size() + children - 1) / children;
        kept.resize(std::max(kept.size(), std::min(most_blocks, std::bit_ceil(leaves))));
    }

    template <class Prepare>
    [[nodiscard]] const triangle_block& block(std::vector<kept_block>& kept, const model<Tree>& m, std::uint32_t leaf,
                                              Prepare prepare) {
        kept_block& place = kept[leaf & (kept.size() - 1)];
        const std::uint64_t wanted = query_ << 32U | leaf;
        if (place.query_and_leaf != wanted) {
            place.block.load(m.triangles(), m.tree(), leaf);
            prepare(place.block);
            place.query_and_leaf = wanted;
        }
        return place.block;
    }

    /// Child i of a node and child j of the same with i <= j, or i != j.
    static constexpr std::uint64_t not_twice = 0xff7f3f1f0f070301;
    static constexpr std::uint64_t not_itself = 0x7fbfdfeff7fbfdfe;

    /// Bit 8 j for every row j of which a bit is set.
    [[nodiscard]] static constexpr std::uint64_t any_of_columns(std::uint64_t met) noexcept {
        met |= met >> 4U;
        met |= met >> 2U;
        met |= met >> 1U;
        return met & 0x0101010101010101;
    }
    /// Bit i for every column i of which a bit is set.
    [[nodiscard]] static constexpr std::uint64_t any_of_rows(std::uint64_t met) noexcept {
        met |= met >> 32U;
        met |= met >> 16U;
        met |= met >> 8U;
        return met & 0xff;
    }

    [[no_unique_address]] Counters counters_;
    std::vector<levels> steps_;
    std::vector<node_pairs> pairs_;  // by step
    std::vector<kept_block> blocks_a_;
    std::vector<kept_block> blocks_b_;  // in A's frame, with boxes
    triangle_batch<Triangle> waiting_;
    std::uint64_t query_ = 0;
};

}  // namespace aabb
