module;
#include <cassert>

export module aabb.partition.sorted_grid;

import aabb.global_search;
import aabb.pipeline;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

template <SortPolicy Sort, ListSweep Sweep, CounterPolicy Counters>
class sorted_grid_search;

/// A grid of square cells over the two axes beside the first swept one; each occupied cell keeps its sorted list
/// between frames, and is sorted and swept alone. The algorithm of `Grid2DSortAndSweep` of BEPUphysics 1
/// (BroadPhaseSystems/SortAndSweep), which has insertion sort along x: `insertion` + `sorted_grid` + `one_axis:axis=x`.
/// When to use: little motion across cells, since an entry that changes its cell moves half of a list.
///
/// Only cells that have boxes, or had lately, exist, in a hash table, so that neither the size of the world nor its
/// place matters. A box that enters a cell is inserted at its place by bisection, and one that leaves is searched. A
/// pair is reported by the cell that owns its greater lower ends. `uniform_grid` distributes lists sorted over the
/// whole scene instead, `columns` sorts its cells afresh.
///
/// Time: O(n) per frame beside sorting and sweeping. Memory: 32 bytes per object, 8 per object, cell and swept axis,
/// and about 100 per occupied cell.
class sorted_grid_partition {
public:
    static constexpr std::string_view name = "sorted_grid";
    static constexpr std::string_view summary =
        "square cells over two axes, which keep their sorted lists between frames";

    struct config {
        /// Edge of a cell in world units. auto: eight mean extents, the ratio of BEPUphysics' default to the boxes of
        /// its benchmark, more if boxes get more than eight copies on average.
        std::optional<double> cell_size;
    };
    static constexpr std::tuple parameters{
        number_parameter{"cell_size", &config::cell_size, 0.0, std::numeric_limits<double>::max(),
                         "edge of a cell, in world units; auto: eight mean extents, or more"}};

    /// The broad phase that uses this partition.
    template <class Sort, class Sweep, class Counters>
    using search_with = sorted_grid_search<Sort, Sweep, Counters>;

    sorted_grid_partition() = default;
    explicit sorted_grid_partition(const config& c) : config_(c) {}

    [[nodiscard]] std::optional<double> cell_size() const noexcept { return config_.cell_size; }

private:
    config config_;
};

/// The occupied cells of a grid: a hash table with linear probing finds their numbers. A cell stays occupied while it
/// is empty, until it is freed, so that boxes that go to and fro find the memory of its lists again.
class occupied_cells {
public:
    using coordinates = std::array<std::int32_t, 2>;

    struct cell {
        coordinates at{};
        std::array<std::vector<projection>, 3> lists;  ///< sorted; by swept axis, the others are empty
        bool is_occupied = false;

        [[nodiscard]] bool is_empty() const noexcept {
            return lists[0].empty() && lists[1].empty() && lists[2].empty();
        }
        [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(lists); }
    };

    void clear() noexcept {
        free_.clear();
        for (auto c = static_cast<std::uint32_t>(cells_.size()); c-- > 0;) {
            for (auto& list : cells_[c].lists) list.clear();
            cells_[c].is_occupied = false;
            free_.push_back(c);
        }
        std::ranges::fill(table_, none);
    }

    /// The cell at a place, which must be occupied.
    [[nodiscard]] cell& find(const coordinates& at) noexcept {
        const std::uint32_t c = table_[slot_of(at)];
        assert(c != none);
        return cells_[c];
    }

    /// The cell at a place; an empty one if it was not occupied.
    [[nodiscard]] cell& find_or_occupy(const coordinates& at) {
        if (2 * (cells_.size() - free_.size() + 1) > table_.size()) grow();
        const std::size_t slot = slot_of(at);
        if (table_[slot] != none) return cells_[table_[slot]];
        if (free_.empty()) {
            // There is room for the numbers of all cells, so that freeing one cannot fail.
            if (free_.capacity() <= cells_.size()) free_.reserve(2 * cells_.size() + 1);
            cells_.emplace_back();
            free_.push_back(static_cast<std::uint32_t>(cells_.size() - 1));
        }
        table_[slot] = free_.back();
        free_.pop_back();
        cell& taken = cells_[table_[slot]];
        taken.at = at;
        taken.is_occupied = true;
        return taken;
    }

    /// Frees the cells whose lists are empty; they keep their memory.
    void free_empty() noexcept {
        for (auto& c : cells_) {
            if (!c.is_occupied || !c.is_empty()) continue;
            c.is_occupied = false;
            const std::size_t slot = slot_of(c.at);
            free_.push_back(std::exchange(table_[slot], none));
            close_gap(slot);
        }
    }

