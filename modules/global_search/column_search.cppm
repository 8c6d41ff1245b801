module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

export module aabb.global_search:column_search;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import :column_groups;
import :column_lists;
import :column_plan;
import :frame_at_rest;
import :membership;
import :partition_policy;
import :sort_policy;
import :sweep_policy;

export namespace aabb {

/// Global search that cuts first: boxes go to columns as they are, group by group where there are many, and what a
/// group needs is made while it is swept, so that it is still in a cache. Kept from frame to frame are the plan, and
/// the pairs for as long as nothing moves.
template <SortPolicy Sort, ColumnPartition Partition, ColumnSweep Sweep, CounterPolicy Counters>
class column_search {
public:
    column_search(Sort sort, Partition partition, Sweep sweep) : partition_(std::move(partition)) {
        workers_.push_back({std::move(sort), std::move(sweep), {}, {}, {}, 0});
        workers_.resize(partition_.threads(), workers_.front());
    }

    /// @throws input_error as `global_search::update`.
    void update(std::span<const box> boxes, const membership& objects, Counters& counters) {
        boxes_ = boxes;
        rests_ = at_rest_.lasts(boxes, objects);
        if (rests_) return;
        select(boxes, objects);
        const std::size_t n = present_.boxes.size();
        if (n > column_entry::index_bits) throw input_error("columns take at most 536,870,911 objects");
        const bool anew = is_stale(n);
        planned_ = 0;
        if (anew) plan_ = partition_.plan(present_.boxes, everywhere);
        const bool valid = is_grouped(n) ? distribute(anew) : fill();
        if (!valid) require_valid(boxes);
        planned_ = n;
        age_ = anew ? 0 : age_ + 1;
        add_up(counters);
    }

    void search(std::vector<index_pair>& pairs, Counters& counters) {
        if (rests_) {
            pairs.insert(pairs.end(), at_rest_.pairs().begin(), at_rest_.pairs().end());
            return;
        }
        const std::size_t before = pairs.size();
        std::uint64_t tests = 0;
        if (groups_.size() == 0)
            tests = sweep(workers_.front(), pairs);
        else
            tests = search_groups(pairs);
        add_up(counters);
        if (age_ == 0) planned_tests_ = tests;
        is_slow_ = tests > 2 * planned_tests_ + planned_;
        at_rest_.keep(boxes_, std::span(pairs).subspan(before));
    }

    [[nodiscard]] std::size_t sort_bytes() const noexcept {
        return sum_of([](const worker& w) { return bytes_of(w.sort); });
    }
    [[nodiscard]] std::size_t partition_bytes() const noexcept {
        return bytes_of(partition_) + bytes_of(groups_) + bytes_of(group_plans_) + bytes_of(present_boxes_) +
               bytes_of(present_ids_) + bytes_of(at_rest_) +
               sum_of([](const worker& w) { return bytes_of(w.columns); });
    }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept {
        return bytes_of(found_) + sum_of([](const worker& w) { return bytes_of(w.sweep) + bytes_of(w.pairs); });
    }

private:
    /// A plan serves as many frames, unless the boxes change their number or their sweep takes twice as long.
    static constexpr unsigned frames_a_plan = 16;

    using own_counters = std::conditional_t<Counters::enabled, work_counters, no_counters>;

    /// What one thread has for itself.
    struct worker {
        [[no_unique_address]] Sort sort;
        [[no_unique_address]] Sweep sweep;
        [[no_unique_address]] own_counters counters;
        column_lists columns;
        std::vector<index_pair> pairs;
        std::uint64_t tests;  // of a vector
    };
    /// Where the pairs of a group are.
    struct pairs_of_group {
        std::size_t worker;
        std::size_t begin;
        std::size_t end;
        std::size_t place;  // among all
    };

    [[nodiscard]] unsigned threads() const noexcept { return static_cast<unsigned>(workers_.size()); }

