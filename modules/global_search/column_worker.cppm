module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

export module aabb.global_search:column_worker;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import :column_groups;
import :column_lists;
import :column_plan;
import :partition_policy;
import :sort_policy;
import :sweep_policy;

export namespace aabb {

/// How boxes are cut for as long as that serves them.
struct kept_plan {
    column_plan plan;
    bool by_keys = false;          ///< columns are sorted by keys, since their buckets took too many boxes
    std::uint64_t most_tests = 0;  ///< of a vector, with which a sweep still serves; 0 before the first one
};

/// Cuts a group of boxes into columns and sweeps them: what one thread has for itself.
///
/// A plan comes from a few boxes of an earlier frame. Whether it serves these is seen while it is used: once boxes have
/// very many copies, or their sweep takes far more tests than it took at first, what was begun is given up for a new
/// plan. If that serves no better, columns are sorted by keys, as a sweep along one axis would; no scene takes much
/// longer than that.
template <SortPolicy Sort, ColumnPartition Partition, ColumnSweep Sweep, CounterPolicy Counters>
class column_worker {
public:
    column_worker(Sort sort, Sweep sweep) : sort_(std::move(sort)), sweep_(std::move(sweep)) {}

    /// What lies within the bounds counts, where a plan is made.
    [[nodiscard]] static kept_plan planned(const Partition& partition, const column_group& group, const box& within) {
        return {partition.plan(group.boxes, within), false, 0};
    }

    /// @returns whether all boxes are valid; if not, there is nothing to sweep.
    [[nodiscard]] bool fill(const Partition& partition, const column_group& group, const box& within, kept_plan& kept) {
        is_filled_ = false;
        for (;;) {
            const fill_result result = columns_.fill(group.boxes, group.ids, kept.plan, kept.by_keys,
                                                     most_copies(group.boxes.size()), sort_, counters_);
            if (result == fill_result::invalid) return false;
            if (result == fill_result::whole) break;
            if (kept.most_tests > 0)
                kept = planned(partition, group, within);
            else
                kept.plan.across = {1, 1};
        }
        counters_.add(work::subsets, kept.plan.columns());
        is_filled_ = true;
        return true;
    }

    /// Of what was filled, or is filled again where that broke off.
    void sweep(const Partition& partition, const column_group& group, const box& within, kept_plan& kept,
               std::vector<index_pair>& pairs) {
        const std::size_t before = pairs.size();
        const std::size_t n = group.boxes.size();
        for (;;) {
            // They were valid when they were filled first.
            if (!is_filled_) static_cast<void>(fill(partition, group, within, kept));
            const bool is_new = kept.most_tests == 0;
            const std::uint64_t most = !is_new ? kept.most_tests : kept.by_keys ? any_number : 64 * n + 4096;
            const std::uint64_t tests = sweep_.sweep(columns_.block(), pairs, most, counters_);
            if (tests <= most) {
                if (is_new) kept.most_tests = 2 * tests + n + 1;
                return;
            }
            pairs.resize(before);
            is_filled_ = false;
            kept = is_new ? kept_plan{kept.plan, true, 0} : planned(partition, group, within);
        }
    }

    /// Boxes in columns, each as often as it is in one.
    [[nodiscard]] std::size_t copies() const noexcept { return columns_.copies(); }
    void count(std::size_t subsets, std::size_t copies) {
        counters_.add(work::subsets, subsets);
        counters_.add(work::subset_copies, copies);
    }

    /// Work that was not taken yet.
    [[nodiscard]] auto take_counters() { return std::exchange(counters_, {}); }

    [[nodiscard]] std::size_t sort_bytes() const noexcept { return bytes_of(sort_); }
    [[nodiscard]] std::size_t column_bytes() const noexcept { return bytes_of(columns_); }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return bytes_of(sweep_); }

private:
    static constexpr std::uint64_t any_number = std::numeric_limits<std::uint64_t>::max();

    /// More are not worth their columns.
    [[nodiscard]] static constexpr std::size_t most_copies(std::size_t boxes) noexcept {
        return std::min(65'536 + 16 * boxes, std::size_t{1} << 30);
    }

    [[no_unique_address]] Sort sort_;
    [[no_unique_address]] Sweep sweep_;
    [[no_unique_address]] Counters counters_;
    column_lists columns_;
    bool is_filled_ = false;
};

}  // namespace aabb