    /// All cells, also free ones, whose lists are empty.
    [[nodiscard]] std::span<cell> cells() noexcept { return cells_; }
    [[nodiscard]] std::size_t occupied() const noexcept { return cells_.size() - free_.size(); }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = bytes_of(cells_, free_, table_);
        for (const cell& c : cells_) total += c.bytes();
        return total;
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] std::size_t home_of(const coordinates& at) const noexcept {
        const std::uint64_t both =
            std::uint64_t{static_cast<std::uint32_t>(at[0])} << 32 | static_cast<std::uint32_t>(at[1]);
        const std::uint64_t mixed = (both ^ both >> 29) * 0x9e3779b97f4a7c15U;
        return mixed >> (64 - std::countr_zero(table_.size()));
    }
    [[nodiscard]] std::size_t next(std::size_t slot) const noexcept { return (slot + 1) & (table_.size() - 1); }

    /// The slot of a place, or the free one that it would take.
    [[nodiscard]] std::size_t slot_of(const coordinates& at) const noexcept {
        std::size_t slot = home_of(at);
        while (table_[slot] != none && cells_[table_[slot]].at != at) slot = next(slot);
        return slot;
    }

    /// Moves later entries whose search would cross an emptied slot, as in `pair_set`.
    void close_gap(std::size_t gap) noexcept {
        for (std::size_t at = next(gap); table_[at] != none; at = next(at)) {
            const std::size_t mask = table_.size() - 1;
            if (((at - home_of(cells_[table_[at]].at)) & mask) < ((at - gap) & mask)) continue;
            table_[gap] = std::exchange(table_[at], none);
            gap = at;
        }
    }

    void grow() {
        table_.assign(table_.empty() ? 64 : 2 * table_.size(), none);
        for (std::uint32_t c = 0; c < cells_.size(); ++c)
            if (cells_[c].is_occupied) table_[slot_of(cells_[c].at)] = c;
    }

    std::vector<cell> cells_;
    std::vector<std::uint32_t> free_;   // numbers of cells that are not occupied
    std::vector<std::uint32_t> table_;  // numbers of occupied cells; the size is a power of two
};

/// The search of `sorted_grid`: keeps the cells between frames.
template <SortPolicy Sort, ListSweep Sweep, CounterPolicy Counters>
class sorted_grid_search {
public:
    sorted_grid_search(Sort sort, const sorted_grid_partition& partition, Sweep sweep)
        : sort_(std::move(sort)), partition_(partition), sweep_(std::move(sweep)) {}

    /// Moves the boxes between cells, and sorts these. Fills the grid anew if other axes are swept, if automatic cells
    /// would differ by more than a factor of two or get more than 16 copies per box, and after an exception.
    /// @throws input_error as `require_valid`, and if cells of a configured size would need too many copies
    void update(std::span<const box> boxes, const membership& objects, Counters& counters) {
        require_valid(boxes);
        boxes_ = boxes;
        const axis_set swept = sweep_.axes(boxes, objects);
        const bool was_filled = std::exchange(is_filled_, false) && swept == swept_;
        swept_ = swept;
        const int first_swept = std::countr_zero(swept);
        cut_ = {first_swept == 0 ? 1 : 0, first_swept == 2 ? 1 : 2};
        const double wanted = partition_.cell_size() ? *partition_.cell_size() : eight_extents(boxes, objects);
        const bool needs_plan = !was_filled || wanted > 2 * planned_ || 2 * wanted < planned_;
        if (needs_plan || !move_boxes(boxes, objects, counters)) fill(boxes, objects, wanted, counters);
        sort_cells(boxes, counters);
        counters.add(work::subsets, cells_.occupied());
        if (cells_.occupied() > 1) counters.add(work::subset_copies, copies_);
        is_filled_ = true;
    }

    /// Sweeps each cell.
    void search(std::vector<index_pair>& pairs, Counters& counters) {
        for (const auto& c : cells_.cells()) {
            partition_subset subset{boxes_, {}};
            for (std::size_t k = 0; k < 3; ++k) {
                if (!has_axis(swept_, k) || c.lists[k].empty()) continue;
                entries_[k].clear();
                for (const projection& p : c.lists[k]) entries_[k].push_back({p.id, owned_in(c.at, ranges_[p.id])});
                subset.lists[k] = entries_[k];
            }
            if (!c.is_empty()) sweep_.sweep(subset, pairs, counters);
        }
    }

    [[nodiscard]] std::size_t sort_bytes() const noexcept { return bytes_of(sort_); }
    [[nodiscard]] std::size_t partition_bytes() const noexcept {
        return bytes_of(cells_, ranges_, moved_ranges_, entries_);
    }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return bytes_of(sweep_); }
    [[nodiscard]] static std::vector<stage_plan> plans() { return {}; }
    [[nodiscard]] static std::vector<omission> left_out() { return {}; }
    [[nodiscard]] static double share_of_update() noexcept { return 0; }

