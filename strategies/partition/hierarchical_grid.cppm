module;
#include <cassert>

export module aabb.partition.hierarchical_grid;

import aabb.global_search;
import aabb.pipeline;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

template <CounterPolicy Counters>
class hierarchical_grid_search;

/// A hierarchical grid, the hgrid of Ericson (Real-Time Collision Detection, 2005, 7.2.1): grids whose cells double in
/// size from level to level, over the same space. Each box is stored once, in the cell of its lower corner, on the
/// level whose cells are at least four times as long as the box. When to use: boxes of very different sizes, of which
/// one grid makes either many copies or full cells.
///
/// Each box looks on its own level and on all coarser ones for boxes whose corner lies in it, or before it by no more
/// than the longest box of the level; finer boxes look for it. Cells of all levels share one hash table without keys,
/// as in the book: a bucket may hold several cells, and a query visits each bucket once. The book keeps linked lists
/// between frames; here a counting sort fills the buckets of a frame, so that a box at rest costs as much as any. With
/// `levels=1` it is the grid of 7.1.6 for the largest box. It needs no sorted list and no sweep.
///
/// Time: O(n) to fill, and per box a visit of up to eight cells per occupied level, with a test of each box in them.
/// Memory: 32 bytes per object for the boxes, 8 to 16 for the index of buckets, and as many for the marks of visits.
class hierarchical_grid_partition {
public:
    static constexpr std::string_view name = "hierarchical_grid";
    static constexpr std::string_view summary =
        "grids of doubling cell size; each box is stored once, on the level of its size";

    struct config {
        /// Number of levels; the coarsest has cells four times as long as the longest box. auto: what the range of box
        /// sizes needs, up to 32.
        std::optional<std::uint32_t> levels;
    };
    static constexpr std::tuple parameters{integer_parameter{
        "levels", &config::levels, 1U, 32U, "number of grids; auto: what the range of box sizes needs"}};

    /// Neither the sort nor the sweep is used, so that one of each is accepted: those of a composition that names none.
    template <class... All>
    static constexpr std::string_view rejects() {
        if (((SortPolicy<All> && All::name != "std") || ...) || ((SweepPolicy<All> && All::name != "one_axis") || ...))
            return "hierarchical_grid neither sorts nor sweeps; it can be combined with std and one_axis only";
        return {};
    }

    /// The broad phase that uses this partition.
    template <class Sort, class Sweep, class Counters>
    using search_with = hierarchical_grid_search<Counters>;

    hierarchical_grid_partition() = default;
    explicit hierarchical_grid_partition(const config& c) : config_(c) {}

    [[nodiscard]] std::size_t most_levels() const noexcept { return config_.levels.value_or(32); }
    [[nodiscard]] bool has_fixed_levels() const noexcept { return config_.levels.has_value(); }

private:
    config config_;
};

/// The search of `hierarchical_grid`, which keeps nothing between frames but memory.
template <CounterPolicy Counters>
class hierarchical_grid_search {
public:
    template <class Sort, class Sweep>
    hierarchical_grid_search(const Sort&, const hierarchical_grid_partition& partition, const Sweep&)
        : partition_(partition) {}

