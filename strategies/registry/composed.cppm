/// Makes list entries of strategies and table rows of combinations, whatever the kinds, for the registry's units.
export module aabb.composed;

import aabb.pipeline;
import aabb.registry;
import aabb.std;

export namespace aabb::composed {

/// The registry's entry of a strategy: its name, summary and parameters, and the optional members that it declares;
/// the others are empty in the entry. `check` throws input_error on invalid settings of a choice.
template <Strategy S>
[[nodiscard]] strategy_info strategy_info_of() {
    std::vector<absence> leaves_out;
    if constexpr (requires { S::leaves_out; }) leaves_out.assign(S::leaves_out.begin(), S::leaves_out.end());
    std::string needs_meshes;
    if constexpr (requires { S::needs_meshes; }) needs_meshes = S::needs_meshes;
    std::vector<strategy_choice> contrasts;
    if constexpr (requires { S::contrasts; })
        for (const std::string_view settings : S::contrasts)
            contrasts.push_back(parse_strategy(std::string(S::name) + ":" + std::string(settings)));
    scene_fit (*fit)(const scene_traits&) = nullptr;
    if constexpr (requires(const scene_traits& scene) { S::fit(scene); }) fit = &S::fit;
    return {
        .name = std::string(S::name),
        .summary = std::string(S::summary),
        .exact = strategy_is_exact<S>,
        .parameters = parameters_of<S>(),
        .leaves_out = leaves_out,
        .needs_meshes = needs_meshes,
        .contrasts = contrasts,
        .fit = fit,
        .check = [](const strategy_choice& choice) { (void)configured<S>(choice.settings); },
        .is_exact_with = [](const strategy_choice& choice) { return is_exact_as<S>(configured<S>(choice.settings)); }};
}

/// A combination of strategies that are compiled together. `make` takes a choice of each and the other parts of the
/// stage; it is null if the combination is rejected.
template <class Make>
struct row {
    std::vector<std::string_view> names;
    std::string_view rejection;
    Make make;
};

/// Calls `take` with each combination of one type per list.
template <class... Chosen, class Take>
void for_each_combination(Take& take) {
    take.template operator()<Chosen...>();
}
template <class... Chosen, class Take, class... First, class... Rest>
void for_each_combination(Take& take, type_list<First...>, Rest... rest) {
    (for_each_combination<Chosen..., First>(take, rest...), ...);
}

template <class Make>
[[nodiscard]] auto with_counters(instrumentation wanted, Make make) {
#if __has_feature(address_sanitizer)
    // Time does not matter: what counts serves both, and takes half the time to compile.
    static_cast<void>(wanted);
    return make(work_counters{});
#else
    if (wanted == instrumentation::counters) return make(work_counters{});
    return make(no_counters{});
#endif
}

/// A statically composed broad phase behind the interface of a stage.
template <class... Parts>
struct global_search_of {
    /// Makes a broad phase of the strategies `Parts` (sort, partition, sweep).
    /// @param choices settings of each strategy, in the same order
    [[nodiscard]] static std::unique_ptr<global_stage> make(std::span<const strategy_choice> choices,
                                                            instrumentation wanted) {
        return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<global_stage> {
            auto choice = choices.begin();
            // The elements of a braced list are evaluated from left to right.
            using search = global_search<Parts..., Counters>;
            return std::make_unique<searched_by<search>>(
                search{make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
        });
    }
};
using global_search_rows = std::vector<
    row<std::unique_ptr<global_stage> (*)(std::span<const strategy_choice> choices, instrumentation wanted)>>;

/// A statically composed narrow phase, whose tree builder is chosen separately.
template <class... Parts>
struct local_detection_of {
    /// Makes a narrow phase of the strategies `Parts` (tree, triangle test).
    /// @param choices settings of each strategy, in the same order
    /// @param builder builds the trees; chosen at run time
    [[nodiscard]] static std::unique_ptr<local_stage> make(std::span<const strategy_choice> choices,
                                                           tree_builder builder, instrumentation wanted) {
        return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<local_stage> {
            auto choice = choices.begin();
            // The elements of a braced list are evaluated from left to right.
            using detection = mesh_detection<tree_builder, Parts..., Counters>;
            return std::make_unique<detected_by<detection>>(
                detection{std::move(builder), make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
        });
    }
};
using local_detection_rows = std::vector<row<std::unique_ptr<local_stage> (*)(
    std::span<const strategy_choice> choices, tree_builder builder, instrumentation wanted)>>;

/// The table of a stage: one row for every combination of strategies, one of each list. A row contains their names and
/// the function that makes the stage, or if one of them rejects the combination, the reason and a null pointer.
/// @tparam Stage `Stage<Parts...>::make` makes the stage from these strategies
/// @param lists one `type_list` of strategies per kind
template <class Rows, template <class... Parts> class Stage, class... Lists>
[[nodiscard]] Rows rows_of(Lists... lists) {
    Rows rows;
    const auto add = [&]<class... Parts>() {
        constexpr std::string_view reason = rejection<Parts...>();
        rows.push_back({.names = {Parts::name...}, .rejection = reason, .make = nullptr});
        if constexpr (reason.empty()) rows.back().make = &Stage<Parts...>::make;
    };
    for_each_combination(add, lists...);
    return rows;
}

/// Concatenates table rows. Each function is in a source file of its own, so that a change recompiles few of them.
template <class Rows>
[[nodiscard]] Rows joined(std::initializer_list<Rows (*)()> functions) {
    Rows rows;
    for (const auto function : functions) {
        Rows part = function();
        rows.insert(rows.end(), part.begin(), part.end());
    }
    return rows;
}

/// Calls `make` with the strategy that has the name of the choice, constructed with its settings.
/// @returns the result of `make`; empty if none of the strategies has this name
template <class Result, class... Strategies, class Make>
[[nodiscard]] Result make_named(type_list<Strategies...>, const strategy_choice& choice, Make make) {
    Result result{};
    const auto try_strategy = [&]<class S>(type_list<S>) {
        if (S::name == choice.name) result = make(make_strategy<S>(configured<S>(choice.settings)));
    };
    (try_strategy(type_list<Strategies>{}), ...);
    return result;
}

}  // namespace aabb::composed
