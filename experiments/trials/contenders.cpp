module aabblab.trials;

import :external;
import aabb.geometry;
import aabb.pipeline;

namespace aabblab {

namespace {

/// Takes a stage of the composition.
void use(contender& who, const aabb::composition& c, aabb::stage stage) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (info_of(kind).stage == stage) who.name[kind] = to_text(c[kind]);
    who.exact = who.exact && is_exact(c, stage);
    if (stage == aabb::stage::global_search) {
        who.exact_boxes = is_exact(c, stage);
        who.whole_boxes = needs_meshes(c).empty();
        who.make_global = [c](aabb::instrumentation counted) { return aabb::compose_global_search(c, counted); };
    } else {
        who.make_local = [c](aabb::instrumentation counted) { return aabb::compose_local_detection(c, counted); };
    }
}

}  // namespace

contender contender_of(const aabb::composition& c, bool meshes) {
    contender who;
    use(who, c, aabb::stage::global_search);
    if (meshes) use(who, c, aabb::stage::local_detection);
    return who;
}

contender contender_of(const aabb::named_strategies& named, const scene_play& scene) {
    aabb::composition whole = aabb::complete_composition(named);
    const auto selected = [named, outlook = outlook_of(scene)](aabb::composition& c) -> const aabb::composition& {
        select_for_scene(c, named, outlook);
        return c;
    };
    contender who = contender_of(selected(whole), scene.meshes() != nullptr);
    // To select is part of making the stages, and of their time.
    who.make_global = [selected, whole](aabb::instrumentation counted) mutable {
        return aabb::compose_global_search(selected(whole), counted);
    };
    if (who.make_local)
        who.make_local = [selected, whole](aabb::instrumentation counted) mutable {
            return aabb::compose_local_detection(selected(whole), counted);
        };
    // It has one name in all scenes, whatever is selected.
    who.name = {};
    who.name.engine = contender_name::automatic;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (named[kind])
            who.name.engine += " + " +
                               (named[kind]->name == "none" ? std::string(name_of(kind)) + " " : std::string()) +
                               to_text(*named[kind]);
    return who;
}

aabb::scene_outlook outlook_of(const scene_play& scene) {
    if (!scene.meshes()) return {.frames = scene.frames()};
    return aabb::outlook_of(scene.meshes()->meshes, scene.objects(), scene.frames());
}

std::optional<contender> contender_of(const aabb::engine_info& engine, bool meshes) {
    if (!engine.searches_boxes && !(meshes && engine.collides_meshes)) return std::nullopt;
    contender who;
    who.name.engine = engine.name;
    who.exact = engine.exact;
    if (engine.searches_boxes)
        who.make_global = [name = engine.name](aabb::instrumentation) { return aabb::make_box_engine(name); };
    else
        use(who, {}, aabb::stage::global_search);
    if (meshes && engine.collides_meshes)
        who.make_local = [name = engine.name](aabb::instrumentation) { return aabb::make_mesh_engine(name); };
    else if (meshes)
        use(who, {}, aabb::stage::local_detection);
    return who;
}

namespace {

contender contender_of(const external_engine& engine, const std::shared_ptr<exchange_folder>& exchange) {
    contender who;
    who.name.engine = engine.name;
    who.exact = who.exact_boxes = engine.exact;
    const std::shared_ptr told = std::make_unique<std::vector<told_times>>();
    who.told = told;
    who.make_global = [engine, exchange, told](aabb::instrumentation) {
        return std::make_unique<external_search>(engine, *exchange, *told);
    };
    return who;
}

}  // namespace

std::vector<contender> contenders_for(const experiment& e, const scene_choice& scene) {
    const bool meshes = has_meshes(scene);
    std::vector<contender> all;
    std::set<contender_name> names;
    for (const aabb::composition& c : e.compositions) {
        // Refused in a config; of all compositions that there are, it has no part in this scene.
        if (!meshes && !needs_meshes(c).empty()) continue;
        contender who = contender_of(c, meshes);
        // In a scene of boxes, compositions that differ in local detection only are one.
        if (names.insert(who.name).second) all.push_back(std::move(who));
    }
    if (!e.automatic.empty()) {
        const scene_play play(scene);
        for (const aabb::named_strategies& named : e.automatic) all.push_back(contender_of(named, play));
    }
    for (const std::string& name : e.engines) {
        const auto engine = std::ranges::find(aabb::engines(), name, &aabb::engine_info::name);
        if (std::optional<contender> who = contender_of(*engine, meshes)) all.push_back(*std::move(who));
    }
    if (meshes) return all;
    const std::shared_ptr exchange = std::make_unique<exchange_folder>(scene);
    for (const external_engine& engine : e.externals) all.push_back(contender_of(engine, exchange));
    return all;
}

std::string text_of(const contender_name& name) {
    std::string text = name.engine;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (const std::string one = text_in_line(kind, name[kind]); !one.empty())
            text += (text.empty() ? "" : " + ") + one;
    return text;
}

}  // namespace aabblab
