/// What turns strategies into entries of lists and combinations of them into rows of tables, for the generated units of
/// the registry. It knows no kinds.
export module aabb.composed;

import aabb.pipeline;
import aabb.registry;
import aabb.std;

export namespace aabb::composed {

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
    scene_fit (*fit)(const scene_outlook&) = nullptr;
    if constexpr (requires(const scene_outlook& scene) { S::fit(scene); }) fit = &S::fit;
    return {std::string(S::name),
            std::string(S::summary),
            strategy_is_exact<S>,
            parameters_of<S>(),
            leaves_out,
            needs_meshes,
            contrasts,
            fit,
            [](const strategy_choice& choice) { (void)configured<S>(choice.settings); },
            [](const strategy_choice& choice) { return is_exact_as<S>(configured<S>(choice.settings)); }};
}

/// A combination of the strategies that are compiled together; `make`, which takes a choice of each and what else the
/// stage is made of, is null where the combination is refused.
template <class Make>
struct row {
    std::vector<std::string_view> names;
    std::string_view refusal;
    Make make;
};

/// Calls `take` with each combination of one type a list.
template <class... Chosen, class Take>
void for_each_combination(Take& take) {
    take.template operator()<Chosen...>();
}
template <class... Chosen, class Take, class... First, class... Rest>
void for_each_combination(Take& take, type_list<First...>, Rest... rest) {
    (for_each_combination<Chosen..., First>(take, rest...), ...);
}

/// Calls `make` with the counters that are asked for.
template <class Make>
[[nodiscard]] auto with_counters(instrumentation wanted, Make make) {
    if (wanted == instrumentation::counters) return make(work_counters{});
    return make(no_counters{});
}

/// A global search composed statically, behind the interface of a stage.
template <class... Parts>
struct global_search_of {
    [[nodiscard]] static std::unique_ptr<global_stage> make(std::span<const strategy_choice> choices,
                                                            instrumentation wanted) {
        return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<global_stage> {
            auto choice = choices.begin();
            // Braces are evaluated from left to right.
            using search = global_search<Parts..., Counters>;
            return std::make_unique<searched_by<search>>(
                search{make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
        });
    }
};
using global_search_rows = std::vector<
    row<std::unique_ptr<global_stage> (*)(std::span<const strategy_choice> choices, instrumentation wanted)>>;

/// A local detection likewise, with a build that is chosen apart from the tree.
template <class... Parts>
struct local_detection_of {
    [[nodiscard]] static std::unique_ptr<local_stage> make(std::span<const strategy_choice> choices,
                                                           tree_builder builder, instrumentation wanted) {
        return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<local_stage> {
            auto choice = choices.begin();
            using detection = mesh_detection<tree_builder, Parts..., Counters>;
            return std::make_unique<detected_by<detection>>(
                detection{std::move(builder), make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
        });
    }
};
using local_detection_rows = std::vector<row<std::unique_ptr<local_stage> (*)(
    std::span<const strategy_choice> choices, tree_builder builder, instrumentation wanted)>>;

/// Every combination of one strategy a list.
/// @tparam Stage `Stage<Parts...>::make` makes the stage of these strategies
template <class Rows, template <class... Parts> class Stage, class... Lists>
[[nodiscard]] Rows rows_of(Lists... lists) {
    Rows rows;
    const auto add = [&]<class... Parts>() {
        constexpr std::string_view reason = refusal<Parts...>();
        rows.push_back({{Parts::name...}, reason, nullptr});
        if constexpr (reason.empty()) rows.back().make = &Stage<Parts...>::make;
    };
    for_each_combination(add, lists...);
    return rows;
}

/// All rows that these functions return.
template <class Rows>
[[nodiscard]] Rows joined(std::initializer_list<Rows (*)()> parts) {
    Rows all;
    for (const auto part : parts) {
        Rows some = part();
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

/// What `make` makes of the strategy of that name, as it is configured.
template <class Result, class... Strategies, class Make>
[[nodiscard]] Result made(type_list<Strategies...>, const strategy_choice& choice, Make make) {
    Result result{};
    const auto try_one = [&]<class S>(type_list<S>) {
        if (S::name == choice.name) result = make(make_strategy<S>(configured<S>(choice.settings)));
    };
    (try_one(type_list<Strategies>{}), ...);
    return result;
}

}  // namespace aabb::composed
