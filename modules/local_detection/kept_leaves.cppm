module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

export module aabb.local_detection:kept_leaves;

import aabb.geometry;
import :leaf_front;
import :leaf_reader;
import :leaf_store;
import :model;
import :triangle_block;
import :vertex_lists;
import :wide_tree_policy;

export namespace aabb {

/// Reads the triangles of pairs of leaves of which is known which may meet, those of B in A's frame.
template <WideTreePolicy Tree>
class kept_leaves {
public:
    /// @param read shared with others
    /// @param take called with a pair and the triangles of both leaves; returns whether to stop
    template <class Take>
    [[nodiscard]] bool operator()(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                  std::span<const kept_pair> pairs, leaf_reader<Tree>& read, const Take& take) {
        of_a_.begin(leaves_of(a));
        of_b_.begin(leaves_of(b));
        const auto claim = [&](std::size_t begin) {
            return read.claim(a, of_a_, b, of_b_, begin, pairs.size(),
                              [&](std::size_t i) { return std::pair(pairs[i].leaf_a, pairs[i].leaf_b); });
        };
        std::size_t begin = 0;
        std::size_t end = claim(begin);
        while (begin < end) {
            read.make_a(a, of_a_, [&](triangle_block& leaf, std::uint32_t number, const vertex_list& vertices) {
                leaf.load(a.triangles(), a.tree(), number, vertices);
            });
            read.make_b(b, of_b_, [&](triangle_block& leaf, std::uint32_t number, const vertex_list& vertices) {
                leaf.load(b.triangles(), b.tree(), number, vertices, to_a);
            });
            const std::size_t next = claim(end);
            for (const kept_pair& p : pairs.subspan(begin, end - begin))
                if (take(p, of_a_[p.leaf_a], of_b_[p.leaf_b])) return true;
            begin = end;
            end = next;
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return of_a_.bytes() + of_b_.bytes(); }

private:
    leaf_store<triangle_block> of_a_;
    leaf_store<triangle_block> of_b_;
};

}  // namespace aabb