private:
    /// The cells that a box overlaps on the two cut axes; none by default.
    struct cell_range {
        occupied_cells::coordinates first{1, 1};
        occupied_cells::coordinates last{0, 0};

        [[nodiscard]] bool holds(const occupied_cells::coordinates& at) const noexcept {
            return first[0] <= at[0] && at[0] <= last[0] && first[1] <= at[1] && at[1] <= last[1];
        }
        [[nodiscard]] std::uint64_t cells() const noexcept {
            const auto along = [this](std::size_t c) {
                return static_cast<std::uint64_t>(std::int64_t{last[c]} - first[c] + 1);
            };
            return along(0) * along(1);
        }
        friend bool operator==(const cell_range&, const cell_range&) = default;
    };

    /// Monotone in x, rounding and clamping included, so that overlapping boxes share a cell.
    [[nodiscard]] std::int32_t cell_at(float x) const noexcept {
        constexpr double most = 0x1p30;
        return static_cast<std::int32_t>(std::clamp(std::floor(double{x} * per_unit_), -most, most));
    }
    [[nodiscard]] cell_range range_of(const box& b) const noexcept {
        cell_range range;
        for (std::size_t c = 0; c < 2; ++c) {
            range.first[c] = cell_at(b.min[cut_[c]]);
            range.last[c] = cell_at(b.max[cut_[c]]);
        }
        return range;
    }

    /// The axes on which a box begins in a cell. Each cell spans the axis that is not cut.
    [[nodiscard]] axis_set owned_in(const occupied_cells::coordinates& at, const cell_range& range) const noexcept {
        axis_set owned = every_axis;
        for (std::size_t c = 0; c < 2; ++c)
            if (range.first[c] != at[c]) owned &= ~(axis_set{1} << cut_[c]);
        return owned;
    }

    /// Eight times the mean longer extent on the cut axes. Points get about one cell each.
    [[nodiscard]] double eight_extents(std::span<const box> boxes, const membership& objects) const {
        double extents = 0;
        box world = empty_box();
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            if (!objects.contains(id)) continue;
            const box& b = boxes[id];
            world = merged(world, b);
            extents += std::max(extent(b, 0), extent(b, 1));
        }
        if (objects.size() == 0) return 1;
        const auto n = static_cast<double>(objects.size());
        if (extents > 0) return 8 * extents / n;
        const double span = std::max(extent(world, 0), extent(world, 1)) / std::sqrt(n);
        return span > 0 ? span : 1;
    }
    [[nodiscard]] double extent(const box& b, std::size_t c) const noexcept {
        return double{b.max[cut_[c]]} - double{b.min[cut_[c]]};
    }

    /// The number of copies that cells of this size make.
    [[nodiscard]] std::uint64_t copies_with(double cell_size, std::span<const box> boxes, const membership& objects) {
        per_unit_ = std::min(1 / cell_size, std::numeric_limits<double>::max());  // not infinity, which times 0 is NaN
        std::uint64_t copies = 0;
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (objects.contains(id)) add_copies(copies, range_of(boxes[id]));
        return copies;
    }
    /// A range has up to 2^62 cells, so the sum ends at 2^62 before it could overflow.
    static void add_copies(std::uint64_t& copies, const cell_range& range) noexcept {
        copies = std::min(copies + range.cells(), std::uint64_t{1} << 62);
    }

    /// Rejects a configured cell size with which boxes would be copied too often, as other partitions do.
    static void require_few(std::uint64_t copies, std::size_t objects) {
        const std::uint64_t most = (std::uint64_t{1} << 24) + 64 * std::uint64_t{objects};
        if (copies > most)
            throw input_error("sorted_grid makes " + std::to_string(copies) + " copies of " + std::to_string(objects) +
                              " objects, but at most " + std::to_string(most) +
                              " (2^24 + 64 per object) are allowed; larger cells make fewer copies");
    }

    /// Empties the grid, chooses the size of its cells, and fills and sorts their lists.
    void fill(std::span<const box> boxes, const membership& objects, double wanted, Counters& counters) {
        cells_.clear();
        planned_ = wanted;
        copies_ = copies_with(wanted, boxes, objects);
        if (partition_.cell_size()) {
            require_few(copies_, objects.size());
        } else {
            // Cells that are longer than all boxes make at most four copies.
            for (double size = 2 * wanted; copies_ > 8 * objects.size(); size *= 2)
                copies_ = copies_with(size, boxes, objects);
        }
        ranges_.resize(boxes.size());
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            ranges_[id] = objects.contains(id) ? range_of(boxes[id]) : cell_range();
            for_each_cell(ranges_[id], /*except=*/{}, [&](const occupied_cells::coordinates& at) {
                auto& c = cells_.find_or_occupy(at);
                for_each_swept([&](std::size_t k) { c.lists[k].push_back({key(boxes, id, k), id}); });
            });
        }
        counters.add(work::moves, copies_);
        for (auto& c : cells_.cells())
            for (auto& list : c.lists)
                std::ranges::sort(list, [](const auto& p, const auto& q) { return precedes(p, q); });
    }

    /// Takes boxes out of the cells that they have left and inserts them into those that they have entered.
    /// @returns false, with the cells unchanged, if automatic cells must be chosen anew
    [[nodiscard]] bool move_boxes(std::span<const box> boxes, const membership& objects, Counters& counters) {
        moved_ranges_.resize(boxes.size());
        std::uint64_t copies = 0;
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            moved_ranges_[id] = objects.contains(id) ? range_of(boxes[id]) : cell_range();
            add_copies(copies, moved_ranges_[id]);
        }
        if (partition_.cell_size())
            require_few(copies, objects.size());
        else if (copies > 16 * objects.size())
            return false;
        copies_ = copies;
        // Of a frame that has become smaller, the last objects have left.
        for (auto id = static_cast<std::uint32_t>(boxes.size()); id < ranges_.size(); ++id)
            for_each_cell(ranges_[id], /*except=*/{}, [&](const occupied_cells::coordinates& at) { leave(at, id); });
        ranges_.resize(boxes.size());
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            const cell_range to = moved_ranges_[id];
            if (to == ranges_[id]) continue;
            for_each_cell(ranges_[id], to, [&](const occupied_cells::coordinates& at) { leave(at, id); });
            for_each_cell(to, ranges_[id],
                          [&](const occupied_cells::coordinates& at) { enter(at, boxes, id, counters); });
            ranges_[id] = to;
        }
        return true;
    }

    void leave(const occupied_cells::coordinates& at, std::uint32_t id) {
        auto& c = cells_.find(at);
        for_each_swept([&](std::size_t k) { c.lists[k].erase(std::ranges::find(c.lists[k], id, &projection::id)); });
    }

    /// Inserts an entry behind those with a smaller or equal key of the last frame, which is about its place.
    void enter(const occupied_cells::coordinates& at, std::span<const box> boxes, std::uint32_t id,
               Counters& counters) {
        auto& c = cells_.find_or_occupy(at);
        for_each_swept([&](std::size_t k) {
            const projection entry{key(boxes, id, k), id};
            const auto place = std::ranges::upper_bound(c.lists[k], entry.key, {}, &projection::key);
            counters.add(work::moves, static_cast<std::uint64_t>(c.lists[k].end() - place) + 1);
            c.lists[k].insert(place, entry);
        });
    }

    /// Updates the keys of each list, and sorts it if one has changed. Frees empty cells if most are.
    void sort_cells(std::span<const box> boxes, Counters& counters) {
        std::size_t empty = 0;
        for (auto& c : cells_.cells()) {
            empty += static_cast<std::size_t>(c.is_occupied && c.is_empty());
            for (std::size_t k = 0; k < 3; ++k) {
                bool has_changed = false;
                for (projection& p : c.lists[k]) {
                    const float current = key(boxes, p.id, k);
                    has_changed |= current != p.key;
                    p.key = current;
                }
                if (has_changed) sort_.sort(std::span(c.lists[k]), counters);
            }
        }
        if (2 * empty > cells_.occupied()) cells_.free_empty();
    }

    [[nodiscard]] static float key(std::span<const box> boxes, std::uint32_t id, std::size_t axis) noexcept {
        return boxes[id].min[static_cast<int>(axis)];
    }
    void for_each_swept(auto visit) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (has_axis(swept_, k)) visit(k);
    }
    /// @param visit gets each cell of a range that is not in the range `except`
    static void for_each_cell(const cell_range& range, const cell_range& except, auto visit) {
        for (std::int32_t i = range.first[0]; i <= range.last[0]; ++i)
            for (std::int32_t j = range.first[1]; j <= range.last[1]; ++j)
                if (!except.holds({i, j})) visit({i, j});
    }

    [[no_unique_address]] Sort sort_;
    sorted_grid_partition partition_;
    Sweep sweep_;
    std::span<const box> boxes_;
    bool is_filled_ = false;  // the members below are those of the last frame
    axis_set swept_ = 0;
    std::array<int, 2> cut_{1, 2};
    double planned_ = 0;  // wanted size of a cell when the grid was filled
    double per_unit_ = 1;
    std::uint64_t copies_ = 0;
    occupied_cells cells_;
    std::vector<cell_range> ranges_;                    // by id
    std::vector<cell_range> moved_ranges_;              // by id
    std::array<std::vector<subset_entry>, 3> entries_;  // of the cell that is swept
};

static_assert(SearchingPartition<sorted_grid_partition>);

}  // namespace aabb
