module aabb.extreme;

import aabb.engines;

namespace aabb {

namespace {

using pair_comparison = set_difference<index_pair>;

/// Records the first error; later ones are ignored.
void make_wrong(extreme_result& result, const std::string& reason) {
    if (result.outcome == verdict::wrong) return;
    result.outcome = verdict::wrong;
    result.reason = reason;
}

/// Records a rejection, unless there was an error or a rejection before.
void make_rejected(extreme_result& result, const input_error& rejection) {
    if (result.outcome != verdict::exact) return;
    result.outcome = verdict::rejected;
    result.reason = rejection.what();
}

/// Adds false negatives and false positives to a result; the first is the reason, which `where` begins: "frame 2".
void record_difference(extreme_result& result, const pair_comparison& difference, const std::string& where) {
    const auto text_of = [](const index_pair& pair) { return std::to_string(pair.a) + " " + std::to_string(pair.b); };
    result.false_negatives += difference.false_negatives.size();
    result.false_positives += difference.false_positives.size();
    if (!difference.false_negatives.empty())
        make_wrong(result, where + ": the pair " + text_of(difference.false_negatives[0]) + " is missing");
    if (!difference.false_positives.empty())
        make_wrong(result, where + ": the pair " + text_of(difference.false_positives[0]) +
                               (difference.repeated ? " is reported more than once"
                                                    : " is reported, but is not in the ground truth"));
}

/// Runs a broad phase over all frames, and compares the pairs of each with the ground truth.
void run(const exact_boxes& exact, global_stage& stage, extreme_result& result) {
    std::vector<index_pair> pairs;
    for (std::size_t frame = 0; frame < exact.size(); ++frame) {
        for (const std::uint32_t object : exact[frame].departures) stage.remove(object);
        for (const std::uint32_t object : exact[frame].arrivals) stage.insert(object);
        stage.update(exact[frame].boxes);
        pairs.clear();
        stage.search(pairs);
        std::ranges::sort(pairs);
        record_difference(result, {exact[frame].pairs, pairs}, "frame " + std::to_string(frame));
    }
}

/// One frame of the scene and its ground truth.
struct judged_frame {
    const mesh_scene& scene;
    const exact_mesh_frame& exact;
    std::string where;  ///< "frame 2"
};

/// Counts wrong pairs of triangles by class; a pair that is reported repeatedly counts once.
void add_classes(const mesh_scene& scene, pair_comparison difference, index_pair objects, const pose& pose_a,
                 const pose& pose_b, extreme_result& result) {
    const auto repeated = std::ranges::unique(difference.false_positives);
    difference.false_positives.erase(repeated.begin(), repeated.end());
    result.classes += compare_triangle_pairs(difference.false_negatives, difference.false_positives,
                                             scene.meshes[scene.mesh_of[objects.a]], pose_a,
                                             scene.meshes[scene.mesh_of[objects.b]], pose_b);
}

/// Compares the contacts of each two objects with the ground truth; wrong pairs also count by class (`add_classes`).
void judge_all_pairs(const judged_frame& current, pipeline& stages, extreme_result& result) {
    stages.search();
    stages.detect();
    for (const exact_objects& objects : current.exact.objects) {
        std::vector<index_pair> pairs;
        for (const contact& c : stages.contacts())
            if (c.a == objects.a && c.b == objects.b) pairs.push_back({c.triangle_a, c.triangle_b});
        std::ranges::sort(pairs);
        const pair_comparison difference(objects.pairs, pairs);
        record_difference(result, difference, current.where);
        add_classes(current.scene, difference, {objects.a, objects.b}, current.exact.poses[objects.a],
                    current.exact.poses[objects.b], result);
    }
}

/// Checks the queries that do not list all pairs: the count must be exact, and any true pair may come first.
void judge_queries(const judged_frame& current, extreme_query query, const exact_objects& objects, local_stage& stage,
                   extreme_result& result) {
    const std::uint32_t a = current.scene.mesh_of[objects.a], b = current.scene.mesh_of[objects.b];
    const pose& pose_a = current.exact.poses[objects.a];
    const pose& pose_b = current.exact.poses[objects.b];
    if (query != extreme_query::first_pair) {
        const std::uint64_t count = stage.count_pairs(a, pose_a, b, pose_b);
        if (count != objects.pairs.size())
            make_wrong(result, current.where + ": count_pairs returns " + std::to_string(count) + ", but there are " +
                                   std::to_string(objects.pairs.size()));
    }
    const std::optional<index_pair> first = stage.first_pair(a, pose_a, b, pose_b);
    if (first.has_value() != objects.intersect)
        make_wrong(result, current.where + (objects.intersect ? ": first_pair finds none, but there is one"
                                                              : ": first_pair finds one, but there is none"));
    else if (first && !is_true_pair(current.scene, current.exact, objects, *first))
        make_wrong(result, current.where + ": first_pair finds " + std::to_string(first->a) + " " +
                               std::to_string(first->b) + ", which do not intersect");
}

/// Compares the pairs of triangles that intersect within the scene's only mesh with the ground truth.
void judge_self_pairs(const mesh_scene& scene, const exact_meshes& exact, local_stage& stage, extreme_result& result) {
    std::vector<index_pair> pairs;
    stage.self_pairs(0, pairs);
    std::ranges::sort(pairs);
    const pair_comparison difference(exact.self_pairs, pairs);
    record_difference(result, difference, "self_pairs");
    add_classes(scene, difference, /*objects=*/{0, 0}, /*pose_a=*/{}, /*pose_b=*/{}, result);
}

/// Runs the scene's queries of a narrow phase over all frames. A scene with a `rejection` is invalid: for it only
/// contacts are requested, and the stage must throw an error that contains this text.
void run(const extreme_scene& scene, const exact_meshes& exact, local_stage& stage, extreme_result& result) {
    const std::unique_ptr<mesh_scene> meshes = scene.make_meshes();
    // Objects with overlapping boxes are candidates, so that a box that is too small causes false negatives.
    const std::unique_ptr<global_stage> boxes = make_box_engine("brute_force");
    std::optional<pipeline> stages;
    if (scene.rejection.empty())
        stages.emplace(*meshes, *boxes, stage);
    else
        stages.emplace(*meshes, stage);  // without a broad phase: all objects are candidates
    std::vector<pose> poses;
    for (std::size_t frame = 0; meshes->next(poses); ++frame) {
        stages->update(poses);
        if (!scene.rejection.empty()) {
            // An error of two poses together is only found when the pair is tested.
            stages->search();
            stages->detect();
            if (!stages->contacts().empty()) make_wrong(result, "finds pairs, but must reject the scene");
            continue;
        }
        const judged_frame current{*meshes, exact.frames[frame], "frame " + std::to_string(frame)};
        if (scene.query == extreme_query::all_pairs) judge_all_pairs(current, *stages, result);
        for (const exact_objects& objects : current.exact.objects)
            judge_queries(current, scene.query, objects, stage, result);
    }
    if (scene.rejection.empty() && scene.query == extreme_query::all_pairs && meshes->meshes.size() == 1)
        judge_self_pairs(*meshes, exact, stage, result);
}

/// Runs the work in the scene's floating-point mode, in which it must be rejected with the scene's message.
/// @param query names the work in messages
void require_rejection(const extreme_scene& scene, const std::string& query, const std::function<void()>& work,
                       extreme_result& result) {
    try {
        in_arithmetic(scene.computed_in, work);
        make_wrong(result, query + " returns a result, but must reject the scene");
    } catch (const input_error& error) {
        if (std::string_view(error.what()).find(scene.rejection) == std::string_view::npos)
            make_wrong(result, query + " rejects the scene for another reason: " + error.what());
        make_rejected(result, error);
    }
}

/// Checks that a broad phase, made and updated in IEEE arithmetic, rejects each call in the scene's mode.
void require_rejections(const extreme_scene& scene, const std::function<std::unique_ptr<global_stage>()>& make,
                        extreme_result& result) {
    std::vector<box> boxes;
    scene.make_boxes()->next(boxes);
    const std::unique_ptr<global_stage> stage = make();
    for (std::uint32_t object = 0; object < boxes.size(); ++object) stage->insert(object);
    stage->update(boxes);
    std::vector<index_pair> pairs;
    require_rejection(scene, "search", [&] { stage->search(pairs); }, result);
    require_rejection(scene, "update", [&] { stage->update(boxes); }, result);
}

/// Checks that a narrow phase, made in IEEE arithmetic, rejects each call in the scene's floating-point mode.
void require_rejections(const extreme_scene& scene, const std::function<std::unique_ptr<local_stage>()>& make,
                        extreme_result& result) {
    const std::unique_ptr<mesh_scene> meshes = scene.make_meshes();
    std::vector<pose> poses;
    meshes->next(poses);
    const mesh& m = meshes->meshes[0];
    const std::unique_ptr<local_stage> stage = make();
    stage->add_model(m);
    std::vector<index_pair> pairs;
    const auto require = [&](const std::string& query, const std::function<void()>& work) {
        require_rejection(scene, query, work, result);
    };
    require("all_pairs", [&] { stage->all_pairs(0, poses[0], 0, poses[1], pairs); });
    require("first_pair", [&] { static_cast<void>(stage->first_pair(0, poses[0], 0, poses[1])); });
    require("count_pairs", [&] { static_cast<void>(stage->count_pairs(0, poses[0], 0, poses[1])); });
    require("self_pairs", [&] { stage->self_pairs(0, pairs); });
    require("refit", [&] { stage->refit(0); });
    require("add_model", [&] { stage->add_model(m); });
}

/// Makes a stage, runs the scene, and turns exceptions into a result: an input_error is a rejection, any other is
/// wrong. A scene in another floating-point mode has no results, only calls that must be rejected.
/// @param run_frames called as (stage, result): runs all frames, and adds differences from the ground truth
template <class Stage, class RunFrames>
extreme_result result_of(const extreme_scene& scene, const std::function<std::unique_ptr<Stage>()>& make,
                         RunFrames run_frames) {
    extreme_result result;
    try {
        if (scene.computed_in != arithmetic::ieee) {
            require_rejections(scene, make, result);
        } else {
            const std::unique_ptr<Stage> stage = make();
            run_frames(*stage, result);
            for (const part_bytes& part : stage->bytes()) result.bytes += part.bytes;
        }
        if (!scene.rejection.empty() && !scene.accepted_in_double && result.outcome == verdict::exact)
            make_wrong(result, "returns a result, but must reject the scene");
    } catch (const input_error& error) {
        make_rejected(result, error);
    } catch (const std::exception& error) {
        make_wrong(result, std::string("fails: ") + error.what());
    }
    return result;
}

}  // namespace

extreme_judge::extreme_judge(extreme_scene scene) : scene_(std::move(scene)) {
    // Invalid input has no ground truth; for boxes only the frames are used.
    if (scene_.make_boxes) boxes_ = exact_boxes_of(*scene_.make_boxes());
    if (scene_.make_meshes && scene_.rejection.empty()) meshes_ = exact_meshes_of(*scene_.make_meshes(), scene_.query);
}

extreme_result extreme_judge::judge(const std::function<std::unique_ptr<global_stage>()>& make) const {
    return result_of(scene_, make, [&](global_stage& stage, extreme_result& result) { run(boxes_, stage, result); });
}

extreme_result extreme_judge::judge(const std::function<std::unique_ptr<local_stage>()>& make) const {
    return result_of(scene_, make,
                     [&](local_stage& stage, extreme_result& result) { run(scene_, meshes_, stage, result); });
}

bool is_as_expected(const extreme_scene& scene, const extreme_result& result, bool must_be_exact) {
    if (scene.rejection.empty()) return result.outcome == verdict::exact || !must_be_exact;
    if (scene.accepted_in_double && !must_be_exact && result.outcome == verdict::exact) return true;
    return result.outcome == verdict::rejected && result.reason.find(scene.rejection) != std::string::npos;
}

void require_stated_memory(const extreme_scene& scene, extreme_result& result) {
    if (scene.most_bytes > 0 && result.bytes > scene.most_bytes)
        make_wrong(result, "holds " + std::to_string(result.bytes) + " bytes, more than the limit of " +
                               std::to_string(scene.most_bytes));
}

}  // namespace aabb
