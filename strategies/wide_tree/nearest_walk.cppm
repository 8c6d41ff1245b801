module;
#include <cassert>

export module aabb.wide_tree.nearest_walk;

import aabb.std;
import aabb.wide_tree.box_images;
export import aabb.wide_tree.level_steps;
export import aabb.wide_tree.wide_node;

export namespace aabb {

/// The pairs with the nearest centres: 8 j + i for child i of a node and box j.
struct nearest_places {
    std::uint32_t first;
    std::uint32_t second;  ///< equal to `first` if there is only one
};

/// Picks the two nearest pairs, by their centres, in the mask (bit 8 j + i for child i and box j), which must not be
/// empty. It computes all 64 distances, so that they do not depend on the mask.
[[nodiscard]] inline nearest_places find_two_nearest(std::uint64_t mask, const wide_node& node,
                                                     const eight_boxes& boxes) noexcept {
    // Rounding may decide which of two equally near pairs comes first; no result depends on that.
#pragma clang fp contract(fast)
    std::array<simd::eight_floats, 3> node_centres;
    std::array<eight_boxes::row, 3> box_centres;
    const auto floats_of = [](const quantized_aabbs::row& codes) {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_floats);
    };
    for (std::size_t k = 0; k < 3; ++k) {
        // Twice the coordinates of the centres, so that nothing is halved. Upper codes are stored as 255 - code.
        const auto step = static_cast<float>(node.step(k));
        const float twice_origin = 2 * static_cast<float>(node.origin[k]) + 255;
        node_centres[k] = (floats_of(node.planes.lower[k]) - floats_of(node.planes.upper[k]) + twice_origin) * step;
        simd::store_eight(box_centres[k].data(), simd::load_eight<simd::eight_floats>(boxes.lower[k].data()) +
                                                     simd::load_eight<simd::eight_floats>(boxes.upper[k].data()));
    }
    // A key is a squared distance whose last six bits are replaced by the pair 8 j + i. Keys compare like the
    // distances, as non-negative floats compare like their bits; NaN compares greater than any number.
    constexpr simd::eight_words indices{0, 1, 2, 3, 4, 5, 6, 7};
    constexpr simd::eight_words none = ~simd::eight_words{};
    simd::eight_words least = none;  // by child i: its least key, and its second least
    simd::eight_words next = none;
    for (std::uint32_t j = 0; j < eight_boxes::most; ++j) {
        simd::eight_floats distance{};
        for (std::size_t k = 0; k < 3; ++k) {
            const simd::eight_floats difference = node_centres[k] - box_centres[k][j];
            distance += difference * difference;
        }
        const simd::eight_words key = (__builtin_bit_cast(simd::eight_words, distance) & ~63U) | indices | 8 * j;
        // Pairs that the mask lacks get the greatest key.
        const simd::eight_words candidate = key | ~simd::flags_of_eight(static_cast<std::uint8_t>(mask >> (8 * j)));
        next = __builtin_elementwise_min(next, __builtin_elementwise_max(least, candidate));
        least = __builtin_elementwise_min(least, candidate);
    }
    const std::uint32_t nearest = __builtin_reduce_min(least);
    const std::uint32_t second = __builtin_reduce_min(least == nearest ? next : least);
    return {nearest & 63U, (second == none[0] ? nearest : second) & 63U};
}

/// Descends two trees to any intersecting pair of leaves: the nearest two children first, and after leaves that do not
/// intersect it restarts at a higher level. The descent is one chain of dependent steps, so that latency matters:
/// postponed pairs of children are stored as bit masks.
template <WideTreePolicy Tree>
class nearest_walk {
public:
    /// Visits pairs of leaves whose boxes may overlap, the likeliest hits first: descends to the nearest pair of
    /// children, postpones the others, by step, and goes some steps back after leaves that do not intersect.
    /// @param at_leaves called with a leaf of A and one of B; returns whether to stop
    template <class Counters, class AtLeaves>
    void for_each_leaf_pair(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, Counters& counters,
                            const AtLeaves& at_leaves) {
        begin(a.tree(), b.tree(), to_a);
        const std::size_t leaves = steps_.size() - 1;  // the step at which both nodes are leaves
        std::size_t missed = 0;                        // number of pairs of leaves without an intersection
        std::size_t step = 0;
        node_pair nodes{.a = 0, .b = 0};  // the roots
        for (;;) {
            counters.add(work::node_visits, 1);
            if (step < leaves) {
                const bool goes_on = descend_to_nearest(a.tree(), b.tree(), step, nodes, counters);
                ++step;
                if (goes_on) continue;
            } else {
                if (at_leaves(nodes.a, nodes.b)) return;
                // Near surfaces may be parallel everywhere, so that the next nearest leaves would not intersect,
                // either. So the walk restarts at the highest postponed pairs from two steps back on; after every
                // second miss from three steps back on, after every fourth from four: the frequencies of the universal
                // restart strategy (Luby, Sinclair, Zuckerman, "Optimal speedup of Las Vegas algorithms", 1993).
                step -= std::min(step, least_back + static_cast<std::size_t>(std::countr_zero(++missed)));
                const std::uint64_t below = postponed_steps_ >> step;  // bit s: step + s has postponed pairs
                step = below == 0 ? leaves : step + static_cast<std::size_t>(std::countr_zero(below));
            }
            if (postponed_steps_ == 0) return;
            // If this step has no postponed pairs, the walk goes on with those of the deepest step that has some.
            if ((postponed_steps_ & bit(step)) == 0)
                step = static_cast<std::size_t>(std::bit_width(postponed_steps_)) - 1;
            nodes = pop(step);
        }
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = steps_.bytes() + images_.bytes() + bytes_of(stacks_);
        for (const postponed_stack& s : stacks_) total += bytes_of(s.entries);
        return total;
    }

private:
    static constexpr std::uint32_t children = wide_node::most_children;
    static constexpr std::size_t least_back = 2;  // levels

