export module aabb.sweep.subdivided;

import aabb.global_search;
import aabb.std;
import aabb.sweep.region_grid;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Incremental sweep and prune in regions: a coarse grid over two axes, whose regions have sorted lists of ends on all
/// three axes, kept between frames as in `incremental`. One of the methods of Tracy, Buss and Woods, "Efficient
/// large-scale sweep and prune methods with AABB insertion and removal" (IEEE Virtual Reality 2009); their other one,
/// lists in segments, is `segmented`. Here regions are so small that an insertion passes few other objects. When to
/// use: many objects, if few move at a time.
///
/// Only regions with moved objects are processed. An object that enters a region is appended to the region's lists and
/// sorted to its place, which finds its pairs; when it leaves one, its pairs there are tested. Once a frame has taken
/// as many steps as a restart would, it restarts with a new grid, as does a frame after the number of objects has
/// doubled or halved.
///
/// Memory: 48 bytes per object and region, 37 per object, 80 per region, 16 to 32 per pair, for the most so far.
class subdivided_sweep : public kept_pairs {
public:
    static constexpr std::string_view name = "subdivided";
    static constexpr std::string_view summary = "incremental sweep and prune within each region of a coarse grid";

    struct config {
        /// Number along each of the two cut axes. auto: about 16 objects per region, at least four mean extents wide.
        std::optional<std::uint32_t> regions;
    };
    static constexpr std::tuple parameters{integer_parameter{
        "regions", &config::regions, 1U, 256U, "number along each of two axes; auto: about 16 objects per region"}};

    subdivided_sweep() = default;
    explicit subdivided_sweep(const config& c) : config_(c) {}

    /// Updates the lists and pairs to a frame. Restarts with a new grid if more than half of the objects are new, or
    /// their number has doubled or halved since the last restart, or the update has taken as many steps as a restart.
    template <class Sort, CounterPolicy Counters>
    void update(std::span<const box> boxes, const membership& objects, Sort& sort, Counters& counters) {
        if (boxes.size() > most_interval_objects)
            throw input_error("subdivided takes at most 2^31 objects, not " + std::to_string(boxes.size()));
        if (objects.any_departures()) forget_departures(objects);
        before_.resize(boxes.size());
        ranges_.resize(boxes.size());
        const std::size_t known = objects.size() - objects.arrivals();
        if (2 * known < objects.size() || objects.size() > 2 * planned_ || 2 * objects.size() < planned_) {
            restart(boxes, objects, counters);
        } else {
            steps_left_ = restart_steps_;
            update_lists(boxes, objects, sort, counters);
            if (steps_left_ == 0) {  // the update stopped early
                counters.add(work::restarts);
                restart(boxes, objects, counters);
            }
        }
        before_.assign(boxes.begin(), boxes.end());
    }

    [[nodiscard]] static constexpr axis_set axes() noexcept { return every_axis; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = bytes_of(regions_, touched_, ranges_, moved_, before_, sweep_, pairs_);
        for (const region& r : regions_)
            for (const auto& list : r.ends) total += bytes_of(list);
        return total;
    }

private:
    struct region {
        std::array<std::vector<interval_end>, 3> ends;  ///< sorted, except for arrivals at the end
        bool is_touched = false;
    };

    using region_range = region_grid<2>::range;

    static constexpr double objects_per_region = 16;
    static constexpr double extents_per_region = 4;

    void touch(std::uint32_t r) {
        if (!regions_[r].is_touched) touched_.push_back(r);
        regions_[r].is_touched = true;
    }
    void spend(std::uint64_t steps) noexcept { steps_left_ -= std::min(steps, steps_left_); }
    static void erase_ends(region& r, auto is_leaving) {
        for (auto& list : r.ends) std::erase_if(list, [&](const interval_end& e) { return is_leaving(e.id); });
    }

    /// Removes departed objects from the pairs and, in one pass per list, from their regions.
    void forget_departures(const membership& objects) {
        pairs_.erase_if([&](index_pair p) { return objects.is_leaving(p.a) || objects.is_leaving(p.b); });
        for (std::uint32_t id = 0; id < ranges_.size(); ++id) {
            if (ranges_[id] == region_range{} || !objects.is_leaving(id)) continue;
            grid_.for_each(ranges_[id], /*except=*/{}, [&](std::uint32_t r) { touch(r); });
            ranges_[id] = {};
        }
        for (const std::uint32_t r : touched_) {
            erase_ends(regions_[r], [&](std::uint32_t id) { return objects.is_leaving(id); });
            regions_[r].is_touched = false;
        }
        touched_.clear();
    }

    /// Moves objects into and out of the lists of regions, then sorts those of `touched_` regions. Stops when `spend`
    /// has taken as many steps as a restart, which then discards the unfinished lists.
    template <class Sort, CounterPolicy Counters>
    void update_lists(std::span<const box> boxes, const membership& objects, Sort& sort, Counters& counters) {
        moved_.assign(boxes.size(), 0);
        for (std::uint32_t id = 0; id < boxes.size() && steps_left_ > 0; ++id) {
            if (!objects.contains(id) || (!objects.is_arrival(id) && boxes[id] == before_[id])) continue;
            moved_[id] = 1;
            const region_range range = grid_.range_of(boxes[id]);
            spend(range.regions());
            if (steps_left_ == 0) return;
            grid_.for_each(range, /*except=*/{}, [&](std::uint32_t r) { touch(r); });
            if (range == ranges_[id]) continue;  // it has stayed in the regions of the last frame
            grid_.for_each(ranges_[id], range, [&](std::uint32_t r) { leave_region(r, id, boxes, counters); });
            grid_.for_each(range, ranges_[id], [&](std::uint32_t r) { enter_region(r, id, boxes); });
            ranges_[id] = range;
        }
        for (const std::uint32_t r : touched_) {
            for (std::size_t k = 0; k < 3 && steps_left_ > 0; ++k) sort_region(r, k, boxes, sort, counters);
            regions_[r].is_touched = false;
        }
        touched_.clear();
    }

