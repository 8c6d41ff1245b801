export module aabb.sweep.segmented;

import aabb.global_search;
import aabb.std;
import aabb.sweep.region_grid;
import aabb.sweep.segmented_list;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Incremental sweep and prune over segmented interval lists, in the regions of a grid over three axes: the algorithm
/// of Tracy, Buss and Woods, "Efficient large-scale sweep and prune methods with AABB insertion and removal" (IEEE
/// Virtual Reality 2009), after the authors' program as distributed with Broadmark (Algorithms/Dependencies/Tracy).
/// When to use: large scenes in which few objects move at a time, come and go.
///
/// As there, a moved object is taken alone: its ends move by swaps with their neighbours, whatever list or region they
/// are in, so that objects at rest cost nothing. An object that enters a region, or arrives, is inserted into the
/// segments of its ends, and tested against those that the segments name; one that leaves is erased likewise. Regions
/// hold 200 objects on average, Broadmark's setting; `regions=1` has no grid. Other than there, the marked axis is the
/// one of greatest variance instead of x, a pair that several regions find is kept in one set instead of counted, and
/// once a frame has taken as many steps as a restart would, or the number of objects has doubled or halved, all lists
/// are sorted and swept anew.
///
/// Time: for a moved object O(log n) to find its ends and one step per swap; for one that comes or goes that many, a
/// segment, and a test per object near it on the marked axis. Memory: 48 bytes per object and region in segments that
/// are 60 to 75% full, and 4 per segment beyond which it goes on; 44 per object, 1,600 per region, and 16 to 32 per
/// pair, for the most so far.
class segmented_sweep : public kept_pairs {
public:
    static constexpr std::string_view name = "segmented";
    static constexpr std::string_view summary =
        "incremental sweep and prune over lists in segments, which objects enter and leave cheaply";

    struct config {
        /// Number along each axis. auto: about 200 objects per region.
        std::optional<std::uint32_t> regions;
    };
    static constexpr std::tuple parameters{integer_parameter{
        "regions", &config::regions, 1U, 256U, "number along each axis; auto: about 200 objects per region"}};

    segmented_sweep() = default;
    explicit segmented_sweep(const config& c) : config_(c) {}

    /// Takes departed objects out of the lists, moves those that have moved, and inserts those that have arrived.
    /// Restarts as `subdivided` does. The sort is that of the lists themselves.
    template <class Sort, CounterPolicy Counters>
    void update(std::span<const box> boxes, const membership& objects, const Sort&, Counters& counters) {
        if (boxes.size() > most_interval_objects)
            throw input_error("segmented takes at most 2^31 objects, not " + std::to_string(boxes.size()));
        if (objects.any_departures()) erase_departures(objects, counters);
        before_.resize(boxes.size());
        ranges_.resize(boxes.size());
        const std::size_t known = objects.size() - objects.arrivals();
        if (2 * known < objects.size() || objects.size() > 2 * planned_ || 2 * objects.size() < planned_) {
            restart(boxes, objects, counters);
        } else {
            set_steps(restart_steps_);
            move_objects(boxes, objects, counters);
            if (steps_left_ == 0) {  // the moves stopped early
                counters.add(work::restarts);
                restart(boxes, objects, counters);
            }
        }
        before_.assign(boxes.begin(), boxes.end());
    }

    [[nodiscard]] static constexpr axis_set axes() noexcept { return every_axis; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total =
            bytes_of(regions_, ranges_, members_, starts_, ends_, swept_, first_segment_, before_, sweep_, pairs_);
        for (const auto& lists : regions_) total += bytes_of(lists);
        return total;
    }

private:
    using region_range = region_grid<3>::range;
    using region = std::array<segmented_list, 3>;  // a list per axis

    static constexpr double objects_per_region = 200;

    [[nodiscard]] static ordered_end lower_end(const box& b, std::uint32_t id, std::size_t axis) noexcept {
        return {b.min[static_cast<int>(axis)], id, /*is_upper=*/false};
    }
    [[nodiscard]] static ordered_end upper_end(const box& b, std::uint32_t id, std::size_t axis) noexcept {
        return {b.max[static_cast<int>(axis)], id, /*is_upper=*/true};
    }
    template <CounterPolicy Counters>
    void erase_departures(const membership& objects, Counters& counters) {
        set_steps(std::numeric_limits<std::uint64_t>::max());
        for (std::uint32_t id = 0; id < ranges_.size(); ++id) {
            if (ranges_[id] == region_range{} || !objects.is_leaving(id)) continue;
            grid_.for_each(ranges_[id], /*except=*/{}, [&](std::uint32_t r) {
                erase_from(r, id, counters, /*is_apart=*/[](std::uint32_t) { return true; });
            });
            ranges_[id] = {};
        }
    }

