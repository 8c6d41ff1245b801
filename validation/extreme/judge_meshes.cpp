module aabb.extreme;

import aabb.engines;
import aabb.geometry;
import aabb.pipeline;
import aabb.truth;
import :comparison;

namespace aabb {

namespace {

/// What stands in one frame of the scene.
struct shown_frame {
    const mesh_scene& scene;
    const exact_mesh_frame& exact;
    std::string where;  ///< "frame 2"
};

void add_classes(const mesh_scene& scene, pair_comparison found, index_pair objects, const pose& pose_a,
                 const pose& pose_b, judgement& made) {
    const auto repeated = std::ranges::unique(found.invented);
    found.invented.erase(repeated.begin(), repeated.end());
    made.classes += compare_triangle_pairs(found.missing, found.invented, scene.meshes[scene.mesh_of[objects.a]],
                                           pose_a, scene.meshes[scene.mesh_of[objects.b]], pose_b);
}

void judge_all_pairs(const shown_frame& shown, pipeline& both, judgement& made) {
    both.search();
    both.detect();
    for (const exact_objects& objects : shown.exact.objects) {
        std::vector<index_pair> pairs;
        for (const contact& c : both.contacts())
            if (c.a == objects.a && c.b == objects.b) pairs.push_back({c.triangle_a, c.triangle_b});
        const pair_comparison found(objects.pairs, std::move(pairs));
        add(made, found, shown.where);
        add_classes(shown.scene, found, {objects.a, objects.b}, shown.exact.poses[objects.a],
                    shown.exact.poses[objects.b], made);
    }
}

void judge_count(const shown_frame& shown, const exact_objects& objects, local_stage& stage, judgement& made) {
    const std::vector<std::uint32_t>& mesh_of = shown.scene.mesh_of;
    const std::vector<pose>& poses = shown.exact.poses;
    const std::uint64_t count =
        stage.count_pairs(mesh_of[objects.a], poses[objects.a], mesh_of[objects.b], poses[objects.b]);
    if (count != objects.pairs.size())
        make_wrong(made, shown.where + ": count_pairs says " + std::to_string(count) + ", there are " +
                             std::to_string(objects.pairs.size()));
}

void judge_first(const shown_frame& shown, const exact_objects& objects, local_stage& stage, judgement& made) {
    const std::vector<std::uint32_t>& mesh_of = shown.scene.mesh_of;
    const std::vector<pose>& poses = shown.exact.poses;
    const std::optional<index_pair> first =
        stage.first_pair(mesh_of[objects.a], poses[objects.a], mesh_of[objects.b], poses[objects.b]);
    if (first.has_value() != objects.meet)
        make_wrong(made, shown.where + (objects.meet ? ": first_pair finds none, but there is one"
                                                     : ": first_pair finds one, but there is none"));
    else if (first && !is_true_pair(shown.scene, shown.exact, objects, *first))
        make_wrong(made, shown.where + ": first_pair finds " + std::to_string(first->a) + " " +
                             std::to_string(first->b) + ", which do not intersect");
}

void judge_self_pairs(const mesh_scene& scene, const exact_meshes& exact, local_stage& stage, judgement& made) {
    std::vector<index_pair> pairs;
    stage.self_pairs(0, pairs);
    const pair_comparison found(exact.self_pairs, std::move(pairs));
    add(made, found, "self_pairs");
    add_classes(scene, found, {0, 0}, {}, {}, made);
}

}  // namespace

void play(const extreme_scene& scene, const exact_meshes& exact, local_stage& stage, judgement& made) {
    const std::unique_ptr<mesh_scene> meshes = scene.make_meshes();
    // Candidates are those whose boxes overlap, so that a box too small loses pairs. What must be refused meets as it
    // is.
    const std::unique_ptr<global_stage> boxes = make_box_engine("brute_force");
    std::optional<pipeline> both;
    if (scene.refusal.empty())
        both.emplace(*meshes, *boxes, stage);
    else
        both.emplace(*meshes, stage);
    std::vector<pose> poses;
    for (std::size_t frame = 0; meshes->next(poses); ++frame) {
        both->update(poses);
        if (!scene.refusal.empty()) {
            // What is wrong with two poses together is found where they meet.
            both->search();
            both->detect();
            if (!both->contacts().empty()) make_wrong(made, "finds pairs, though it must refuse");
            continue;
        }
        const shown_frame shown{*meshes, exact.frames[frame], "frame " + std::to_string(frame)};
        if (scene.asked == extreme_query::all_pairs) judge_all_pairs(shown, *both, made);
        for (const exact_objects& objects : shown.exact.objects) {
            if (scene.asked != extreme_query::first_pair) judge_count(shown, objects, stage, made);
            judge_first(shown, objects, stage, made);
        }
    }
    if (scene.refusal.empty() && scene.asked == extreme_query::all_pairs && meshes->meshes.size() == 1)
        judge_self_pairs(*meshes, exact, stage, made);
}

void refuse_each_query(const extreme_scene& scene, const std::function<std::unique_ptr<local_stage>()>& make,
                       judgement& made) {
    const std::unique_ptr<mesh_scene> meshes = scene.make_meshes();
    std::vector<pose> poses;
    meshes->next(poses);
    const mesh& m = meshes->meshes[0];
    const std::unique_ptr<local_stage> stage = make();
    stage->add_model(m);
    std::vector<index_pair> pairs;
    const auto require = [&](const std::string& query, const std::function<void()>& work) {
        require_refusal(scene, query, work, made);
    };
    require("all_pairs", [&] { stage->all_pairs(0, poses[0], 0, poses[1], pairs); });
    require("first_pair", [&] { static_cast<void>(stage->first_pair(0, poses[0], 0, poses[1])); });
    require("count_pairs", [&] { static_cast<void>(stage->count_pairs(0, poses[0], 0, poses[1])); });
    require("self_pairs", [&] { stage->self_pairs(0, pairs); });
    require("refit", [&] { stage->refit(0); });
    require("add_model", [&] { stage->add_model(m); });
}

}  // namespace aabb