    struct node_pair {
        std::uint32_t a;
        std::uint32_t b;
    };

    /// The postponed pairs of children of two nodes.
    struct postponed_children {
        node_pair first;
        std::uint64_t mask;  // bit 8 j + i for child i of A's node and j of B's
        std::uint32_t next;  // the pair to open next
    };

    /// The postponed pairs of one step, as a stack.
    struct postponed_stack {
        std::vector<postponed_children> entries;
        std::size_t size = 0;
    };

    /// Starts a query without postponed pairs.
    void begin(const Tree& a, const Tree& b, const relative_pose& to_a) {
        steps_.begin({a.levels(), b.levels()});
        if (stacks_.size() < steps_.size()) stacks_.resize(steps_.size());
        for (postponed_stack& s : stacks_) s.size = 0;
        assert(steps_.size() <= 64);
        postponed_steps_ = 0;
        images_.begin(b.level(0), nodes_of(b), to_a.to_boxes());
    }

    /// Descends to the pair of children with the nearest centres, and postpones the other overlapping pairs.
    /// @param step the number of steps from the roots, which determines the heights of both nodes
    /// @param nodes the indices of both nodes within their levels; changed to those of the nearest pair
    /// @returns whether any pair overlaps
    template <class Counters>
    [[nodiscard]] inline bool descend_to_nearest(const Tree& a, const Tree& b, std::size_t step, node_pair& nodes,
                                                 Counters& counters) {
        // Steps have heights: a node whose children are leaves has height 1, and is at level 0.
        const wide_node& node_a = a.level(steps_[step].a - 1)[nodes.a];
        const wide_node& node_b = b.level(steps_[step].b - 1)[nodes.b];
        counters.add(work::box_tests, std::uint64_t{node_a.children} * node_b.children);
        const eight_boxes& boxes = images_.of(node_b);  // of B's children, in A's frame
        const std::uint64_t mask = node_a.planes.overlaps(node_a.grid(), boxes);
        if (mask == 0) return false;
        const auto [first, second] = find_two_nearest(mask, node_a, boxes);
        const bool opens_a = steps_.opens_a(step);
        const bool opens_b = steps_.opens_b(step);
        // A step opens the higher node, or both. The masks have pairs 8 j + i: child i of A's node, child j of B's. All
        // are tested, but a node that is not opened stays in place of its children: its bits, i or j, are cleared, so
        // that several pairs become one.
        const std::uint32_t opened_bits = (opens_a ? 7U : 0U) | (opens_b ? 7U << 3U : 0U);
        const node_pair first_children{opens_a ? children * nodes.a : nodes.a, opens_b ? children * nodes.b : nodes.b};
        const std::uint32_t nearest = first & opened_bits;
        nodes = pair_of(first_children, nearest);
        const std::uint64_t others = steps_.pairs_to_open(step, mask) & ~bit(nearest);
        // If the second nearest has become the same pair, it is not among the others, and `postpone` picks another.
        if (others != 0) postpone(step + 1, first_children, others, second & opened_bits);
        return true;
    }

    /// The pair 8 j + i of the children that begin with the first pair.
    [[nodiscard]] static constexpr node_pair pair_of(const node_pair& first, std::uint32_t pair) noexcept {
        return {first.a + (pair & 7U), first.b + (pair >> 3U)};
    }

    /// Pushes the pairs of children in a mask (bit 8 j + i) onto the step's stack, to be opened later by `pop`.
    /// @param first the pair of the first children, to which i and j are added
    /// @param next the pair to open next, if the mask has it
    inline void postpone(std::size_t step, const node_pair& first, std::uint64_t mask, std::uint32_t next) {
        postponed_stack& stack = stacks_[step];
        if (stack.size == stack.entries.size()) stack.entries.resize(2 * stack.size + children);
        postponed_children& entry = stack.entries[stack.size++];
        entry.first = first;
        entry.mask = mask;
        entry.next = (mask & bit(next)) != 0 ? next : last_of(mask);
        postponed_steps_ |= bit(step);
    }

    /// Pops a pair of nodes from the step's last entry, and drops the entry with its last pair.
    [[nodiscard]] inline node_pair pop(std::size_t step) noexcept {
        postponed_stack& stack = stacks_[step];
        postponed_children& entry = stack.entries[stack.size - 1];
        const node_pair popped = pair_of(entry.first, entry.next);
        entry.mask &= ~bit(entry.next);
        if (entry.mask != 0)
            entry.next = last_of(entry.mask);
        else if (--stack.size == 0)
            postponed_steps_ &= ~bit(step);
        return popped;
    }

    [[nodiscard]] static constexpr std::uint64_t bit(std::size_t index) noexcept { return std::uint64_t{1} << index; }
    [[nodiscard]] static constexpr std::uint32_t last_of(std::uint64_t mask) noexcept {
        return static_cast<std::uint32_t>(std::bit_width(mask)) - 1;
    }

    level_steps steps_;
    image_cache images_;                   // of nodes of B, in A's frame
    std::vector<postponed_stack> stacks_;  // by step
    std::uint64_t postponed_steps_ = 0;    // bit s: step s has postponed pairs
};

}  // namespace aabb