    /// Chooses the levels for the sizes of the boxes, and puts each box into its bucket.
    /// @throws input_error as `require_valid`
    void update(std::span<const box> boxes, const membership& objects, Counters& counters) {
        require_valid(boxes);
        plan_levels(boxes, objects);
        const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(2 * objects.size(), 2));
        hash_shift_ = 64 - static_cast<unsigned>(std::countr_zero(buckets));
        starts_.assign(buckets + 2, 0);
        visited_.resize(buckets, 0);
        bucket_of_.resize(boxes.size());
        level_of_.resize(boxes.size());
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            if (!objects.contains(id)) continue;
            const box& b = boxes[id];
            const std::uint32_t l = level_for(longest_extent(b));
            level_of_[id] = static_cast<std::uint8_t>(l);
            bucket_of_[id] = bucket({cell(b.min[0], l), cell(b.min[1], l), cell(b.min[2], l)}, l);
            ++starts_[bucket_of_[id] + 2];
        }
        for (std::size_t i = 2; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
        stored_.resize(objects.size());
        // The start of a bucket stands one behind its place, and becomes its end, the start of the next bucket.
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (objects.contains(id)) stored_[starts_[bucket_of_[id] + 1]++] = {boxes[id], id, level_of_[id]};
        assert(starts_[buckets] == stored_.size());
        counters.add(work::moves, stored_.size());
        counters.add(work::subsets, buckets);
        counters.add(work::subset_copies, stored_.size());
    }

    /// Tests each box against those that may overlap it on its level, if they are stored behind it, and on coarser
    /// ones.
    void search(std::vector<index_pair>& pairs, Counters& counters) {
        std::uint64_t tests = 0;
        for (std::uint32_t i = 0; i < stored_.size(); ++i) {
            const stored_box& a = stored_[i];
            for (std::uint32_t l = a.level; l < levels_.size(); ++l)
                if (levels_[l].is_occupied) tests += test_level(a, i, l, pairs);
        }
        counters.add(work::box_tests, tests);
    }

    [[nodiscard]] static std::size_t sort_bytes() noexcept { return 0; }
    [[nodiscard]] static std::size_t sweep_bytes() noexcept { return 0; }
    [[nodiscard]] std::size_t partition_bytes() const noexcept {
        return bytes_of(levels_, starts_, visited_, bucket_of_, level_of_, stored_);
    }
    [[nodiscard]] static std::vector<stage_plan> plans() { return {}; }
    [[nodiscard]] static std::vector<omission> left_out() { return {{absence::sort, "cells are not sorted"}}; }
    [[nodiscard]] static double share_of_update() noexcept { return 0; }

