module aabblab.extreme;

import :contenders;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.validation;
import aabblab.progress;

namespace aabblab {

namespace {

constexpr auto uncounted = aabb::instrumentation::none;

/// Those who play scenes of boxes, or of meshes.
template <class Stage>
struct contender {
    std::string name;
    contender_role role;
    bool must_be_exact;
    bool lists_candidates;  ///< all of them before it decides on the first
    std::function<std::unique_ptr<Stage>()> make;
};

std::vector<contender<aabb::global_stage>> box_contenders(bool named_values) {
    std::vector<contender<aabb::global_stage>> all;
    for (const aabb::composition& c : exact_compositions(aabb::stage::global_search, named_values))
        all.push_back({to_text(c, aabb::stage::global_search), contender_role::composition, true, false,
                       [c] { return aabb::compose_global_search(c, uncounted); }});
    // Boxes are compared, not computed with: every engine must be exact.
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.searches_boxes)
            all.push_back({engine.name, contender_role::engine, true, false,
                           [name = engine.name] { return aabb::make_box_engine(name); }});
    return all;
}

std::vector<contender<aabb::local_stage>> mesh_contenders(bool named_values) {
    std::vector<contender<aabb::local_stage>> all;
    const auto add = [&](const aabb::composition& c, contender_role role, std::string name) {
        all.push_back({std::move(name), role, role == contender_role::composition, false,
                       [c] { return aabb::compose_local_detection(c, uncounted); }});
    };
    for (const aabb::composition& c : exact_compositions(aabb::stage::local_detection, named_values))
        add(c, contender_role::composition, to_text(c, aabb::stage::local_detection));
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.collides_meshes)
            all.push_back({engine.name, contender_role::engine, engine.exact, true,
                           [name = engine.name] { return aabb::make_mesh_engine(name); }});
    for (const aabb::composition& c : inexact_compositions())
        add(c, contender_role::triangle_test, to_text(c[aabb::strategy_kind::triangle]));
    return all;
}

template <class Stage>
void play_scene(const aabb::extreme_judge& judge, row_group group, const std::vector<contender<Stage>>& contenders,
                std::vector<extreme_row>& rows) {
    const aabb::extreme_scene& scene = judge.scene();
    for (const contender<Stage>& who : contenders) {
        if (who.lists_candidates && scene.asked == aabb::extreme_query::first_pair) continue;
        extreme_row row{group, scene.name, scene.summary, "", who.name, who.role, who.must_be_exact, true, {}};
        row.made = judge.judge(who.make);
        if (who.role == contender_role::composition) require_stated_memory(scene, row.made);
        row.as_expected = is_as_expected(scene, row.made, who.must_be_exact);
        rows.push_back(std::move(row));
    }
}

}  // namespace

std::vector<extreme_row> play_scenes(std::span<const aabb::extreme_scene> scenes, aabb::extreme_size size) {
    const bool named_values = size == aabb::extreme_size::full;
    const auto of_boxes = box_contenders(named_values);
    const auto of_meshes = mesh_contenders(named_values);
    // Of as many triangles, parameters would show nothing new and take minutes.
    const auto of_many = mesh_contenders(false);
    std::vector<extreme_row> rows;
    progress shown("extreme scenes", scenes.size());
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const aabb::extreme_judge judge(scenes[i]);
        if (scenes[i].make_boxes)
            play_scene(judge, row_group::boxes, of_boxes, rows);
        else
            play_scene(judge, row_group::meshes, scenes[i].most_bytes > 0 ? of_many : of_meshes, rows);
        shown.at(i + 1);
    }
    return rows;
}

}  // namespace aabblab
