export module aabb.columns.search;

import aabb.columns.resting_boxes;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// Brute-force search for few boxes: testing all pairs by vectors is faster than sorting or cutting.
class brute_force_batch {
public:
    /// Loads the boxes, ascending by id, into vectors of coordinates, one box per lane.
    /// @returns whether all boxes are valid; otherwise `search` must not be called.
    [[nodiscard]] bool fill(const column_group& group) {
        group_ = group;
        vectors_.resize((group.boxes.size() + width - 1) / width);
        simd::flags invalid{};
        for_each_vector(group.boxes, [&](std::size_t i, const simd::floats(&c)[6], std::uint32_t) {
            invalid |= are_invalid(c);
            std::ranges::copy(c, vectors_[i / width].coordinates);
        });
        return simd::bits(invalid) == 0;
    }

    /// Appends the overlapping pairs: tests each vector against all boxes before it, and each of its boxes against
    /// those that follow in it. A test yields a mask of lanes, stored as a row if it is not 0.
    template <CounterPolicy Counters>
    void search(std::vector<index_pair>& pairs, Counters& counters) {
        const std::size_t n = group_.boxes.size();
        overlaps_.resize(n * vectors_.size());
        std::size_t rows = 0;
        std::size_t tests = 0;
        for (std::size_t v = 0; v < vectors_.size(); ++v) {
            const vector_of_boxes vector = vectors_[v];
            const std::size_t first = v * width;
            const std::uint32_t present = simd::lanes_below(n - first);
            // Tests box i against the lanes of the mask `wanted`.
            const auto test = [&](std::size_t i, std::uint32_t wanted) {
                const std::uint32_t lanes = vector.overlap_mask(group_.boxes[i]) & wanted;
                // Stored without a branch, which would be hard to predict.
                overlaps_[rows] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(first), lanes};
                rows += static_cast<std::size_t>(lanes != 0);
            };
            for (std::size_t i = 0; i < first; ++i) test(i, present);
            const std::size_t end = std::min(n, first + width);
            for (std::size_t i = first; i < end; ++i) test(i, present & ~simd::lanes_below(i - first + 1));
            tests += end;
        }
        counters.add(work::box_tests, width * tests);
        append_pairs(std::span(overlaps_).first(rows), pairs);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(vectors_, overlaps_); }

private:
    static constexpr std::size_t width = simd::width;

    struct vector_of_boxes {
        simd::floats coordinates[6];

        /// Bit l is set if box l of the vector overlaps `b`.
        [[nodiscard, gnu::always_inline]] inline std::uint32_t overlap_mask(const box& b) const noexcept {
            simd::flags overlapping = (coordinates[0] <= b.max[0]) & (coordinates[3] >= b.min[0]);
            for (int k = 1; k < 3; ++k) overlapping &= (coordinates[k] <= b.max[k]) & (coordinates[3 + k] >= b.min[k]);
            return simd::bits(overlapping);
        }
    };
    /// A box and the later boxes of one vector that it overlaps.
    struct lane_overlaps {
        std::uint32_t box;
        std::uint32_t first;  ///< index of the vector's first box
        std::uint32_t lanes;
    };

    /// Appends the pairs of these rows, as ids: if bit l of a row's mask is set, its box overlaps box `first` + l.
    void append_pairs(std::span<const lane_overlaps> rows, std::vector<index_pair>& pairs) const {
        std::size_t next = pairs.size();
        std::size_t end = next;
        for (const lane_overlaps& row : rows) end += static_cast<std::size_t>(std::popcount(row.lanes));
        pairs.resize(end);
        for (const lane_overlaps& row : rows)
            for (std::uint32_t lanes = row.lanes; lanes != 0; lanes &= lanes - 1)
                pairs[next++] = {id_of(row.box),
                                 id_of(row.first + static_cast<std::uint32_t>(std::countr_zero(lanes)))};
    }

    [[nodiscard]] std::uint32_t id_of(std::uint32_t index) const noexcept {
        return group_.ids.empty() ? index : group_.ids[index];
    }

    column_group group_{};
    std::vector<vector_of_boxes> vectors_;
    std::vector<lane_overlaps> overlaps_;
};