    /// Brings the lists to the boxes of this frame, object after object. A pair is judged by its boxes of this and the
    /// last frame, whichever ends have moved already: if it overlaps now, an insertion or the last swap of its ends
    /// inserts it; if it did in the last frame, the swap that parts them, or leaving a region, erases it. Stops when as
    /// many steps are taken as a restart takes, which then discards the unfinished lists.
    template <CounterPolicy Counters>
    void move_objects(std::span<const box> boxes, const membership& objects, Counters& counters) {
        for (std::uint32_t id = 0; id < boxes.size() && steps_left_ > 0; ++id) {
            if (!objects.contains(id) || (!objects.is_arrival(id) && boxes[id] == before_[id])) continue;
            const region_range from = ranges_[id];
            const region_range to = grid_.range_of(boxes[id]);
            spend(to.regions());
            const auto is_apart = [&](std::uint32_t other) { return !overlaps(boxes[id], boxes[other]); };
            grid_.for_each(from, to, [&](std::uint32_t r) { erase_from(r, id, counters, is_apart); });
            grid_.for_each(from.common(to), /*except=*/{}, [&](std::uint32_t r) { move_in(r, id, boxes, counters); });
            grid_.for_each(to, from, [&](std::uint32_t r) { insert_into(r, id, boxes, counters); });
            ranges_[id] = to;
        }
    }

    /// Erases an object, with the ends of its last box, from the lists of a region, and its pairs there that have
    /// ended.
    template <CounterPolicy Counters>
    void erase_from(std::uint32_t r, std::uint32_t id, Counters& counters, auto is_apart) {
        if (is_stopped_) return;
        region& lists = regions_[r];
        const box& b = before_[id];
        std::uint64_t tests = 0;
        lists[marked_].for_each_near(lower_end(b, id, marked_), upper_end(b, id, marked_), [&](std::uint32_t other) {
            ++tests;
            if (overlaps(b, before_[other]) && is_apart(other)) pairs_.erase(ordered_pair(id, other));
        });
        std::size_t moved = 0;
        for (std::size_t k = 0; k < 3; ++k) moved += lists[k].erase(lower_end(b, id, k), upper_end(b, id, k));
        counters.add(work::box_tests, tests);
        counters.add(work::moves, moved);
        spend(tests + moved);
    }

    template <CounterPolicy Counters>
    void insert_into(std::uint32_t r, std::uint32_t id, std::span<const box> boxes, Counters& counters) {
        if (is_stopped_) return;
        region& lists = regions_[r];
        const box& b = boxes[id];
        std::size_t moved = 0;
        for (std::size_t k = 0; k < 3; ++k) moved += lists[k].insert(lower_end(b, id, k), upper_end(b, id, k));
        std::uint64_t tests = 0;
        lists[marked_].for_each_near(lower_end(b, id, marked_), upper_end(b, id, marked_), [&](std::uint32_t other) {
            ++tests;
            if (overlaps(b, boxes[other])) pairs_.insert(ordered_pair(id, other));
        });
        counters.add(work::box_tests, tests);
        counters.add(work::moves, moved);
        spend(tests + moved);
    }

    /// Moves the ends of an object within a region. Of the two ends on an axis, the one that the other could meet moves
    /// first, so that an interval is never inverted.
    template <CounterPolicy Counters>
    void move_in(std::uint32_t r, std::uint32_t id, std::span<const box> boxes, Counters& counters) {
        const box &from = before_[id], &to = boxes[id];
        for (std::size_t k = 0; k < 3; ++k) {
            segmented_list& list = regions_[r][k];
            const ordered_end upper = upper_end(from, id, k), moved_upper = upper_end(to, id, k);
            const bool upper_first = upper < moved_upper;
            if (upper_first) move_end(list, upper, moved_upper, boxes, counters);
            move_end(list, lower_end(from, id, k), lower_end(to, id, k), boxes, counters);
            if (!upper_first) move_end(list, upper, moved_upper, boxes, counters);
        }
    }

    /// Moves an end to its place in this frame. A lower end that passes an upper one downwards, or the converse
    /// upwards, can begin an overlap, the others end one.
    template <CounterPolicy Counters>
    void move_end(segmented_list& list, const ordered_end& from, const ordered_end& to, std::span<const box> boxes,
                  Counters& counters) {
        if (is_stopped_ || from == to) return;
        const bool widens = from.is_upper() == (from < to);
        std::uint64_t passed = 0;
        std::uint64_t tests = 0;
        const std::uint64_t most = steps_left_;
        const std::size_t comparisons = list.move(from, to, [&](const ordered_end& neighbour) {
            if (++passed > most) return false;
            if (neighbour.is_upper() == from.is_upper()) return true;  // no overlap begins or ends
            ++tests;
            const index_pair pair = ordered_pair(neighbour.id(), from.id());
            if (widens) {
                if (overlaps(boxes[pair.a], boxes[pair.b])) pairs_.insert(pair);
            } else if (overlaps(before_[pair.a], before_[pair.b])) {
                pairs_.erase(pair);
            }
            return true;
        });
        counters.add(work::comparisons, comparisons);
        counters.add(work::moves, passed);
        counters.add(work::inversions, passed);
        counters.add(work::box_tests, tests);
        spend(passed + 1);
    }

