module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

export module aabb.pipeline:searched_by;

import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import :stage;

export namespace aabb {

/// What a global search whose type is known holds on the heap, part by part; what it is made without is no part.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters>
[[nodiscard]] std::vector<part_bytes> bytes_by_part(const global_search<Sort, Partition, Sweep, Counters>& search) {
    std::vector<part_bytes> parts{{"projections", search.projection_bytes()}, {"sort", search.sort_bytes()}};
    if constexpr (really_cuts<Partition>) parts.push_back({"partition", search.partition_bytes()});
    parts.push_back({"sweep", search.sweep_bytes()});
    return parts;
}

template <class Search>
class searched_by;

/// A global search whose type is known, as a stage.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters>
class searched_by<global_search<Sort, Partition, Sweep, Counters>> final : public global_stage {
public:
    explicit searched_by(global_search<Sort, Partition, Sweep, Counters> search) : search_(std::move(search)) {}

    void insert(std::uint32_t id) override { search_.insert(id); }
    void remove(std::uint32_t id) override { search_.remove(id); }
    void update(std::span<const box> boxes) override { search_.update(boxes); }
    void search(std::vector<index_pair>& pairs) override { search_.search(pairs); }
    [[nodiscard]] work_counters counters() const override { return work_of(search_.counters()); }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return bytes_by_part(search_); }

    [[nodiscard]] std::vector<stage_plan> plans() const override {
        if constexpr (ColumnPartition<Partition>)
            if (!search_.is_uncut()) {
                constexpr std::string_view along[2][3]{
                    {"{u} by {v} columns along the x axis", "{u} by {v} columns along the y axis",
                     "{u} by {v} columns along the z axis"},
                    {"{u} by {v} groups of columns along the x axis", "{u} by {v} groups of columns along the y axis",
                     "{u} by {v} groups of columns along the z axis"}};
                const column_plan& plan = search_.plan();
                const bool in_groups = search_.is_in_groups();
                return {{in_groups ? "groups of columns" : "columns",
                         {plan.columns() == 1 ? "one column, cut nowhere" : along[in_groups ? 1 : 0][plan.axis],
                          {{{"u", static_cast<double>(plan.across[0])},
                            {"v", static_cast<double>(plan.across[1])},
                            {"axis", static_cast<double>(plan.axis)}}}}}};
            }
        return {};
    }

    [[nodiscard]] std::vector<omission> left_out() const override {
        std::vector<omission> absent;
        if constexpr (!really_cuts<Partition>) absent.push_back({"no partition", "no cells, no copies of objects"});
        if constexpr (ColumnPartition<Partition>)
            if (search_.is_uncut())
                for (const char* what : {"no partition", "no sort"})
                    absent.push_back({what, "so few boxes are tested each against each"});
        if constexpr (CoherentSweep<Sweep>)
            absent.push_back({"no projection lists beside those that the sweep keeps for itself", {}});
        for (std::size_t k = 0; k < 3; ++k)
            if (!has_axis(search_.sorted_axes(), k))
                absent.push_back({std::string("no projection list of the ") + "xyz"[k] + " axis", {}});
        if constexpr (!Counters::enabled) absent.push_back({"no work counters", {}});
        return absent;
    }

private:
    global_search<Sort, Partition, Sweep, Counters> search_;
};

}  // namespace aabb