/// Broad phase that cuts before it sorts: boxes are put into columns unsorted. Large scenes are processed group by
/// group, and the data of a group are built right before it is swept, so that they are still in a cache. Few boxes are
/// tested by brute force. Plans are kept between frames, and so are the pairs of boxes at rest (`resting_boxes`).
template <SortPolicy Sort, ColumnPartition Partition, ColumnSweep Sweep, CounterPolicy Counters>
class column_search {
public:
    column_search(Sort sort, Partition partition, Sweep sweep)
        : partition_(std::move(partition)),
          threads_(partition_.threads()),
          workers_(threads_.count(), worker{.searcher = {std::move(sort), std::move(sweep)}, .pairs = {}}) {}
    // Not copyable: spans would refer to the original's vectors. A move takes the memory of the vectors along.
    column_search(column_search&&) = default;
    column_search& operator=(column_search&&) = default;

    /// Starts a frame: selects the boxes that are to be searched, those that do not rest or all, and prepares them.
    /// @throws input_error as `global_search::update`.
    void update(std::span<const box> boxes, const membership& objects, Counters& counters) {
        boxes_ = boxes;
        if (boxes.size() > column_entry::index_mask) throw input_error("columns take at most 536,870,911 objects");
        searches_active_ = resting_boxes_.update(partition_, boxes, objects);
        if (searches_active_)
            present_ = resting_boxes_.active();
        else
            select_present(boxes, objects);
        prepare(counters);
        if (searches_active_) resting_boxes_.accept();
    }

    /// Appends the overlapping pairs: those of boxes at rest, and those of the others by brute force, in columns over
    /// the whole scene, or in groups of columns, as `update` chose.
    void search(std::vector<index_pair>& pairs, Counters& counters) {
        for (worker& w : workers_) w.searcher.times.clear();
        const std::size_t before = pairs.size();
        if (searches_active_ && !resting_boxes_.append_pairs(pairs, counters)) {
            pairs.resize(before);
            search_all_boxes(counters);
        }
        if (uses_brute_force_)
            batch_.search(pairs, counters);
        else if (groups_.size() == 0)
            workers_.front().searcher.sweep(partition_, present_, everywhere, cut_.columns, pairs);
        else
            search_groups(pairs);
        collect_counters(counters);
        const auto pairs_of_frame = std::span(pairs).subspan(before);
        if (searches_active_)
            resting_boxes_.end_partial_search(pairs_of_frame);
        else
            resting_boxes_.end_full_search(boxes_, pairs_of_frame);
    }

