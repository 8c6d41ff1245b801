module aabb.selection;

namespace aabb {

namespace {

/// What serves the scene better than the usual strategy; where none does, why the last that might does not.
struct fitting {
    std::string name;  ///< empty where none does
    scene_fit fit;
};

/// Among all of the kind where it stands apart, since they go with anything; else the one that the composition has.
fitting fitting_of(strategy_kind kind, const composition& completed, const scene_outlook& scene) {
    fitting last;
    for (const strategy_info& info : strategies(kind)) {
        if (!info.fit || (!info_of(kind).apart && info.name != completed[kind].name)) continue;
        last.fit = info.fit(scene);
        if (!last.fit.serves) continue;
        last.name = info.name;
        break;
    }
    return last;
}

/// What is named among what is fastest by itself, or where that is a sort, without a partition: what lies in columns is
/// sorted anew in each frame, which gains by `bucket` only. Where that is refused, among what usually goes with what is
/// named, and then among the first that is not.
composition completed(const named_strategies& named) {
    const composition usual(named);
    composition whole;
    composition fastest;
    if (const std::optional<strategy_choice>& sort = named[strategy_kind::sort];
        sort && sort->name != fastest[strategy_kind::sort].name)
        fastest[strategy_kind::partition] = {std::string(info_of(strategy_kind::partition).beside), {}};
    for (const stage of : {stage::global_search, stage::local_detection}) {
        const auto take = [&](const composition& others) {
            for (const strategy_kind kind : kinds_of(of))
                if (named[kind] || !info_of(kind).apart) whole[kind] = named[kind].value_or(others[kind]);
            return refusal_of(whole, of).empty();
        };
        if (take(fastest) || take(usual) || std::ranges::any_of(every_composition(of), take)) continue;
        // What is named is refused whatever else there is.
        take(usual);
    }
    return whole;
}

/// Of a strategy that depends on no scene; what it says of itself follows.
std::string usual_rule(strategy_kind kind, const strategy_choice& choice) {
    const std::string why = choice == composition()[kind] ? "the usual one" : "what goes with what is named";
    return why + ": " + std::ranges::find(strategies(kind), choice.name, &strategy_info::name)->summary;
}

}  // namespace

scene_outlook outlook_of(std::span<const mesh> meshes, std::size_t objects, std::size_t frames) {
    scene_outlook scene{.frames = frames,
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

void select_for_scene(composition& completed, const named_strategies& named, const scene_outlook& scene) {
    scene_outlook seen = scene;
    for (const strategy_kind kind : strategy_kinds) {
        if (named[kind] || !depends_on_scene(kind)) continue;
        strategy_choice& choice = completed[kind];
        choice.settings.clear();
        if (info_of(kind).apart) choice.name = info_of(kind).fallback;
        seen.exact_triangles = scene.triangles == 0 || is_exact(completed, stage::local_detection);
        fitting best = fitting_of(kind, completed, seen);
        if (!best.fit.serves) continue;
        choice = {std::move(best.name), std::move(best.fit.settings)};
    }
}

composition select_composition(const named_strategies& named, const scene_outlook& scene) {
    composition whole = complete_composition(named);
    select_for_scene(whole, named, scene);
    return whole;
}

std::vector<selected_strategy> select_strategies(const named_strategies& named, const scene_outlook& scene) {
    const composition whole = select_composition(named, scene);
    scene_outlook seen = scene;
    seen.exact_triangles = is_exact(whole, stage::local_detection);
    std::vector<selected_strategy> all;
    for (const strategy_kind kind : strategy_kinds) {
        std::string rule;
        for (const statement& reason : fitting_of(kind, whole, seen).fit.because)
            rule += (rule.empty() ? "" : "; ") + to_text(reason);
        if (rule.empty()) rule = usual_rule(kind, whole[kind]);
        all.push_back({kind, whole[kind], named[kind] ? "as it is named" : rule});
    }
    return all;
}

composition composed_of(const std::vector<selected_strategy>& selected) {
    composition c;
    for (const selected_strategy& one : selected) c[one.kind] = one.choice;
    return c;
}

}  // namespace aabb