    /// Removes an object from a region's lists, and erases its pairs there that have ended. No swap of ends reports
    /// them, so its pairs of the last frame (boxes `before_`) are tested.
    template <CounterPolicy Counters>
    void leave_region(std::uint32_t r, std::uint32_t id, std::span<const box> boxes, Counters& counters) {
        spend(regions_[r].ends[0].size());
        erase_ends(regions_[r], [id](std::uint32_t other) { return other == id; });
        for (const interval_end& e : regions_[r].ends[0]) {
            if (e.is_upper || !overlaps(before_[id], before_[e.id])) continue;
            counters.add(work::box_tests);
            if (!overlaps(boxes[id], boxes[e.id])) pairs_.erase(ordered_pair(id, e.id));
        }
    }

    /// Appends the ends of an object, as if it came from beyond all others, so that sorting finds its pairs.
    void enter_region(std::uint32_t r, std::uint32_t id, std::span<const box> boxes) {
        for (std::size_t k = 0; k < 3; ++k) append_ends(regions_[r].ends[k], boxes, id, static_cast<int>(k));
    }

    /// Updates the keys of moved objects in a region's list, and sorts it by swaps if necessary.
    template <class Sort, CounterPolicy Counters>
    void sort_region(std::uint32_t r, std::size_t axis, std::span<const box> boxes, Sort& sort, Counters& counters) {
        std::vector<interval_end>& list = regions_[r].ends[axis];
        spend(list.size());
        bool is_sorted = true;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (moved_[list[i].id] != 0) list[i].key = key_of(list[i], boxes, axis);
            is_sorted &= i == 0 || !precedes(list[i], list[i - 1]);
        }
        if (is_sorted || steps_left_ == 0) return;
        follow_swaps(list, boxes, sort, counters);
    }

    /// Plans a new grid, fills, sorts and sweeps all lists, and counts its steps in `restart_steps_`.
    template <CounterPolicy Counters>
    void restart(std::span<const box> boxes, const membership& objects, Counters& counters) {
        plan_grid(boxes, objects);
        for (region& r : regions_) {
            for (auto& list : r.ends) list.clear();
            r.is_touched = false;
        }
        touched_.clear();
        pairs_.clear();
        regions_.resize(grid_.regions());
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            if (!objects.contains(id)) continue;
            ranges_[id] = grid_.range_of(boxes[id]);
            grid_.for_each(ranges_[id], /*except=*/{}, [&](std::uint32_t r) { enter_region(r, id, boxes); });
        }
        std::uint64_t tests = 0;
        restart_steps_ = 1;
        for (region& r : regions_) {
            for (auto& list : r.ends) {
                sort_ends(list);
                restart_steps_ += list.size() * std::bit_width(list.size());
            }
            const auto uncut = static_cast<std::size_t>(3 - cut_[0] - cut_[1]);  // the axis along which regions run
            tests += sweep_.find(r.ends[uncut], boxes, pairs_, /*is_new=*/[](std::uint32_t) { return true; });
        }
        counters.add(work::box_tests, tests);
        restart_steps_ += tests;
    }

    /// Plans the grid: cuts the two axes of greatest variance into the configured number of regions, or regions of
    /// about `objects_per_region` objects, not narrower than `extents_per_region` mean extents.
    void plan_grid(std::span<const box> boxes, const membership& objects) {
        planned_ = objects.size();
        const spread along = spread_of(boxes, objects);
        int least = 2;
        for (int k = 1; k >= 0; --k)
            if (along.variance[k] < along.variance[least]) least = k;
        cut_ = {least == 0 ? 1 : 0, least == 2 ? 1 : 2};
        const box world = bounds_of_present(boxes, objects);
        const double by_objects = std::sqrt(static_cast<double>(planned_) / objects_per_region);
        std::array<double, 2> wanted{};
        for (std::size_t k = 0; k < 2; ++k) {
            const double side = double{world.max[cut_[k]]} - double{world.min[cut_[k]]};
            const double by_extent = side / (extents_per_region * along.extent[cut_[k]]);
            wanted[k] = config_.regions ? static_cast<double>(*config_.regions) : std::min(by_objects, by_extent);
        }
        grid_.plan(world, cut_, wanted);
    }

    config config_;
    std::size_t planned_ = 0;  // number of present objects when the grid was planned
    std::array<int, 2> cut_{0, 1};
    region_grid<2> grid_;
    std::vector<region> regions_;
    std::vector<std::uint32_t> touched_;  // regions with objects that moved in this frame
    std::vector<region_range> ranges_;    // by id
    std::vector<std::uint8_t> moved_;     // whether the object moved in this frame, by id
    std::uint64_t restart_steps_ = 1;     // number of steps of the last restart
    interval_sweep sweep_;
};

static_assert(CoherentSweep<subdivided_sweep>);

}  // namespace aabb
