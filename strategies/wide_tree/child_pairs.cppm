export module aabb.wide_tree.child_pairs;

import aabb.std;
import aabb.wide_tree.box_images;
export import aabb.wide_tree.policy;

export namespace aabb {

/// Tests which children of pairs of nodes may meet, all 64 pairs of a node pair at once. The boxes of B's children are
/// transformed into A's frame and compared with those of A's node. If the rotation inflates them much, A's boxes are
/// tested in B's frame as well. A node occurs in many pairs, so that its transformed boxes are cached.
template <WideTreePolicy Tree>
class child_pairs {
public:
    /// @param margin the distance up to which children count as meeting
    void begin(const Tree& a, const Tree& b, const relative_pose& to_a, const box& bounds_of_a, double margin) {
        in_a_.begin(b.level(0), nodes_of(b), grown(to_a.to_boxes(), margin));
        turned_ = to_a.growth() > least_growth;
        if (turned_) in_b_.begin(a.level(0), nodes_of(a), grown(to_a.back_to_boxes(bounds_of_a), margin));
    }

    static constexpr std::size_t most_at_once = 64;

    /// A pair of nodes, and its overlapping children: bit 8 j + i of `met` for child i of A's node and child j of B's.
    struct found {
        std::size_t pair;
        std::uint64_t met;
    };

    /// Returns, in order, those of up to `most_at_once` pairs of nodes that have overlapping children. There are no
    /// false negatives. All nodes are prefetched first, so that their cache misses overlap, and each test runs over all
    /// pairs before the next one starts, which avoids branch mispredictions.
    /// @param nodes_a the nodes of a level, which `a` indexes
    template <class Counters>
    [[nodiscard]] std::span<const found> operator()(const wide_node* nodes_a, std::span<const std::uint32_t> a,
                                                    const wide_node* nodes_b, std::span<const std::uint32_t> b,
                                                    Counters& counters) {
        for (std::size_t p = 0; p < a.size(); ++p) {
            __builtin_prefetch(&nodes_a[a[p]]);
            __builtin_prefetch(&nodes_b[b[p]]);
        }
        std::uint64_t tests = 0;
        std::size_t left = 0;
        for (std::size_t p = 0; p < a.size(); ++p) {
            const wide_node& of_a = nodes_a[a[p]];
            const wide_node& of_b = nodes_b[b[p]];
            tests += pairs(of_a, of_b);
            const std::uint64_t met = of_a.planes.overlaps(of_a.grid(), in_a_(of_b));
            in_one_[left] = {p, met};
            left += met != 0;
        }
        std::span<const found> meeting = std::span(in_one_).first(left);
        if (turned_) {
            left = 0;
            for (const auto& [p, met_in_a] : meeting) {
                const wide_node& of_a = nodes_a[a[p]];
                const wide_node& of_b = nodes_b[b[p]];
                tests += pairs(of_a, of_b);
                const std::uint64_t met = met_in_a & transposed(of_b.planes.overlaps(of_b.grid(), in_b_(of_a)));
                in_both_[left] = {p, met};
                left += met != 0;
            }
            meeting = std::span(in_both_).first(left);
        }
        counters.add(work::box_tests, tests);
        return meeting;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return in_a_.bytes() + in_b_.bytes(); }

private:
    static constexpr double least_growth = 1.2;  // above, the second test saves more than it costs

    /// A pose is a rotation within 1e-6, so that lengths in both frames agree within 2^-18.
    [[nodiscard]] static box_motion grown(box_motion motion, double margin) noexcept {
        for (int k = 0; k < 3; ++k) motion.margin[k] += margin * (1 + 0x1p-16);
        return motion;
    }
    [[nodiscard]] static inline std::uint64_t pairs(const wide_node& a, const wide_node& b) noexcept {
        return std::uint64_t{a.children} * b.children;
    }

    /// Transposes the matrix: bit 8 i + j becomes bit 8 j + i.
    [[nodiscard]] static constexpr std::uint64_t transposed(std::uint64_t m) noexcept {
        const auto swap = [&m](unsigned by, std::uint64_t which) {
            const std::uint64_t changed = (m ^ m >> by) & which;
            m ^= changed ^ changed << by;
        };
        swap(7, 0x00aa00aa00aa00aa);
        swap(14, 0x0000cccc0000cccc);
        swap(28, 0x00000000f0f0f0f0);
        return m;
    }

    image_cache in_a_;  // nodes of B
    image_cache in_b_;  // nodes of A
    bool turned_ = false;
    std::array<found, most_at_once> in_one_{};
    std::array<found, most_at_once> in_both_{};
};

}  // namespace aabb
