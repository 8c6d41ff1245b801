/// A global search composed statically, behind the interface of a stage.
export module aabb.composed.global_search;

import aabb.global_search;
import aabb.pipeline;
import aabb.policy;
import aabb.composed;
import aabb.std;

export namespace aabb::composed {

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
                using search = global_search<Parts..., Counters>;
                return std::make_unique<searched_by<search>>(
                    search{make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
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
