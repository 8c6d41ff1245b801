/// An index of boxes, in which other boxes are looked up.
module aabb.collision_filter:box_index;

import aabb.geometry;
import aabb.simd;
import aabb.std;

namespace aabb {

/// A packed R-tree of boxes, eight per node. The children of node i of a level are the nodes 8 i to 8 i + 7 of the
/// level below, so that no node stores where they are. Boxes are ordered as by a k-d tree (Friedman, Bentley and
/// Finkel, "An algorithm for finding best matches in logarithmic expected time", 1977): cut in halves across the axis
/// on which their centres spread most. Only comparisons of boxes decide what a query finds; centres only decide how
/// fast.
class box_index {
public:
    /// Empties the index; boxes that are added are in it once it is built. All keep the memory.
    void clear() noexcept {
        entries_.clear();
        levels_ = 0;
    }
    void add(std::uint32_t id, const box& b) {
        vec3f centre{};
        for (int k = 0; k < 3; ++k) centre[k] = b.min[k] / 2 + b.max[k] / 2;
        entries_.push_back({centre, id});
    }
    /// @param boxes by id
    void build(std::span<const box> boxes) {
        order(entries_);
        levels_ = 0;
        std::size_t nodes = 0;
        std::size_t in_level = entries_.size();
        do {
            in_level = nodes_for(in_level);
            first_nodes_[levels_++] = static_cast<std::uint32_t>(nodes);
            nodes += in_level;
        } while (in_level > 1);
        nodes_.assign(nodes, node());
        refit(boxes);
    }

    /// Replaces every box by one of the same id.
    /// @param boxes by id
    void refit(std::span<const box> boxes) {
        for (std::size_t i = 0; i < entries_.size(); ++i) nodes_[i / 8].set(i % 8, boxes[entries_[i].id]);
        for (std::uint32_t level = 1; level < levels_; ++level)
            for (std::uint32_t i = first_nodes_[level - 1]; i < first_nodes_[level]; ++i) {
                const std::uint32_t place = i - first_nodes_[level - 1];
                nodes_[first_nodes_[level] + place / 8].set(place % 8, nodes_[i].bounds());
            }
    }

    /// Calls `take` with the id of each box that overlaps this one, in unspecified order.
    /// @returns the number of opened nodes; each tests eight boxes
    template <class Take>
    std::size_t query(const box& b, Take take) const {
        if (entries_.empty()) return 0;
        const query_box wanted(b);
        std::array<position, 8 * most_levels> stack;
        std::size_t waiting = 0;
        stack[waiting++] = {levels_ - 1, 0};
        std::size_t opened = 0;
        while (waiting > 0) {
            const position at = stack[--waiting];
            ++opened;
            const node& n = nodes_[first_nodes_[at.level] + at.node];
            for (std::uint32_t hits = n.overlapping(wanted); hits != 0; hits &= hits - 1) {
                const std::uint32_t child = 8 * at.node + static_cast<std::uint32_t>(std::countr_zero(hits));
                if (at.level == 0)
                    take(entries_[child].id);
                else
                    stack[waiting++] = {at.level - 1, child};
            }
        }
        return opened;
    }

    /// A guess at the number of nodes that a query opens: two of each level.
    [[nodiscard]] static double expected_nodes(std::size_t boxes) noexcept {
        const std::size_t levels = (static_cast<std::size_t>(std::bit_width(boxes)) + 2) / 3;
        return 2 * static_cast<double>(levels);
    }

    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(entries_, nodes_); }

private:
    static constexpr std::size_t most_levels = 11;  // 8^11 > 2^32 boxes

    struct entry {
        vec3f centre;
        std::uint32_t id;
    };

    struct query_box {
        explicit query_box(const box& b) {
            for (std::size_t k = 0; k < 3; ++k) {
                lower[k] = simd::eight_floats{} + b.min[static_cast<int>(k)];
                upper[k] = simd::eight_floats{} + b.max[static_cast<int>(k)];
            }
        }
        std::array<simd::eight_floats, 3> lower, upper;
    };

    /// Eight boxes; empty ones, which overlap nothing, if there are fewer.
    struct node {
        node() {
            constexpr box none = empty_box();
            for (std::size_t lane = 0; lane < 8; ++lane) set(lane, none);
        }
        void set(std::size_t lane, const box& b) {
            for (std::size_t k = 0; k < 3; ++k) {
                min[k][lane] = b.min[static_cast<int>(k)];
                max[k][lane] = b.max[static_cast<int>(k)];
            }
        }
        [[nodiscard]] box bounds() const {
            using simd::eight_floats, simd::load_eight;
            box whole{};
            for (std::size_t k = 0; k < 3; ++k) {
                whole.min[static_cast<int>(k)] = simd::least(load_eight<eight_floats>(min[k].data()));
                whole.max[static_cast<int>(k)] = -simd::least(-load_eight<eight_floats>(max[k].data()));
            }
            return whole;
        }
        /// The lanes whose boxes overlap, a bit each.
        [[nodiscard]] std::uint32_t overlapping(const query_box& q) const {
            using simd::eight_floats, simd::load_eight;
            return simd::bits_of_eight((load_eight<eight_floats>(min[0].data()) <= q.upper[0]) &
                                       (load_eight<eight_floats>(max[0].data()) >= q.lower[0]) &
                                       (load_eight<eight_floats>(min[1].data()) <= q.upper[1]) &
                                       (load_eight<eight_floats>(max[1].data()) >= q.lower[1]) &
                                       (load_eight<eight_floats>(min[2].data()) <= q.upper[2]) &
                                       (load_eight<eight_floats>(max[2].data()) >= q.lower[2]));
        }

        std::array<std::array<float, 8>, 3> min, max;
    };

    struct position {
        std::uint32_t level, node;
    };

    [[nodiscard]] static std::size_t nodes_for(std::size_t children) noexcept { return (children + 7) / 8; }

    /// Orders entries so that those of every node are together. Each part is cut between two of the greatest nodes that
    /// are smaller than it, in the middle of these nodes.
    static void order(std::span<entry> part) {
        std::size_t in_node = 8;
        if (part.size() <= in_node) return;
        while (8 * in_node < part.size()) in_node *= 8;
        const std::size_t nodes = (part.size() + in_node - 1) / in_node;
        const std::size_t left = nodes / 2 * in_node;
        box spread = empty_box();
        for (const entry& e : part) spread = merged(spread, bounds_of(e.centre));
        std::ranges::nth_element(part, part.begin() + static_cast<std::ptrdiff_t>(left), {},
                                 [axis = longest_axis(spread)](const entry& e) { return e.centre[axis]; });
        order(part.first(left));
        order(part.subspan(left));
    }

    std::vector<entry> entries_;                            // in the order of the leaves
    std::vector<node> nodes_;                               // by level, from the leaves to the root
    std::array<std::uint32_t, most_levels> first_nodes_{};  // by level
    std::uint32_t levels_ = 0;
};

}  // namespace aabb
