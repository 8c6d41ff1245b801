module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.local_detection:leaf_reader;

import aabb.geometry;
import :leaf_store;
import :model;
import :triangle_block;
import :vertex_lists;
import :wide_tree_policy;

export namespace aabb {

template <WideTreePolicy Tree>
[[nodiscard]] std::size_t leaves_of(const model<Tree>& m) noexcept {
    return (m.triangles().triangles.size() + triangle_block::width - 1) / triangle_block::width;
}

/// Reads the leaves of pairs, group by group: of as many pairs at a time as two stores have places for. Memory is told
/// of a group's lists of vertices while the group before is tested, and of vertices some leaves before they are read.
/// Not of all at once: a processor drops requests beyond some twenty that are under way.
template <WideTreePolicy Tree>
class leaf_reader {
public:
    /// Claims the leaves of pairs for the next group, once those of the group before are made, which can be read until
    /// the next ones are. Memory is told of the lists of those that are missing.
    /// @param begin of the group
    /// @param end of all pairs
    /// @param pair_at the leaves of pair i, of A's tree and of B's
    /// @returns the end of the group
    template <class LeafOfA, class LeafOfB, class PairAt>
    [[nodiscard]] inline std::size_t claim(const model<Tree>& a, leaf_store<LeafOfA>& of_a, const model<Tree>& b,
                                           leaf_store<LeafOfB>& of_b, std::size_t begin, std::size_t end,
                                           const PairAt& pair_at) {
        end = std::min(end, begin + most_claims);
        of_a.release_claims();
        of_b.release_claims();
        for (; begin < end; ++begin) {
            const auto [leaf_a, leaf_b] = pair_at(begin);
            if (!of_a.claim(leaf_a) || !of_b.claim(leaf_b)) break;
        }
        missing_a_ = of_a.take_missing();
        missing_b_ = of_b.take_missing();
        for (const std::uint32_t number : missing_a_) a.tree().fetch_vertices(number);
        for (const std::uint32_t number : missing_b_) b.tree().fetch_vertices(number);
        return begin;
    }

    /// Makes those leaves of the group that are missing in A's store.
    /// @param steps each called for all of them before the next, as `step(leaf, number, its vertices)`, so that none
    /// waits for what was made just before
    template <class Leaf, class... Steps>
    inline void make_a(const model<Tree>& a, leaf_store<Leaf>& store, const Steps&... steps) {
        make(a, missing_a_, store, steps...);
    }
    /// The same of B's.
    template <class Leaf, class... Steps>
    inline void make_b(const model<Tree>& b, leaf_store<Leaf>& store, const Steps&... steps) {
        make(b, missing_b_, store, steps...);
    }

private:
    static constexpr std::size_t ahead = 10;  // leaves, of which most vertices are in the caches already

    template <class Leaf, class First, class... Others>
    inline void make(const model<Tree>& m, std::span<const std::uint32_t> missing, leaf_store<Leaf>& store,
                     const First& first, const Others&... others) {
        const auto fetch = [&](std::size_t i) {
            m.tree().read_vertices(missing[i], lists_[i]);
            lists_[i].fetch(m.triangles());
        };
        const auto do_step = [&](std::size_t i, const auto& step) { step(store[missing[i]], missing[i], lists_[i]); };
        for (std::size_t i = 0; i < std::min(ahead, missing.size()); ++i) fetch(i);
        for (std::size_t i = 0; i < missing.size(); ++i) {
            if (i + ahead < missing.size()) fetch(i + ahead);
            do_step(i, first);
        }
        const auto do_all = [&](const auto& step) {
            for (std::size_t i = 0; i < missing.size(); ++i) do_step(i, step);
        };
        (do_all(others), ...);
    }

    std::span<const std::uint32_t> missing_a_;
    std::span<const std::uint32_t> missing_b_;
    std::array<vertex_list, most_claims + 1> lists_{};
};

}  // namespace aabb