    void set_steps(std::uint64_t steps) noexcept {
        steps_left_ = steps;
        is_stopped_ = false;
    }
    void spend(std::uint64_t steps) noexcept {
        steps_left_ -= std::min(steps, steps_left_);
        is_stopped_ = steps_left_ == 0;
    }

    /// Plans a new grid, sorts the ends of each region, and sweeps them along the marked axis for all pairs.
    template <CounterPolicy Counters>
    void restart(std::span<const box> boxes, const membership& objects, Counters& counters) {
        plan_grid(boxes, objects);
        pairs_.clear();
        regions_.resize(grid_.regions());
        first_segment_.resize(boxes.size());
        put_into_regions(boxes, objects);
        std::uint64_t tests = 0;
        restart_steps_ = 1;
        for (std::size_t r = 0; r < regions_.size(); ++r)
            for (std::size_t k = 0; k < 3; ++k) {
                ends_.clear();
                for (std::uint32_t i = starts_[r]; i < starts_[r + 1]; ++i) {
                    ends_.push_back(lower_end(boxes[members_[i]], members_[i], k));
                    ends_.push_back(upper_end(boxes[members_[i]], members_[i], k));
                }
                std::ranges::sort(ends_);
                restart_steps_ += ends_.size() * std::bit_width(ends_.size());
                regions_[r][k].assign(ends_, /*marks_spans=*/k == marked_, first_segment_);
                if (k == marked_) tests += find_pairs(boxes);
            }
        counters.add(work::box_tests, tests);
        restart_steps_ += tests;
    }

    /// Inserts the pairs of the sorted `ends_`, which are those of the marked axis.
    /// @returns the number of tested pairs
    std::uint64_t find_pairs(std::span<const box> boxes) {
        swept_.clear();
        for (const ordered_end& e : ends_) {
            interval_end end{0, e.id(), e.is_upper()};
            end.key = key_of(end, boxes, marked_);
            swept_.push_back(end);
        }
        return sweep_.find(swept_, boxes, pairs_, /*is_new=*/[](std::uint32_t) { return true; });
    }

    /// Lists the objects of each region r: members_[starts_[r] .. starts_[r + 1]).
    void put_into_regions(std::span<const box> boxes, const membership& objects) {
        starts_.assign(regions_.size() + 2, 0);
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            ranges_[id] = objects.contains(id) ? grid_.range_of(boxes[id]) : region_range();
            grid_.for_each(ranges_[id], /*except=*/{}, [&](std::uint32_t r) { ++starts_[r + 2]; });
        }
        for (std::size_t i = 2; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
        members_.resize(starts_.back());
        // The start of a region stands one behind its place, and becomes its end, the start of the next region.
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            grid_.for_each(ranges_[id], /*except=*/{}, [&](std::uint32_t r) { members_[starts_[r + 1]++] = id; });
    }

    void plan_grid(std::span<const box> boxes, const membership& objects) {
        planned_ = objects.size();
        const spread along = spread_of(boxes, objects);
        marked_ = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (along.variance[static_cast<int>(k)] > along.variance[static_cast<int>(marked_)]) marked_ = k;
        const double wanted = config_.regions
                                  ? static_cast<double>(*config_.regions)
                                  : std::ceil(std::cbrt(static_cast<double>(planned_) / objects_per_region));
        grid_.plan(bounds_of_present(boxes, objects), {0, 1, 2}, {wanted, wanted, wanted});
    }

    config config_;
    std::size_t planned_ = 0;  // number of present objects when the grid was planned
    region_grid<3> grid_;
    std::size_t marked_ = 0;  // the axis whose lists name the objects beyond each segment
    std::vector<region> regions_;
    std::vector<region_range> ranges_;  // by id
    std::uint64_t restart_steps_ = 1;   // number of steps of the last restart
    bool is_stopped_ = false;           // no steps are left, so that lists may be unfinished
    interval_sweep sweep_;
    // Used while restarting:
    std::vector<std::uint32_t> members_;
    std::vector<std::uint32_t> starts_;
    std::vector<ordered_end> ends_;
    std::vector<interval_end> swept_;
    std::vector<std::uint32_t> first_segment_;  // by id
};

static_assert(CoherentSweep<segmented_sweep>);

}  // namespace aabb
