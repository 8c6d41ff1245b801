export module aabb.wide_tree.child_pairs;

import aabb.std;
import aabb.wide_tree.box_images;
export import aabb.wide_tree.wide_node;

export namespace aabb {

/// Tests which children of pairs of nodes may meet, all 64 pairs of a node pair at once. The boxes of B's children are
/// transformed into A's frame and compared with those of A's node. If the rotation inflates them much, A's boxes are
/// tested in B's frame as well. A node occurs in many pairs, so that its transformed boxes are cached.
template <WideTreePolicy Tree>
class child_pairs {
public:
    /// @param margin the distance up to which children count as meeting
    void begin(const Tree& a, const Tree& b, const relative_pose& to_a, const box& bounds_of_a, double margin) {
        images_in_a_.begin(b.level(0), nodes_of(b), grown(to_a.to_boxes(), margin));
        tests_in_b_ = to_a.is_rigid() && to_a.growth() > least_growth;
        if (tests_in_b_) images_in_b_.begin(a.level(0), nodes_of(a), grown(to_a.back_to_boxes(bounds_of_a), margin));
    }

    static constexpr std::size_t most_at_once = 64;

    /// A pair of nodes, and its overlapping children: bit 8 j + i of the mask for child i of A's node and j of B's.
    struct overlap {
        std::size_t pair;
        std::uint64_t mask;
    };

    /// Returns, in order, the pairs of nodes, at most `most_at_once`, with overlapping children, and masks of these; no
    /// false negatives. Nodes are prefetched, and each test runs over all pairs, against cache misses and
    /// mispredictions.
    /// @param nodes_a,nodes_b the nodes of a level of each tree
    /// @param a,b pair p is of the nodes at the indices a[p] and b[p]
    template <class Counters>
    [[nodiscard]] std::span<const overlap> find_overlapping(const wide_node* nodes_a, std::span<const std::uint32_t> a,
                                                            const wide_node* nodes_b, std::span<const std::uint32_t> b,
                                                            Counters& counters) {
        for (std::size_t p = 0; p < a.size(); ++p) {
            __builtin_prefetch(&nodes_a[a[p]]);
            __builtin_prefetch(&nodes_b[b[p]]);
        }
        std::uint64_t tests = 0;
        std::size_t count = 0;
        for (std::size_t p = 0; p < a.size(); ++p) {
            const wide_node& node_a = nodes_a[a[p]];
            const wide_node& node_b = nodes_b[b[p]];
            tests += std::uint64_t{node_a.children} * node_b.children;
            const std::uint64_t mask = node_a.planes.overlaps(node_a.grid(), images_in_a_.of(node_b));
            // No branch: a pair without overlapping children is overwritten by the next one.
            in_a_[count] = {p, mask};
            count += mask != 0;
        }
        std::span<const overlap> overlapping = std::span(in_a_).first(count);
        // The rotation inflates the boxes of B's children much: those of A's children are tested in B's frame, too.
        if (tests_in_b_) {
            count = 0;
            for (const auto& [p, mask_in_a] : overlapping) {
                const wide_node& node_a = nodes_a[a[p]];
                const wide_node& node_b = nodes_b[b[p]];
                tests += std::uint64_t{node_a.children} * node_b.children;
                const std::uint64_t mask =
                    mask_in_a & transposed(node_b.planes.overlaps(node_b.grid(), images_in_b_.of(node_a)));
                in_both_[count] = {p, mask};
                count += mask != 0;
            }
            overlapping = std::span(in_both_).first(count);
        }
        counters.add(work::box_tests, tests);
        return overlapping;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return images_in_a_.bytes() + images_in_b_.bytes(); }

private:
    static constexpr double least_growth = 1.2;  // above, the second test saves more than it costs

    /// A rigid pose is a rotation within 1e-6, so that lengths in both frames agree within 2^-18.
    [[nodiscard]] static box_motion grown(box_motion motion, double margin) noexcept {
        for (int k = 0; k < 3; ++k) motion.margin[k] += margin * (1 + 0x1p-16);
        return motion;
    }

    /// Transposes the 8 by 8 bits by swapping off-diagonal blocks of 1, 2 and 4 bits: bit 8 i + j becomes bit 8 j + i.
    [[nodiscard]] static constexpr std::uint64_t transposed(std::uint64_t m) noexcept {
        const auto swap_bits = [&m](unsigned distance, std::uint64_t lower_bits) {
            const std::uint64_t changed = (m ^ m >> distance) & lower_bits;
            m ^= changed ^ changed << distance;
        };
        swap_bits(7, 0x00aa00aa00aa00aa);
        swap_bits(14, 0x0000cccc0000cccc);
        swap_bits(28, 0x00000000f0f0f0f0);
        return m;
    }

    image_cache images_in_a_;  // nodes of B
    image_cache images_in_b_;  // nodes of A
    bool tests_in_b_ = false;
    std::array<overlap, most_at_once> in_a_{};
    std::array<overlap, most_at_once> in_both_{};
};

}  // namespace aabb