    void select(std::span<const box> boxes, const membership& objects) {
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

    [[nodiscard]] bool is_stale(std::size_t n) const noexcept {
        const std::size_t change = n > planned_ ? n - planned_ : planned_ - n;
        return planned_ == 0 || age_ + 1 == frames_a_plan || is_slow_ || 8 * change > planned_ ||
               is_grouped(n) != (groups_.size() > 0);
    }

    [[nodiscard]] bool is_grouped(std::size_t n) const noexcept { return partition_.group(n) < n; }

    [[nodiscard]] bool fill() {
        groups_.clear();
        worker& w = workers_.front();
        w.counters.add(work::subsets, plan_.columns());
        const bool valid = w.columns.fill(present_.boxes, present_.ids, plan_, w.sort, w.counters);
        if (plan_.columns() > 1) w.counters.add(work::subset_copies, w.columns.copies());
        return valid;
    }

    [[nodiscard]] bool distribute(bool anew) {
        const auto n = present_.boxes.size();
        if (anew)
            group_plan_ =
                column_groups::coarser(plan_, static_cast<double>(n) / static_cast<double>(partition_.group(n)));
        if (!groups_.distribute(present_.boxes, present_.ids, group_plan_, threads())) return false;
        group_plans_.resize(groups_.size());
        if (anew)
            for_each_index(groups_.size(), threads(), [&](std::size_t g, std::size_t) {
                const auto number = static_cast<std::uint32_t>(g);
                group_plans_[g] = partition_.plan(groups_.group(number).boxes, groups_.region(number));
            });
        for (const column_plan& p : group_plans_) workers_.front().counters.add(work::subsets, p.columns());
        return true;
    }

    std::uint64_t search_groups(std::vector<index_pair>& pairs) {
        for (worker& w : workers_) w.tests = 0;
        if (threads() == 1) {
            for (std::uint32_t g = 0; g < groups_.size(); ++g) search_group(g, workers_.front(), pairs);
        } else {
            for (worker& w : workers_) w.pairs.clear();
            found_.resize(groups_.size());
            for_each_index(groups_.size(), threads(), [&](std::size_t g, std::size_t number) {
                worker& w = workers_[number];
                const std::size_t begin = w.pairs.size();
                search_group(static_cast<std::uint32_t>(g), w, w.pairs);
                found_[g] = {number, begin, w.pairs.size(), 0};
            });
            collect(pairs);
        }
        return sum_of([](const worker& w) { return w.tests; });
    }

    void search_group(std::uint32_t g, worker& w, std::vector<index_pair>& pairs) {
        const column_group group = groups_.group(g);
        if (group.boxes.size() < 2) return;
        // They are valid: `distribute` looked at them.
        if (w.columns.fill(group.boxes, group.ids, group_plans_[g], w.sort, w.counters)) w.tests += sweep(w, pairs);
    }

    /// In the order of the groups, whichever thread took them.
    void collect(std::vector<index_pair>& pairs) {
        std::size_t all = pairs.size();
        for (pairs_of_group& f : found_) {
            f.place = all;
            all += f.end - f.begin;
        }
        if (all > pairs.capacity()) pairs.reserve(std::max(all, 2 * pairs.capacity()));
        pairs.resize(all);
        for_each_index(found_.size(), threads(), [&](std::size_t g, std::size_t) {
            const pairs_of_group& f = found_[g];
            std::ranges::copy(std::span(workers_[f.worker].pairs).subspan(f.begin, f.end - f.begin),
                              pairs.begin() + static_cast<std::ptrdiff_t>(f.place));
        });
    }

    [[nodiscard]] static std::uint64_t sweep(worker& w, std::vector<index_pair>& pairs) {
        return w.sweep.sweep(w.columns.block(), pairs, w.counters);
    }

    void add_up(Counters& counters) {
        if constexpr (Counters::enabled)
            for (worker& w : workers_) {
                for (std::size_t k = 0; k < work_names.size(); ++k)
                    if (const auto what = static_cast<work>(k); w.counters[what] > 0)
                        counters.add(what, w.counters[what]);
                w.counters = {};
            }
    }

    template <class Value>
    [[nodiscard]] auto sum_of(Value value) const {
        decltype(value(workers_.front())) sum{};
        for (const worker& w : workers_) sum += value(w);
        return sum;
    }

    [[no_unique_address]] Partition partition_;
    std::vector<worker> workers_;
    frame_at_rest at_rest_;
    bool rests_ = false;
    std::span<const box> boxes_;  // of the frame
    column_group present_{};
    std::vector<box> present_boxes_;  // where some objects are absent
    std::vector<std::uint32_t> present_ids_;
    column_plan plan_;
    column_plan group_plan_;
    column_groups groups_;
    std::vector<column_plan> group_plans_;
    std::vector<pairs_of_group> found_;
    std::size_t planned_ = 0;  // boxes of the frame before; 0 without a plan
    unsigned age_ = 0;         // frames since the plan
    std::uint64_t planned_tests_ = 0;
    bool is_slow_ = false;
};

}  // namespace aabb