private:
    static constexpr double cell_per_extent = 4;  // the book's ratio of a cell to the largest sphere in it

    struct grid_level {
        double cell_size;
        double per_unit;
        double reach = 0;  ///< at least the extent of the longest box of the level
        bool is_occupied = false;
    };

    /// A box in its bucket, aligned so that none straddles two cache lines.
    struct alignas(32) stored_box {
        box bounds;
        std::uint32_t id;
        std::uint32_t level;
    };
    static_assert(sizeof(stored_box) == 32);

    [[nodiscard]] static double longest_extent(const box& b) noexcept {
        double longest = 0;
        for (int k = 0; k < 3; ++k) longest = std::max(longest, double{b.max[k]} - double{b.min[k]});
        return longest;
    }

    /// The finest level whose cells are long enough for a box; the last one is, for all.
    [[nodiscard]] std::uint32_t level_for(double extent) const noexcept {
        std::uint32_t l = 0;
        while (l + 1 < levels_.size() && levels_[l].cell_size < cell_per_extent * extent) ++l;
        return l;
    }

    /// Chooses cell sizes: from that of the longest box down by factors of two, as far as the shortest one needs, or to
    /// a configured number. Points alone get about one cell each.
    void plan_levels(std::span<const box> boxes, const membership& objects) {
        double shortest = std::numeric_limits<double>::infinity();
        double longest = 0;
        box world = empty_box();
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            if (!objects.contains(id)) continue;
            const double extent = longest_extent(boxes[id]);
            shortest = std::min(shortest, extent);
            longest = std::max(longest, extent);
            world = merged(world, boxes[id]);
        }
        levels_.clear();
        if (objects.size() == 0) return;
        double coarsest = cell_per_extent * longest;
        if (longest == 0) {
            coarsest = longest_extent(world) / std::cbrt(static_cast<double>(objects.size()));
            if (coarsest == 0) coarsest = 1;
        }
        const std::size_t most = partition_.most_levels();
        double size = coarsest;
        if (partition_.has_fixed_levels())
            size = std::ldexp(coarsest, 1 - static_cast<int>(most));
        else if (longest > 0)
            for (std::size_t n = 1; n < most && size / 2 >= cell_per_extent * shortest; ++n) size /= 2;
        for (; size <= coarsest; size *= 2) levels_.push_back({.cell_size = size, .per_unit = 1 / size});
        assert(!levels_.empty() && levels_.size() <= most);
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            if (!objects.contains(id)) continue;
            const double extent = longest_extent(boxes[id]);
            grid_level& level = levels_[level_for(extent)];
            level.is_occupied = true;
            // The difference of two floats may be rounded down in double.
            level.reach = std::max(level.reach, extent * (1 + 0x1p-51));
        }
    }

    /// The number of a cell along an axis. Monotone in x, rounding and clamping included.
    [[nodiscard]] std::int64_t cell(double x, std::uint32_t level) const noexcept {
        constexpr double most = 0x1p62;
        return static_cast<std::int64_t>(std::clamp(std::floor(x * levels_[level].per_unit), -most, most));
    }

    [[nodiscard]] std::uint32_t bucket(const std::array<std::int64_t, 3>& at, std::uint32_t level) const noexcept {
        std::uint64_t mixed = static_cast<std::uint64_t>(at[0]) * 0x9e3779b97f4a7c15U +
                              static_cast<std::uint64_t>(at[1]) * 0xc2b2ae3d27d4eb4fU +
                              static_cast<std::uint64_t>(at[2]) * 0x165667b19e3779f9U + level;
        mixed = (mixed ^ mixed >> 32) * 0xd6e8feb86659fd93U;
        return static_cast<std::uint32_t>(mixed >> hash_shift_);
    }

    /// Visits the cells of a level in which boxes that overlap `a` may begin: at or before the upper ends of `a`, and
    /// before its lower ends by at most the longest extent of the level. Rounding that difference misses none, since it
    /// is monotone and leaves the lower end of a box, a float, as it is.
    /// @param i the index of `a`
    /// @returns the number of tests
    std::uint64_t test_level(const stored_box& a, std::uint32_t i, std::uint32_t l, std::vector<index_pair>& pairs) {
        std::array<std::int64_t, 3> first{};
        std::array<std::int64_t, 3> last{};
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            first[axis] = cell(double{a.bounds.min[k]} - levels_[l].reach, l);
            last[axis] = cell(a.bounds.max[k], l);
        }
        const std::uint32_t query = next_query();
        std::uint64_t tests = 0;
        for (std::int64_t x = first[0]; x <= last[0]; ++x)
            for (std::int64_t y = first[1]; y <= last[1]; ++y)
                for (std::int64_t z = first[2]; z <= last[2]; ++z) {
                    const std::uint32_t at = bucket({x, y, z}, l);
                    if (std::exchange(visited_[at], query) != query) tests += test_bucket(a, i, l, at, pairs);
                }
        return tests;
    }

    /// Tests a box against those of one level in a bucket; of its own level, only against those stored behind it.
    std::uint64_t test_bucket(const stored_box& a, std::uint32_t i, std::uint32_t l, std::uint32_t at,
                              std::vector<index_pair>& pairs) const {
        std::uint64_t tests = 0;
        const std::uint32_t begin = a.level == l ? std::max(starts_[at], i + 1) : starts_[at];
        for (std::uint32_t j = begin; j < starts_[at + 1]; ++j) {
            const stored_box& b = stored_[j];
            if (b.level != l) continue;
            ++tests;
            if (overlaps(a.bounds, b.bounds)) pairs.push_back(ordered_pair(a.id, b.id));
        }
        return tests;
    }

    /// The mark of the next query; when the numbers run out, all marks are cleared.
    [[nodiscard]] std::uint32_t next_query() noexcept {
        if (++query_ == 0) {
            std::ranges::fill(visited_, 0);
            query_ = 1;
        }
        return query_;
    }

    hierarchical_grid_partition partition_;
    std::vector<grid_level> levels_;        // from the finest
    unsigned hash_shift_ = 63;              // 64 less the bits of a bucket's number
    std::vector<std::uint32_t> starts_;     // by bucket: index of its first box in stored_
    std::vector<std::uint32_t> visited_;    // by bucket: the last query that visited it
    std::vector<std::uint32_t> bucket_of_;  // by id
    std::vector<std::uint8_t> level_of_;    // by id
    std::vector<stored_box> stored_;        // bucket after bucket
    std::uint32_t query_ = 0;
};

static_assert(SearchingPartition<hierarchical_grid_partition>);

}  // namespace aabb
