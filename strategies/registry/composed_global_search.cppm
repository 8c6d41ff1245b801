module;
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// A global search composed statically, behind the interface of a stage.
export module aabb.composed.global_search;

import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.pipeline;
import aabb.policy;
import aabb.composed;

export namespace aabb::composed {

template <CounterPolicy Counters, SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep>
class composed_global_stage final : public global_stage {
    static constexpr bool cuts = CuttingPartition<Partition> || ColumnPartition<Partition>;

public:
    composed_global_stage(Sort sort, Partition partition, Sweep sweep)
        : search_(std::move(sort), std::move(partition), std::move(sweep)) {}

    void insert(std::uint32_t id) override { search_.insert(id); }
    void remove(std::uint32_t id) override { search_.remove(id); }
    void update(std::span<const box> boxes) override { search_.update(boxes); }
    void search(std::vector<index_pair>& pairs) override { search_.search(pairs); }
    [[nodiscard]] work_counters counters() const override { return counted(search_.counters()); }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts{{"projections", search_.projection_bytes()}, {"sort", search_.sort_bytes()}};
        if constexpr (cuts) parts.push_back({"partition", search_.partition_bytes()});
        parts.push_back({"sweep", search_.sweep_bytes()});
        return parts;
    }

    [[nodiscard]] std::vector<std::string> left_out() const override {
        std::vector<std::string> absent;
        if constexpr (!cuts) absent.emplace_back("no partition: no cells, no copies of objects");
        if constexpr (CoherentSweep<Sweep>)
            absent.emplace_back("no projection lists beside those that the sweep keeps for itself");
        for (std::size_t k = 0; k < 3; ++k)
            if (!has_axis(search_.sorted_axes(), k))
                absent.push_back(std::string("no projection list of the ") + "xyz"[k] + " axis");
        if constexpr (!Counters::enabled) absent.emplace_back("no work counters");
        return absent;
    }

private:
    global_search<Sort, Partition, Sweep, Counters> search_;
};

using make_global_search = std::unique_ptr<global_stage> (*)(std::span<const strategy_choice> choices,
                                                             instrumentation counted);
using global_search_rows = std::vector<row<make_global_search>>;

template <class... Parts>
[[nodiscard]] row<make_global_search> global_search_row() {
    constexpr std::string_view reason = refusal<Parts...>();
    row<make_global_search> made{{Parts::name...}, reason, nullptr};
    if constexpr (reason.empty())
        made.make = [](std::span<const strategy_choice> choices, instrumentation wanted) {
            return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<global_stage> {
                auto choice = choices.begin();
                // Braces are evaluated from left to right.
                return std::unique_ptr<global_stage>(new composed_global_stage<Counters, Parts...>{
                    make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
            });
        };
    return made;
}

/// Every combination of one strategy a list.
template <class... Lists>
[[nodiscard]] global_search_rows rows_of_global_search(Lists... lists) {
    global_search_rows rows;
    const auto add = [&]<class... Parts>() { rows.push_back(global_search_row<Parts...>()); };
    for_each_combination(add, lists...);
    return rows;
}

}  // namespace aabb::composed
