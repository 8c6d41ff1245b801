export module aabb.columns.worker;

export import aabb.columns.groups;
export import aabb.columns.lists;
import aabb.segment_trees;
import aabb.std;

export namespace aabb {

/// A plan that is kept between frames while its sweep stays cheap.
struct kept_plan {
    column_plan plan;
    bool by_keys = false;          ///< columns are sorted by exact keys, since buckets have too many boxes
    bool in_trees = false;         ///< segment trees replace columns, since sweeps take too many tests in vain
    std::uint64_t most_tests = 0;  ///< limit on vector tests for early stopping; 0 before the first sweep

    [[nodiscard]] bool was_swept() const noexcept { return most_tests > 0; }
};

/// The plan of a scene or group: either columns, or a grid of groups and recursively the plan of each group.
struct cut_plan {
    kept_plan columns;  ///< used if there are no groups
    bool in_groups = false;
    column_plan grid;         ///< the grid of groups
    std::size_t fullest = 0;  ///< number of boxes in the fullest group when the grid was planned
    std::vector<cut_plan> groups;

    [[nodiscard]] bool is_planned() const noexcept { return in_groups || columns.was_swept(); }
    /// Discards the plans of earlier groups.
    void begin_groups(std::size_t in_fullest) {
        if (groups.size() < grid.columns()) groups.resize(grid.columns());
        for (cut_plan& g : groups) g.columns = {}, g.in_groups = false;
        in_groups = true;
        fullest = in_fullest;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t sum = bytes_of(groups);
        for (const cut_plan& g : groups) sum += bytes_of(g);
        return sum;
    }
};

/// Puts boxes into groups, to be cut into columns, if the plan has any: into the grid of an earlier frame or, if there
/// is none or its fullest group has more than doubled, into a new one. Groups are nested: each level must separate at
/// least an eighth of all pairs of boxes, so that all levels take at most eight times the work of brute force.
/// @param kept the plan of an earlier frame, and then that of this one
/// @param make_plan returns a new plan
/// @returns `not_worthwhile` if there are no groups
template <class MakePlan>
[[nodiscard]] fill_result put_into_groups(const column_group& boxes, cut_plan& kept, MakePlan make_plan,
                                          column_groups& groups, worker_threads& threads) {
    const auto distribute = [&](std::size_t most_in_group) {
        return groups.distribute(boxes.boxes, boxes.ids, kept.grid, most_in_group, threads);
    };
    if (kept.in_groups) {
        constexpr std::size_t tolerance = 4096;  // so that small groups may more than double
        const fill_result result = distribute(2 * kept.fullest + tolerance);
        if (result != fill_result::not_worthwhile) return result;
        kept.in_groups = false;
        kept.columns = make_plan();
    }
    if (kept.columns.plan.groups <= 1) return fill_result::not_worthwhile;
    kept.grid = column_groups::group_grid(kept.columns.plan);
    fill_result result = distribute(/*most_in_group=*/std::numeric_limits<std::size_t>::max());
    if (result == fill_result::invalid) return result;
    const auto n = static_cast<double>(boxes.boxes.size());
    if (result == fill_result::complete && 8 * groups.pairs() > 7 * n * n) result = fill_result::not_worthwhile;
    if (result == fill_result::complete)
        kept.begin_groups(groups.fullest());
    else
        kept.columns.plan.groups = 1;  // later frames do not try again
    return result;
}

/// Measures how long groups take to be cut and sorted, which counts as update, and to be swept.
class phase_times {
public:
    /// Calls `cut` and `sweep` for a group, and adds their times. Reading a clock takes as long as a small group, so
    /// only one group per 1024 boxes is timed, and extrapolated to those before it by their numbers of boxes.
    template <class Cut, class Sweep>
    void run(std::size_t boxes, const Cut& cut, const Sweep& sweep) {
        untimed_boxes_ += boxes;
        if (untimed_boxes_ < least_timed_boxes) return cut(), sweep();
        const auto begin = clock::now();
        cut();
        const auto between = clock::now();
        sweep();
        const double factor = static_cast<double>(std::exchange(untimed_boxes_, 0)) / static_cast<double>(boxes);
        cut_seconds_ += factor * std::chrono::duration<double>(between - begin).count();
        sweep_seconds_ += factor * std::chrono::duration<double>(clock::now() - between).count();
    }
    void clear() noexcept { cut_seconds_ = sweep_seconds_ = 0; }
    [[nodiscard]] double cut() const noexcept { return cut_seconds_; }
    [[nodiscard]] double total() const noexcept { return cut_seconds_ + sweep_seconds_; }

private:
    using clock = std::chrono::steady_clock;
    static constexpr std::size_t least_timed_boxes = 1024;

