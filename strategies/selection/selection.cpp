module aabb.selection;

namespace aabb {

namespace {

/// The strategy that fits the scene better than the default; if none does, the reason of the last candidate.
struct fitting {
    std::string name;  ///< empty if none fits
    scene_fit fit;
};

/// Finds the first strategy of a kind whose rule (`fit`) states that it serves the scene. Strategies that are template
/// arguments of one stage (not `is_compiled_alone`) may be rejected beside each other, so of such a kind only the
/// composition's strategy is considered.
/// @returns its name and the reason; if none serves the scene, no name, and the reason of the last that was considered
fitting fitting_of(strategy_kind kind, const composition& completed, const scene_traits& scene) {
    fitting last;
    for (const strategy_info& info : strategies(kind)) {
        if (!info.fit || (!info_of(kind).is_compiled_alone && info.name != completed[kind].name)) continue;
        last.fit = info.fit(scene);
        if (!last.fit.serves) continue;
        last.name = info.name;
        break;
    }
    return last;
}

/// Completes the named strategies of each stage to an accepted combination: by preference with the fastest ones (the
/// defaults), those usual beside the named ones, or the first accepted. A named sort other than the fastest gets no
/// partition: columns are sorted anew in each frame, for which only `bucket` is fast.
composition completed(const named_strategies& named) {
    const composition usual(named);
    composition result;
    composition fastest;
    if (const std::optional<strategy_choice>& sort = named[strategy_kind::sort];
        sort && sort->name != fastest[strategy_kind::sort].name)
        fastest[strategy_kind::partition] = {std::string(info_of(strategy_kind::partition).default_with), {}};
    for (const stage of : {stage::global_search, stage::local_detection}) {
        // Takes the named strategies and those of `others` for the other kinds; returns whether they are accepted.
        const auto take = [&](const composition& others) {
            for (const strategy_kind kind : kinds_of(of))
                if (named[kind] || !info_of(kind).is_compiled_alone) result[kind] = named[kind].value_or(others[kind]);
            return rejection_of(result, of).empty();
        };
        if (take(fastest) || take(usual) || std::ranges::any_of(every_composition(of), take)) continue;
        // The named strategies are rejected in any combination.
        take(usual);
    }
    return result;
}

/// The rule for a strategy that does not depend on the scene, followed by its summary.
std::string usual_rule(strategy_kind kind, const strategy_choice& choice) {
    const std::string why = choice == composition()[kind] ? "the default" : "compatible with the named strategies";
    return why + ": " + std::ranges::find(strategies(kind), choice.name, &strategy_info::name)->summary;
}

}  // namespace

scene_traits traits_of(std::span<const mesh> meshes, std::size_t objects, std::size_t frames) {
    scene_traits scene{.frames = frames,
                       .queries = frames * std::max<std::size_t>(objects / 2, 1),
                       .meshes = std::max<std::size_t>(meshes.size(), 1)};
    for (const mesh& m : meshes) scene.triangles += m.triangle_count();
    return scene;
}

bool depends_on_scene(strategy_kind kind) {
    return std::ranges::any_of(strategies(kind), [](const strategy_info& info) { return info.fit != nullptr; });
}

composition complete_composition(const named_strategies& named) {
    const bool any = std::ranges::any_of(strategy_kinds, [&](strategy_kind kind) { return named[kind].has_value(); });
    return any ? completed(named) : composition();
}

/// Selects a strategy for each kind that has rules for scenes and is not named: the first that serves the scene, or the
/// default.
/// @param completed input and output: has a strategy of every kind, among which the selected ones are accepted
void select_for_scene(composition& completed, const named_strategies& named, const scene_traits& scene) {
    scene_traits traits = scene;
    for (const strategy_kind kind : strategy_kinds) {
        if (named[kind] || !depends_on_scene(kind)) continue;
        strategy_choice& choice = completed[kind];
        choice.settings.clear();
        if (info_of(kind).is_compiled_alone) choice.name = info_of(kind).fallback;
        // Some rules require that the other strategies of the narrow phase are exact.
        traits.exact_triangles = scene.triangles == 0 || is_exact(completed, stage::local_detection);
        fitting best = fitting_of(kind, completed, traits);
        if (!best.fit.serves) continue;
        choice = {std::move(best.name), std::move(best.fit.settings)};
    }
}

composition select_composition(const named_strategies& named, const scene_traits& scene) {
    composition selected = complete_composition(named);
    select_for_scene(selected, named, scene);
    return selected;
}

/// Selects the composition for the scene, and states for each kind why it has its strategy: the reasons of the rule
/// that selected it, or that it was named, is the default, or is compatible with the named ones.
std::vector<selected_strategy> select_strategies(const named_strategies& named, const scene_traits& scene) {
    const composition selected_composition = select_composition(named, scene);
    scene_traits traits = scene;
    traits.exact_triangles = is_exact(selected_composition, stage::local_detection);
    std::vector<selected_strategy> selected;
    for (const strategy_kind kind : strategy_kinds) {
        std::string rule;
        for (const statement& reason : fitting_of(kind, selected_composition, traits).fit.because)
            rule += (rule.empty() ? "" : "; ") + to_text(reason);
        const strategy_choice& choice = selected_composition[kind];
        if (rule.empty()) rule = usual_rule(kind, choice);
        selected.push_back({kind, choice, named[kind] ? "as named" : rule});
    }
    return selected;
}

composition composed_of(const std::vector<selected_strategy>& selected) {
    composition c;
    for (const selected_strategy& s : selected) c[s.kind] = s.choice;
    return c;
}

}  // namespace aabb
