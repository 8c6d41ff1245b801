module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.local_detection:leaf_pairs;

import aabb.counters;
import aabb.geometry;
import :box_row;
import :corner_numbers;
import :eight_boxes;
import :leaf_slab;
import :leaf_store;
import :model;
import :triangle_block;
import :wide_tree_policy;

export namespace aabb {

/// Triangles of a leaf, in A's frame.
struct read_leaf {
    box_row bounds;
    eight_boxes boxes;
    triangle_block block;
    corner_numbers corners;  ///< of one mesh only
};

struct leaf_of_a : read_leaf {
    leaf_slab slab;
};

/// Reads the leaves of two trees, those of B in A's frame. A leaf meets many, so that it is kept.
template <WideTreePolicy Tree>
class leaf_pairs {
public:
    /// @param one_mesh whether both are the same, so that triangles may share corners
    void begin(const model<Tree>& a, const model<Tree>& b, bool one_mesh) {
        one_mesh_ = one_mesh;
        of_a_.begin(leaves(a));
        of_b_.begin(leaves(b));
    }

    /// Hands over, in order, those pairs of leaves whose triangles may meet: their boxes do, and those of B reach into
    /// the slab of A's leaf. One test is made of many pairs before the next, so that the processor need not guess,
    /// and writes a list of its own, so that nothing read waits for what was just written.
    /// @param take called with the place of a pair, its leaves and, bit 8 j + i for triangle i of A's leaf and j of
    /// B's, the pairs of triangles; returns whether to stop
    template <class Counters, class Take>
    [[nodiscard]] bool operator()(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                  std::span<const std::uint32_t> leaves_a, std::span<const std::uint32_t> leaves_b,
                                  Counters& counters, const Take& take) {
        for (std::size_t begin = 0; begin < leaves_a.size();) {
            std::size_t end = begin;
            of_a_.release_claims();
            of_b_.release_claims();
            while (end < leaves_a.size() && end - begin < most_at_once && of_a_.claim(leaves_a[end]) &&
                   of_b_.claim(leaves_b[end]))
                ++end;
            read(a, of_a_, [](leaf_of_a& leaf, const auto&... from) { leaf.block.load(from...); });
            read(b, of_b_, [&](read_leaf& leaf, const auto&... from) { leaf.block.load(from..., to_a); });
            counters.add(work::box_tests, end - begin);
            std::size_t near = 0;
            for (; begin < end; ++begin) {
                near_[near] = begin;
                near += of_a_[leaves_a[begin]].bounds.meets(of_b_[leaves_b[begin]].bounds);
            }
            std::size_t meeting = 0;
            for (const std::size_t p : std::span(near_).first(near)) {
                const leaf_of_a& of_a = of_a_[leaves_a[p]];
                const read_leaf& of_b = of_b_[leaves_b[p]];
                counters.add(work::box_tests, std::uint64_t{of_a.block.triangles} * of_b.block.triangles);
                const std::uint64_t which = of_a.boxes.overlaps(of_b.boxes);
                meeting_[meeting] = {p, which};
                meeting += which != 0;
            }
            std::size_t left = 0;
            for (const found& f : std::span(meeting_).first(meeting)) {
                const read_leaf& of_b = of_b_[leaves_b[f.pair]];
                const std::uint64_t which =
                    f.which & rows(of_a_[leaves_a[f.pair]].slab.reached_by(of_b.block, of_b.bounds.bounds()));
                left_[left] = {f.pair, which};
                left += which != 0;
            }
            for (const found& f : std::span(left_).first(left))
                if (take(f.pair, of_a_[leaves_a[f.pair]], of_b_[leaves_b[f.pair]], f.which)) return true;
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return of_a_.bytes() + of_b_.bytes(); }

private:
    static constexpr std::size_t width = triangle_block::width;
    static constexpr std::size_t most_at_once = leaf_store<leaf_of_a>::most_at_once;

    [[nodiscard]] static std::size_t leaves(const model<Tree>& m) noexcept {
        return (m.triangles().triangles.size() + width - 1) / width;
    }

    /// Reads what is missing. Memory is told of all of it first, so that it is waited for once.
    template <class Leaf, class Load>
    inline void read(const model<Tree>& m, leaf_store<Leaf>& store, const Load& load) {
        const std::span<const std::uint32_t> missing = store.take_missing();
        for (const std::uint32_t number : missing) m.tree().fetch(number);
        for (std::size_t i = 0; i < missing.size(); ++i) {
            m.tree().read_vertices(missing[i], lists_[i]);
            lists_[i].fetch(m.triangles());
        }
        for (std::size_t i = 0; i < missing.size(); ++i) {
            Leaf& leaf = store[missing[i]];
            load(leaf, m.triangles(), m.tree(), missing[i], lists_[i]);
            leaf.block.bounds(leaf.boxes);
            leaf.bounds = box_row(leaf.boxes);
            if constexpr (requires { leaf.slab; }) leaf.slab.fit(leaf.block, leaf.bounds.bounds());
            if (one_mesh_) leaf.corners.load(m.triangles(), m.tree(), missing[i]);
        }
    }

    struct found {
        std::size_t pair;
        std::uint64_t which;
    };

    /// All bits of row j for bit j.
    [[nodiscard]] static constexpr std::uint64_t rows(std::uint64_t which) noexcept {
        const std::uint64_t bit_of_row = which * 0x0101010101010101 & 0x8040201008040201;
        constexpr std::uint64_t low_bits = 0x7f7f7f7f7f7f7f7f;
        return ((((bit_of_row & low_bits) + low_bits) | bit_of_row) >> 7U & 0x0101010101010101) * 0xff;
    }

    bool one_mesh_ = false;
    leaf_store<leaf_of_a> of_a_;
    leaf_store<read_leaf> of_b_;
    std::array<std::size_t, most_at_once + 1> near_{};
    std::array<found, most_at_once + 1> meeting_{};
    std::array<found, most_at_once + 1> left_{};
    std::array<vertex_list, most_at_once + 1> lists_{};
};

}  // namespace aabb