    /// The plan of the last frame that was cut: the grid of groups if there are groups, else the columns.
    [[nodiscard]] const column_plan& plan() const noexcept { return is_in_groups() ? cut_.grid : cut_.columns.plan; }
    [[nodiscard]] bool is_in_groups() const noexcept { return groups_.size() > 0; }
    /// The plan as a sentence, which `explain` prints.
    [[nodiscard]] std::vector<stage_plan> plans() const {
        constexpr std::string_view along[2][3]{
            {"{u} by {v} columns along the x axis", "{u} by {v} columns along the y axis",
             "{u} by {v} columns along the z axis"},
            {"{u} by {v} groups of columns along the x axis", "{u} by {v} groups of columns along the y axis",
             "{u} by {v} groups of columns along the z axis"}};
        std::vector<stage_plan> stage_plans;
        if (searches_active_)
            stage_plans.push_back({plan_kind::resting_boxes,
                                   {"{resting} boxes at rest are kept with their pairs; {active} others are searched, "
                                    "and looked up among those at rest",
                                    {{{"resting", static_cast<double>(resting_boxes_.resting())},
                                      {"active", static_cast<double>(resting_boxes_.active().ids.size())}}}}});
        if (uses_brute_force_) return stage_plans;
        const column_plan& p = plan();
        stage_plans.push_back({is_in_groups() ? plan_kind::groups_of_columns : plan_kind::columns,
                               {p.columns() > 1    ? along[is_in_groups() ? 1 : 0][p.axis]
                                : searches_active_ ? "one column of the boxes that move, sorted and swept in each frame"
                                                   : "one column of all boxes, sorted and swept in each frame",
                                {{{"u", static_cast<double>(p.across[0])},
                                  {"v", static_cast<double>(p.across[1])},
                                  {"axis", static_cast<double>(p.axis)}}}}});
        return stage_plans;
    }
    [[nodiscard]] std::vector<omission> left_out() const {
        const char* const why = searches_active_ ? "so few boxes move that they are tested by brute force"
                                                 : "so few boxes are tested by brute force";
        if (uses_brute_force_) return {{absence::partition, why}, {absence::sort, why}};
        return {};
    }
    /// The share of the last search's time that belongs to the update: `search` also cuts and sorts the groups.
    [[nodiscard]] double share_of_update() const {
        const double total = sum_of([](const worker& w) { return w.searcher.times.total(); });
        return total > 0 ? sum_of([](const worker& w) { return w.searcher.times.cut(); }) / total : 0;
    }
    [[nodiscard]] std::size_t sort_bytes() const noexcept {
        return sum_of([](const worker& w) { return w.searcher.sort_bytes(); });
    }
    [[nodiscard]] std::size_t partition_bytes() const noexcept {
        return bytes_of(partition_, groups_, cut_, present_boxes_, present_ids_, batch_, resting_boxes_) +
               sum_of([](const worker& w) { return w.searcher.column_bytes(); });
    }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept {
        return bytes_of(group_pairs_) +
               sum_of([](const worker& w) { return w.searcher.sweep_bytes() + bytes_of(w.pairs); });
    }

private:
    /// A plan is replaced after this many frames.
    static constexpr unsigned frames_per_plan = 32;

    using worker_counters = std::conditional_t<Counters::enabled, work_counters, no_counters>;

    // Aligned to pairs of cache lines, which are prefetched together, to prevent false sharing between workers.
    struct alignas(128) worker {
        column_worker<Sort, Partition, Sweep, worker_counters> searcher;
        std::vector<index_pair> pairs;
    };
    /// The location of a group's pairs if a worker other than the first one searched it; else empty.
    struct pairs_of_group {
        std::size_t worker = 0;
        std::size_t begin = 0;
        std::size_t end = 0;
    };

    /// Prepares brute force for few present boxes, or cuts them into columns. These follow a plan, which is made anew
    /// once it is old or the bounds of the scene have changed.
    void prepare(Counters& counters) {
        const std::size_t n = present_.boxes.size();
        uses_brute_force_ = n <= partition_.brute_force_threshold();
        // 0 until the boxes are cut: brute force or an exception leaves no plan for the next frame.
        const std::size_t planned_boxes = std::exchange(planned_boxes_, 0);
        if (uses_brute_force_) {
            if (!batch_.fill(present_)) require_valid(boxes_);  // throws
            return;
        }
        const box bounds = bounds_of_sample();
        const bool needs_plan = is_stale(n, planned_boxes) || bounds_have_changed(bounds, planned_bounds_);
        if (needs_plan) planned_bounds_ = bounds;
        plan_age_ = needs_plan ? 0 : plan_age_ + 1;
        if (!cut_boxes(needs_plan, counters)) require_valid(boxes_);  // throws
        planned_boxes_ = n;
        collect_counters(counters);
    }

    /// Prepares all present boxes, after only the active ones were.
    void search_all_boxes(Counters& counters) {
        present_boxes_.clear();
        present_ids_.clear();
        resting_boxes_.for_each_present([&](std::uint32_t id) {
            present_boxes_.push_back(boxes_[id]);
            present_ids_.push_back(id);
        });
        present_ = {present_boxes_, present_ids_};
        prepare(counters);
        // Only now, so that after an exception another search does the same.
        resting_boxes_.give_up();
        searches_active_ = false;
    }

