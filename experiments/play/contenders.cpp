module;
#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

module aabblab.play;

import :player;
import aabb;
import aabb.registry;
import aabb.validation;
import aabblab.configs;
import aabblab.scenes;

namespace aabblab {

namespace {

void use_global(contender& who, const aabb::global_composition& composition) {
    who.name.sort = to_text(composition.sort);
    who.name.partition = to_text(composition.partition);
    who.name.sweep = to_text(composition.sweep);
    who.name.split_large = split_large_text(composition);
    who.exact_boxes = is_exact(composition);
    who.exact = who.exact && who.exact_boxes;
    who.make_global = [composition](aabb::instrumentation counted) { return aabb::compose(composition, counted); };
}

void use_local(contender& who, const aabb::local_composition& composition) {
    who.name.tree = to_text(composition.tree);
    who.name.triangle = to_text(composition.triangle);
    who.exact = who.exact && is_exact(composition);
    who.make_local = [composition](aabb::instrumentation counted) { return aabb::compose(composition, counted); };
}

}  // namespace

contender contender_of(const composition& composition, bool meshes) {
    contender who;
    use_global(who, composition.global);
    if (meshes) use_local(who, composition.local);
    return who;
}

std::optional<contender> contender_of(const aabb::engine_info& engine, bool meshes) {
    if (!engine.searches_boxes && !(meshes && engine.collides_meshes)) return std::nullopt;
    contender who;
    who.name.engine = engine.name;
    who.exact = engine.exact;
    if (engine.searches_boxes)
        who.make_global = [name = engine.name](aabb::instrumentation) { return aabb::make_box_engine(name); };
    else
        use_global(who, {});
    if (meshes && engine.collides_meshes)
        who.make_local = [name = engine.name](aabb::instrumentation) { return aabb::make_mesh_engine(name); };
    else if (meshes)
        use_local(who, {});
    return who;
}

bool has_meshes(const scene_choice& scene) {
    const auto info = std::ranges::find(scene_kinds(), scene.kind, &scene_info::name);
    return info != scene_kinds().end() && info->has_meshes;
}

std::vector<contender> contenders_for(const experiment& e, const scene_choice& scene) {
    const bool meshes = has_meshes(scene);
    std::vector<contender> all;
    std::set<contender_name> names;
    for (const composition& c : e.compositions) {
        contender who = contender_of(c, meshes);
        // In a scene of boxes, compositions that differ in local detection only are one.
        if (names.insert(who.name).second) all.push_back(std::move(who));
    }
    for (const std::string& name : e.engines) {
        const auto engine = std::ranges::find(aabb::engines(), name, &aabb::engine_info::name);
        if (std::optional<contender> who = contender_of(*engine, meshes)) all.push_back(*std::move(who));
    }
    return all;
}

std::string text_of(const contender_name& name) {
    std::string text;
    const std::string split =
        name.split_large.empty() || name.split_large == "off" ? "" : "split_large=" + name.split_large;
    for (const std::string* part :
         {&name.engine, &name.sort, &name.partition, &name.sweep, &split, &name.tree, &name.triangle})
        if (!part->empty()) text += (text.empty() ? "" : " + ") + *part;
    return text;
}

}  // namespace aabblab
