/// An index of boxes that do not move.
module aabb.collision_filter:box_index;

import aabb.geometry;
import aabb.simd;
import aabb.std;

namespace aabb {

/// A packed R-tree of boxes, eight per node, built by sort-tile-recursive packing (Leutenegger, Lopez and Edgington,
/// "STR: a simple and efficient algorithm for R-tree packing", ICDE 1997). The children of node i of a level are the
/// nodes 8 i to 8 i + 7 of the level below, so that no node stores where they are. Only comparisons decide what a query
/// finds; the centres by which boxes are sorted only decide how fast.
class box_index {
public:
    struct entry {
        box bounds;
        std::uint32_t id;
    };

    /// Replaces the contents.
    void build(std::vector<entry>& entries) {
        sort(entries);
        ids_.clear();
        for (const entry& e : entries) ids_.push_back(e.id);
        levels_.clear();
        std::size_t nodes = nodes_for(entries.size());
        for (; nodes > 1; nodes = nodes_for(nodes)) levels_.emplace_back(nodes);
        levels_.emplace_back(nodes);
        for (std::size_t i = 0; i < entries.size(); ++i) levels_[0][i / 8].set(i % 8, entries[i].bounds);
        fit_upper_levels();
    }

    /// Replaces every box by one of the same id.
    /// @param boxes by id
    void refit(std::span<const box> boxes) {
        for (std::size_t i = 0; i < ids_.size(); ++i) levels_[0][i / 8].set(i % 8, boxes[ids_[i]]);
        fit_upper_levels();
    }

    /// Calls `take` with the id of each box that overlaps this one, in unspecified order.
    /// @returns the number of boxes that were tested
    template <class Take>
    std::size_t query(const box& b, Take take) const {
        if (ids_.empty()) return 0;
        const query_box wanted(b);
        std::array<position, 8 * most_levels> stack;
        std::size_t waiting = 0;
        stack[waiting++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
        std::size_t tested = 0;
        while (waiting > 0) {
            const position at = stack[--waiting];
            ++tested;
            for (std::uint32_t hits = levels_[at.level][at.node].overlapping(wanted); hits != 0; hits &= hits - 1) {
                const std::uint32_t child = 8 * at.node + static_cast<std::uint32_t>(std::countr_zero(hits));
                if (at.level == 0)
                    take(ids_[child]);
                else
                    stack[waiting++] = {at.level - 1, child};
            }
        }
        return 8 * tested;
    }

    [[nodiscard]] std::size_t size() const noexcept { return ids_.size(); }
    void clear() noexcept {
        ids_.clear();
        levels_.clear();
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = bytes_of(ids_, levels_);
        for (const std::vector<node>& level : levels_) total += bytes_of(level);
        return total;
    }

private:
    static constexpr std::size_t most_levels = 11;  // 8^11 > 2^32 boxes

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
            box all = empty_box();
            for (std::size_t lane = 0; lane < 8; ++lane)
                all = merged(all,
                             {{min[0][lane], min[1][lane], min[2][lane]}, {max[0][lane], max[1][lane], max[2][lane]}});
            return all;
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

    void fit_upper_levels() {
        for (std::size_t level = 1; level < levels_.size(); ++level)
            for (std::size_t i = 0; i < levels_[level - 1].size(); ++i)
                levels_[level][i / 8].set(i % 8, levels_[level - 1][i].bounds());
    }

    static void sort_by_centre(std::span<entry> entries, int axis) {
        const auto centre = [axis](const entry& e) { return double{e.bounds.min[axis]} + double{e.bounds.max[axis]}; };
        std::ranges::sort(entries, [&](const entry& e, const entry& f) {
            return centre(e) < centre(f) || (centre(e) == centre(f) && e.id < f.id);
        });
    }

    /// Calls `take` with parts of about equal size, multiples of eight but for the last.
    template <class Take>
    static void tile(std::span<entry> entries, std::size_t parts, Take take) {
        const std::size_t size = 8 * nodes_for((entries.size() + parts - 1) / parts);
        for (; !entries.empty(); entries = entries.subspan(std::min(size, entries.size())))
            take(entries.first(std::min(size, entries.size())));
    }

    /// Sorts into slabs along x, rows along y and leaves along z, of about as many leaves each way.
    static void sort(std::span<entry> entries) {
        const auto leaves = [](std::span<entry> part) { return static_cast<double>(nodes_for(part.size())); };
        const auto rounded_up = [](double x) {
            return std::max<std::size_t>(static_cast<std::size_t>(std::ceil(x)), 1);
        };
        sort_by_centre(entries, 0);
        tile(entries, rounded_up(std::cbrt(leaves(entries))), [&](std::span<entry> slab) {
            sort_by_centre(slab, 1);
            tile(slab, rounded_up(std::sqrt(leaves(slab))), [&](std::span<entry> row) { sort_by_centre(row, 2); });
        });
    }

    std::vector<std::vector<node>> levels_;  // from the leaves to the root
    std::vector<std::uint32_t> ids_;         // in the order of the leaves
};

}  // namespace aabb