    /// Sets `present_`, which refers to copies only if objects are absent; without ids, the index of a box is its id.
    void select_present(std::span<const box> boxes, const membership& objects) {
        present_ = {boxes, {}};
        if (objects.size() == boxes.size()) return;
        require_valid(boxes);
        present_boxes_.clear();
        present_ids_.clear();
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (objects.contains(id)) {
                present_boxes_.push_back(boxes[id]);
                present_ids_.push_back(id);
            }
        present_ = {present_boxes_, present_ids_};
    }

    /// Whether there is no plan, or it is too old, or the number of boxes has changed by more than an eighth.
    [[nodiscard]] bool is_stale(std::size_t n, std::size_t planned) const noexcept {
        const std::size_t change = n > planned ? n - planned : planned - n;
        return planned == 0 || plan_age_ + 1 == frames_per_plan || 8 * change > planned;
    }

    /// Bounds of about 16 boxes at equal strides, the same in each frame, by which a change of the scene is noticed.
    [[nodiscard]] box bounds_of_sample() const noexcept {
        constexpr std::size_t sample_size = 16;
        box bounds = empty_box();
        const std::size_t n = present_.boxes.size();
        const std::size_t step = std::max<std::size_t>(1, n / sample_size);
        for (std::size_t i = 0; i < n; i += step) bounds = merged(bounds, present_.boxes[i]);
        return bounds;
    }

    /// Whether the extent on an axis has grown by half or shrunk by a third since a plan was made, or the centre has
    /// moved by half of it. Short axes count as a 64th of the longest one: any motion would be large in a flat scene.
    [[nodiscard]] static bool bounds_have_changed(const box& current, const box& planned) noexcept {
        const auto width_of = [](const box& b, int k) { return double{b.max[k]} - double{b.min[k]}; };
        const double longest = width_of(planned, longest_axis(planned));
        for (int k = 0; k < 3; ++k) {
            const double width = std::max(width_of(planned, k), longest / 64);
            const double change = width_of(current, k) - width_of(planned, k);
            const double doubled_displacement =
                double{current.min[k]} - double{planned.min[k]} + double{current.max[k]} - double{planned.max[k]};
            if (change > width / 2 || change < -width / 3 || std::abs(doubled_displacement) > width) return true;
        }
        return false;
    }

    /// Puts the boxes into groups, cache-sized regions of the scene that `search` cuts into columns one after the
    /// other. If groups are not worthwhile, as for few boxes, cuts all boxes into columns at once.
    /// @param needs_plan whether the plan kept from earlier frames no longer suits the scene
    /// @returns whether all boxes are valid.
    [[nodiscard]] bool cut_boxes(bool needs_plan, Counters& counters) {
        // `put_into_groups` calls it, too, if the kept groups have become too full.
        const auto make_plan = [&] {
            plan_age_ = 0;
            kept_plan planned = workers_.front().searcher.make_plan(partition_, present_, everywhere);
            const std::size_t n = present_.boxes.size();
            const double groups_by_size = static_cast<double>(n) / static_cast<double>(partition_.group_size(n));
            planned.plan.groups = std::max(planned.plan.groups, groups_by_size);
            return planned;
        };
        if (needs_plan) {
            cut_.columns = make_plan();
            cut_.in_groups = false;
        }
        const fill_result result = put_into_groups(present_, cut_, make_plan, groups_, threads_);
        if (result == fill_result::complete) counters.add(work::moves, groups_.copies());
        if (result != fill_result::not_worthwhile) return result == fill_result::complete;
        groups_.clear();
        auto& searcher = workers_.front().searcher;
        if (!searcher.fill(partition_, present_, everywhere, cut_.columns)) return false;
        // A scene that is not cut has no copies, as without a partition.
        if (cut_.columns.plan.columns() > 1) counters.add(work::subset_copies, searcher.copies());
        return true;
    }