    double cut_seconds_ = 0;
    double sweep_seconds_ = 0;
    std::size_t untimed_boxes_ = 0;  // since the last timed group
};

/// Cuts a group of boxes into columns and sweeps them, with the state of one thread.
///
/// A plan is estimated from a sample of an earlier frame and checked while it is used: if boxes have too many copies,
/// or the sweep takes far more tests than the plan's first one, it stops early and a new plan is made.
template <SortPolicy Sort, ColumnPartition Partition, ColumnSweep Sweep, CounterPolicy Counters>
class column_worker {
public:
    phase_times times;

    column_worker(Sort sort, Sweep sweep) : sort_(std::move(sort)), sweep_(std::move(sweep)) {}

    /// A new plan for a group of boxes, clipped to the bounds.
    [[nodiscard]] static kept_plan make_plan(const Partition& partition, const column_group& group, const box& within) {
        return {.plan = partition.plan(group.boxes, within)};
    }

    /// Finds the pairs of a group of valid boxes: cuts it into columns and sweeps these or, if it is large, cuts it
    /// into nested groups and searches each of them.
    /// @param within the region of the group, to which the plan is fitted
    /// @param kept the plan of an earlier frame, if there is one, and then that of this one
    void search(const Partition& partition, const column_group& group, const box& within, cut_plan& kept,
                std::vector<index_pair>& pairs, std::size_t depth = 0) {
        if (group.boxes.size() < 2) return count(/*subsets=*/1, /*copies=*/group.boxes.size());
        const auto new_plan = [&] { return make_plan(partition, group, within); };
        if (!kept.is_planned()) kept.columns = new_plan();
        if (kept.in_groups || kept.columns.plan.groups > 1) {
            while (levels_.size() <= depth) levels_.emplace_back();
            column_groups& groups = levels_[depth];
            worker_threads single_thread(1);
            fill_result filled{};
            times.run(
                group.boxes.size(), [&] { filled = put_into_groups(group, kept, new_plan, groups, single_thread); },
                /*sweep=*/[] {});
            if (filled == fill_result::complete) {
                counters_.add(work::moves, groups.copies());
                for (std::uint32_t g = 0; g < groups.size(); ++g)
                    search(partition, groups.group(g), groups.region(g, within), kept.groups[g], pairs, depth + 1);
                return;
            }
        }
        times.run(
            group.boxes.size(), [&] { static_cast<void>(fill(partition, group, within, kept.columns)); },
            [&] { sweep(partition, group, within, kept.columns, pairs); });
        count(/*subsets=*/0, copies());  // `fill` has counted the columns
    }

    /// Puts a group into columns. Boxes are copied to all columns that they overlap; if these copies are too many, a
    /// new plan is made, and if they still are, a single column, which has none.
    /// @param kept the plan, perhaps of an earlier frame
    /// @returns whether all boxes are valid; otherwise there is nothing to sweep
    [[nodiscard]] bool fill(const Partition& partition, const column_group& group, const box& within, kept_plan& kept) {
        is_filled_ = false;
        for (;;) {
            const fill_result result = columns_.fill(group.boxes, group.ids, kept.plan, kept.by_keys,
                                                     most_copies(group.boxes.size()), sort_, counters_);
            if (result == fill_result::invalid) return false;
            if (result == fill_result::complete) break;
            // A plan that was swept suited an earlier frame, so a new one may do; one column has no copies.
            if (kept.was_swept())
                kept = make_plan(partition, group, within);
            else
                kept.plan.across = {1, 1};
        }
        counters_.add(work::subsets, kept.plan.columns());
        is_filled_ = true;
        return true;
    }

