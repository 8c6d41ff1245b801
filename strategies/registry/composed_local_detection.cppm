/// A local detection composed statically, behind the interface of a stage.
export module aabb.composed.local_detection;

import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import aabb.policy;
import aabb.composed;
import aabb.std;

export namespace aabb::composed {

/// A build that is chosen apart from the tree.
struct chosen_build {
    std::unique_ptr<tree_builder> chosen;

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const {
        return chosen->build(m, arrangement);
    }
    [[nodiscard]] balanced_order order(const mesh& m) const { return chosen->order(m); }
};

using make_local_detection = std::unique_ptr<local_stage> (*)(std::span<const strategy_choice> choices,
                                                              std::unique_ptr<tree_builder> builder,
                                                              instrumentation counted);
using local_detection_rows = std::vector<row<make_local_detection>>;

template <class... Parts>
[[nodiscard]] row<make_local_detection> local_detection_row() {
    constexpr std::string_view reason = refusal<Parts...>();
    row<make_local_detection> made{{Parts::name...}, reason, nullptr};
    if constexpr (reason.empty())
        made.make = [](std::span<const strategy_choice> choices, std::unique_ptr<tree_builder> builder,
                       instrumentation wanted) {
            return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<local_stage> {
                auto choice = choices.begin();
                // Braces are evaluated from left to right.
                using detection = mesh_detection<chosen_build, Parts..., Counters>;
                return std::make_unique<detected_by<detection>>(
                    detection{chosen_build{std::move(builder)},
                              make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
            });
        };
    return made;
}

/// Every combination of one strategy a list.
template <class... Lists>
[[nodiscard]] local_detection_rows rows_of_local_detection(Lists... lists) {
    local_detection_rows rows;
    const auto add = [&]<class... Parts>() { rows.push_back(local_detection_row<Parts...>()); };
    for_each_combination(add, lists...);
    return rows;
}

}  // namespace aabb::composed