    /// Searches all groups. Each thread takes the next group when it is done with one, which balances the load.
    void search_groups(std::vector<index_pair>& pairs) {
        if (threads_.count() == 1) {
            for (std::uint32_t g = 0; g < groups_.size(); ++g) search_group(g, workers_.front(), pairs);
            return;
        }
        // The first worker takes groups in ascending order, into the result; the others in descending order.
        for (worker& w : workers_) w.pairs.clear();
        group_pairs_.assign(groups_.size(), {});
        std::atomic<std::uint64_t> taken = 0;  // low u32: groups taken in ascending order; high u32: in descending
        threads_.for_each_index(threads_.count(), [&](std::size_t, std::size_t number) {
            std::vector<index_pair>& to = number == 0 ? pairs : workers_[number].pairs;
            const std::uint64_t increment = number == 0 ? 1 : std::uint64_t{1} << 32U;
            for (;;) {
                const std::uint64_t before = taken.fetch_add(increment, std::memory_order_relaxed);
                const auto first = static_cast<std::uint32_t>(before);
                const auto last = static_cast<std::uint32_t>(before >> 32U);
                if (first + last >= groups_.size()) return;
                const std::uint32_t g = number == 0 ? first : groups_.size() - 1 - last;
                const std::size_t begin = to.size();
                search_group(g, workers_[number], to);
                if (number > 0) group_pairs_[g] = {number, begin, to.size()};
            }
        });
        append_worker_pairs(pairs);
    }

    /// Appends the other workers' pairs by group: the order is that of the groups, whichever worker took them.
    void append_worker_pairs(std::vector<index_pair>& pairs) {
        std::size_t total = pairs.size();
        for (const worker& w : workers_) total += w.pairs.size();
        if (total > pairs.capacity()) pairs.reserve(std::max(total, 2 * pairs.capacity()));
        for (const pairs_of_group& g : group_pairs_) {
            const auto from = workers_[g.worker].pairs.begin();
            pairs.insert(pairs.end(), from + static_cast<std::ptrdiff_t>(g.begin),
                         from + static_cast<std::ptrdiff_t>(g.end));
        }
    }

    void search_group(std::uint32_t g, worker& w, std::vector<index_pair>& pairs) {
        w.searcher.search(partition_, groups_.group(g), groups_.region(g, everywhere), cut_.groups[g], pairs);
    }

    /// Adds the counts of the workers, which run in parallel, to `counters` and resets them.
    void collect_counters(Counters& counters) {
        if constexpr (Counters::enabled)
            for (worker& w : workers_) {
                const work_counters counted = w.searcher.take_counters();
                for (std::size_t k = 0; k < work_names.size(); ++k)
                    if (const auto kind = static_cast<work>(k); counted[kind] > 0) counters.add(kind, counted[kind]);
            }
    }

    template <class Value>
    [[nodiscard]] auto sum_of(Value value) const {
        decltype(value(workers_.front())) sum{};
        for (const worker& w : workers_) sum += value(w);
        return sum;
    }

    [[no_unique_address]] Partition partition_;
    worker_threads threads_;
    std::vector<worker> workers_;  // one per thread
    std::span<const box> boxes_;   // boxes of the current frame
    resting_boxes resting_boxes_;
    bool searches_active_ = false;  // only those that do not rest
    column_group present_{};
    std::vector<box> present_boxes_;  // used only if some objects are absent or were at rest
    std::vector<std::uint32_t> present_ids_;
    brute_force_batch batch_;
    bool uses_brute_force_ = false;
    cut_plan cut_;
    column_groups groups_;
    std::vector<pairs_of_group> group_pairs_;  // by group
    std::size_t planned_boxes_ = 0;            // in the previous frame; 0 without a plan
    unsigned plan_age_ = 0;                    // number of frames since the plan was made
    box planned_bounds_ = empty_box();
};

}  // namespace aabb