    /// Sweeps the columns. If a sweep needs far more tests than the plan's first one, it stops early, and columns are
    /// filled and swept again: under a new plan, and if that also fails, sorted by exact keys instead of buckets. If
    /// even these take more tests in vain than segment trees take steps, the trees replace them, whose time has a
    /// bound.
    void sweep(const Partition& partition, const column_group& group, const box& within, kept_plan& kept,
               std::vector<index_pair>& pairs) {
        const std::size_t before = pairs.size();
        const std::size_t n = group.boxes.size();
        const std::uint64_t most_in_buckets = 64 * n + 4096;  // under a new plan; more: too many boxes share buckets
        // A list of n is copied on each level of each of two axes.
        const auto levels = static_cast<std::uint64_t>(std::bit_width(n));
        std::uint64_t most_by_keys = most_in_buckets + n * levels * levels;
        while (!kept.in_trees) {
            // The boxes were validated when the columns were first filled.
            if (!is_filled_) static_cast<void>(fill(partition, group, within, kept));
            const bool is_new = !kept.was_swept();
            const std::uint64_t most_tests = !is_new ? kept.most_tests : kept.by_keys ? most_by_keys : most_in_buckets;
            const std::uint64_t tests = sweep_.sweep(columns_.block(), pairs, most_tests, counters_);
            if (tests <= most_tests) {
                if (is_new) kept.most_tests = 2 * tests + n + 1;  // later sweeps may take about twice as many
                return;
            }
            // Where there are many pairs, tests are not in vain.
            const bool has_many_pairs = 2 * (pairs.size() - before) > tests;
            pairs.resize(before);
            is_filled_ = false;
            if (!is_new)
                kept = make_plan(partition, group, within);
            else if (!kept.by_keys)
                kept.by_keys = true;
            else if (has_many_pairs)
                most_by_keys = unlimited;
            else
                kept = {.plan = kept.plan, .in_trees = true, .most_tests = tests};
        }
        search_in_trees(group, kept.plan.axis, pairs);
    }

    [[nodiscard]] std::size_t copies() const noexcept { return columns_.copies(); }
    void count(std::size_t subsets, std::size_t copies) {
        counters_.add(work::subsets, subsets);
        counters_.add(work::subset_copies, copies);
    }

    [[nodiscard]] auto take_counters() { return std::exchange(counters_, {}); }
    [[nodiscard]] std::size_t sort_bytes() const noexcept { return bytes_of(sort_); }
    [[nodiscard]] std::size_t column_bytes() const noexcept {
        std::size_t sum = bytes_of(columns_);
        for (const column_groups& groups : levels_) sum += bytes_of(groups);
        return sum;
    }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return bytes_of(sweep_, trees_, tree_lists_); }

private:
    void search_in_trees(const column_group& group, int axis, std::vector<index_pair>& pairs) {
        std::array<std::span<const projection>, 3> lists;
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<projection>& list = tree_lists_[k];
            list.resize(group.boxes.size());
            for (std::uint32_t i = 0; i < list.size(); ++i) list[i] = {group.boxes[i].min[static_cast<int>(k)], i};
            sort_.sort(std::span(list), counters_);
            lists[k] = list;
        }
        const std::span<const projection> places = lists[static_cast<std::size_t>(axis)];
        for (const auto [p, q] : trees_.find(group.boxes, lists, axis, counters_)) {
            const std::uint32_t a = group.marked_id(places[p].id), b = group.marked_id(places[q].id);
            // Copies that both begin in an earlier group on an axis are a pair there.
            if ((a & b & ~column_entry::index_mask) == 0)
                pairs.push_back(ordered_pair(a & column_entry::index_mask, b & column_entry::index_mask));
        }
    }

    static constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

    /// The limit on copies above which columns are not worth their cost.
    [[nodiscard]] static constexpr std::size_t most_copies(std::size_t boxes) noexcept {
        return std::min(65'536 + 16 * boxes, std::size_t{1} << 30);
    }

    [[no_unique_address]] Sort sort_;
    [[no_unique_address]] Sweep sweep_;
    [[no_unique_address]] Counters counters_;
    column_lists columns_;
    bool is_filled_ = false;
    std::deque<column_groups> levels_;  // nested groups, by depth
    segment_trees trees_;
    std::array<std::vector<projection>, 3> tree_lists_;
};

}  // namespace aabb
