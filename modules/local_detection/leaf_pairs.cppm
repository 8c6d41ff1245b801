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
import :leaf_reader;
import :leaf_slab;
import :leaf_store;
import :model;
import :triangle_block;
import :vertex_lists;
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
    /// @param margin within which triangles are said to meet
    void begin(const model<Tree>& a, const model<Tree>& b, bool one_mesh, float margin) {
        one_mesh_ = one_mesh;
        margin_ = margin;
        of_a_.begin(leaves_of(a));
        of_b_.begin(leaves_of(b));
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
            const group meeting = meet(a, b, to_a, leaves_a, leaves_b, begin, counters);
            begin = meeting.end;
            std::size_t left = 0;
            for (const found& f : meeting.pairs) {
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

    /// Hands over in the same way those pairs of triangles that may come within the margin.
    template <class Counters, class Take>
    void within_margin(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                       std::span<const std::uint32_t> leaves_a, std::span<const std::uint32_t> leaves_b,
                       Counters& counters, const Take& take) {
        for (std::size_t begin = 0; begin < leaves_a.size();) {
            const group meeting = meet(a, b, to_a, leaves_a, leaves_b, begin, counters);
            begin = meeting.end;
            for (const found& f : meeting.pairs) {
                const leaf_of_a& of_a = of_a_[leaves_a[f.pair]];
                const read_leaf& of_b = of_b_[leaves_b[f.pair]];
                leaf_slab slab_of_b;
                slab_of_b.fit(of_b.block, of_b.bounds.bounds());
                const std::uint64_t which = f.which &
                                            rows(of_a.slab.reached_by(of_b.block, of_b.bounds.bounds(), margin_)) &
                                            columns(slab_of_b.reached_by(of_a.block, of_a.bounds.bounds(), margin_));
                if (which != 0) take(f.pair, which);
            }
        }
    }

    [[nodiscard]] leaf_reader<Tree>& reader() noexcept { return reader_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return of_a_.bytes() + of_b_.bytes(); }

private:
    static constexpr std::size_t most_at_once = most_claims;

    /// @param frame of B
    template <class Leaf, class... Frame>
    inline void read(const model<Tree>& m, leaf_store<Leaf>& store, const Frame&... frame) {
        reader_(
            m, store,
            [&](Leaf& leaf, std::uint32_t number, const vertex_list& vertices) {
                leaf.block.load(m.triangles(), m.tree(), number, vertices, frame...);
            },
            [&](Leaf& leaf, std::uint32_t number, const vertex_list&) {
                leaf.block.bounds(leaf.boxes);
                if constexpr (sizeof...(frame) > 0)
                    if (margin_ > 0) leaf.boxes.grow(margin_);
                leaf.bounds = box_row(leaf.boxes);
                if (one_mesh_) leaf.corners.load(m.triangles(), m.tree(), number);
            },
            [&](Leaf& leaf, std::uint32_t, const vertex_list&) {
                if constexpr (requires { leaf.slab; }) leaf.slab.fit(leaf.block, leaf.bounds.bounds());
            });
    }

    struct found {
        std::size_t pair;
        std::uint64_t which;
    };
    struct group {
        std::span<const found> pairs;
        std::size_t end;
    };

    /// Of as many pairs from `begin` on as there are places for, those whose triangles have boxes that meet.
    template <class Counters>
    [[nodiscard]] inline group meet(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                    std::span<const std::uint32_t> leaves_a, std::span<const std::uint32_t> leaves_b,
                                    std::size_t begin, Counters& counters) {
        std::size_t end = begin;
        of_a_.release_claims();
        of_b_.release_claims();
        while (end < leaves_a.size() && end - begin < most_at_once && of_a_.claim(leaves_a[end]) &&
               of_b_.claim(leaves_b[end]))
            ++end;
        read(a, of_a_);
        read(b, of_b_, to_a);
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
        return {std::span(meeting_).first(meeting), end};
    }

    /// All bits of row j for bit j.
    [[nodiscard]] static constexpr std::uint64_t rows(std::uint64_t which) noexcept {
        const std::uint64_t bit_of_row = which * 0x0101010101010101 & 0x8040201008040201;
        constexpr std::uint64_t low_bits = 0x7f7f7f7f7f7f7f7f;
        return ((((bit_of_row & low_bits) + low_bits) | bit_of_row) >> 7U & 0x0101010101010101) * 0xff;
    }

    /// Bit i of each row for bit i.
    [[nodiscard]] static constexpr std::uint64_t columns(std::uint64_t which) noexcept {
        return which * 0x0101010101010101;
    }

    bool one_mesh_ = false;
    float margin_ = 0;
    leaf_store<leaf_of_a> of_a_;
    leaf_store<read_leaf> of_b_;
    std::array<std::size_t, most_at_once + 1> near_{};
    std::array<found, most_at_once + 1> meeting_{};
    std::array<found, most_at_once + 1> left_{};
    leaf_reader<Tree> reader_;
};

}  // namespace aabb
