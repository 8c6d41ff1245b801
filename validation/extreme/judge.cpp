module aabb.extreme;

import aabb.engines;

namespace aabb {

namespace {

using pair_comparison = set_difference<index_pair>;

/// Keeps the first thing that is wrong.
void make_wrong(judgement& made, const std::string& reason) {
    if (made.said == verdict::wrong) return;
    made.said = verdict::wrong;
    made.reason = reason;
}

/// @param where "frame 2"
void add(judgement& made, const pair_comparison& found, const std::string& where) {
    const auto text_of = [](const index_pair& pair) { return std::to_string(pair.a) + " " + std::to_string(pair.b); };
    made.missing += found.missing.size();
    made.invented += found.invented.size();
    if (!found.missing.empty()) make_wrong(made, where + ": the pair " + text_of(found.missing[0]) + " is missing");
    if (!found.invented.empty())
        make_wrong(made, where + ": the pair " + text_of(found.invented[0]) +
                             (found.repeated ? " is reported more than once"
                                             : " is reported, but is not in the exact answer"));
}

std::size_t bytes_in(const std::vector<part_bytes>& parts) {
    std::size_t all = 0;
    for (const part_bytes& part : parts) all += part.bytes;
    return all;
}

void play(const exact_boxes& exact, global_stage& stage, judgement& made) {
    std::vector<index_pair> found;
    for (std::size_t frame = 0; frame < exact.size(); ++frame) {
        for (const std::uint32_t object : exact[frame].departures) stage.remove(object);
        for (const std::uint32_t object : exact[frame].arrivals) stage.insert(object);
        stage.update(exact[frame].boxes);
        found.clear();
        stage.search(found);
        std::ranges::sort(found);
        add(made, {exact[frame].pairs, found}, "frame " + std::to_string(frame));
    }
}

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
        std::ranges::sort(pairs);
        const pair_comparison found(objects.pairs, pairs);
        add(made, found, shown.where);
        add_classes(shown.scene, found, {objects.a, objects.b}, shown.exact.poses[objects.a],
                    shown.exact.poses[objects.b], made);
    }
}

/// By the queries that do not list all pairs.
void judge_queries(const shown_frame& shown, extreme_query asked, const exact_objects& objects, local_stage& stage,
                   judgement& made) {
    const std::uint32_t a = shown.scene.mesh_of[objects.a];
    const std::uint32_t b = shown.scene.mesh_of[objects.b];
    const pose& pose_a = shown.exact.poses[objects.a];
    const pose& pose_b = shown.exact.poses[objects.b];
    if (asked != extreme_query::first_pair) {
        const std::uint64_t count = stage.count_pairs(a, pose_a, b, pose_b);
        if (count != objects.pairs.size())
            make_wrong(made, shown.where + ": count_pairs says " + std::to_string(count) + ", there are " +
                                 std::to_string(objects.pairs.size()));
    }
    const std::optional<index_pair> first = stage.first_pair(a, pose_a, b, pose_b);
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
    std::ranges::sort(pairs);
    const pair_comparison found(exact.self_pairs, pairs);
    add(made, found, "self_pairs");
    add_classes(scene, found, {0, 0}, {}, {}, made);
}

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
        for (const exact_objects& objects : shown.exact.objects)
            judge_queries(shown, scene.asked, objects, stage, made);
    }
    if (scene.refusal.empty() && scene.asked == extreme_query::all_pairs && meshes->meshes.size() == 1)
        judge_self_pairs(*meshes, exact, stage, made);
}

/// Does the work of a query in the scene's arithmetic, and holds its sentence against what it must be refused with.
void require_refusal(const extreme_scene& scene, const std::string& query, const std::function<void()>& work,
                     judgement& made) {
    try {
        in_arithmetic(scene.computed_in, work);
        make_wrong(made, query + " answers, though it must refuse");
    } catch (const input_error& error) {
        const std::string said = error.what();
        if (said.find(scene.refusal) == std::string::npos)
            make_wrong(made, query + " refuses for another reason: " + said);
        if (made.said == verdict::exact) {
            made.said = verdict::refused;
            made.reason = said;
        }
    }
}

/// Every query of a stage that has taken a frame already.
void refuse_each_query(const extreme_scene& scene, const std::function<std::unique_ptr<global_stage>()>& make,
                       judgement& made) {
    std::vector<box> boxes;
    scene.make_boxes()->next(boxes);
    const std::unique_ptr<global_stage> stage = make();
    for (std::uint32_t object = 0; object < boxes.size(); ++object) stage->insert(object);
    stage->update(boxes);
    std::vector<index_pair> pairs;
    require_refusal(scene, "search", [&] { stage->search(pairs); }, made);
    require_refusal(scene, "update", [&] { stage->update(boxes); }, made);
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

/// Does the work, and says what it threw.
template <class Work>
judgement judged(const extreme_scene& scene, Work work) {
    judgement made;
    try {
        work(made);
        if (!scene.refusal.empty() && !scene.answered_in_double && made.said == verdict::exact)
            make_wrong(made, "answers, though it must refuse");
    } catch (const input_error& error) {
        if (made.said == verdict::exact) {
            made.said = verdict::refused;
            made.reason = error.what();
        }
    } catch (const std::exception& error) {
        make_wrong(made, std::string("breaks off: ") + error.what());
    }
    return made;
}

}  // namespace

extreme_judge::extreme_judge(extreme_scene scene) : scene_(std::move(scene)) {
    // Bad input has no exact answer: its frames only are played.
    if (scene_.make_boxes) boxes_ = exact_boxes_of(*scene_.make_boxes());
    if (scene_.make_meshes && scene_.refusal.empty()) meshes_ = exact_meshes_of(*scene_.make_meshes(), scene_.asked);
}

judgement extreme_judge::judge(const std::function<std::unique_ptr<global_stage>()>& make) const {
    return judged(scene_, [&](judgement& made) {
        if (scene_.computed_in != arithmetic::ieee) return refuse_each_query(scene_, make, made);
        const std::unique_ptr<global_stage> stage = make();
        play(boxes_, *stage, made);
        made.bytes = bytes_in(stage->bytes());
    });
}

judgement extreme_judge::judge(const std::function<std::unique_ptr<local_stage>()>& make) const {
    return judged(scene_, [&](judgement& made) {
        if (scene_.computed_in != arithmetic::ieee) return refuse_each_query(scene_, make, made);
        const std::unique_ptr<local_stage> stage = make();
        play(scene_, meshes_, *stage, made);
        made.bytes = bytes_in(stage->bytes());
    });
}

bool is_as_expected(const extreme_scene& scene, const judgement& made, bool must_be_exact) {
    if (scene.refusal.empty()) return made.said == verdict::exact || !must_be_exact;
    if (scene.answered_in_double && !must_be_exact && made.said == verdict::exact) return true;
    return made.said == verdict::refused && made.reason.find(scene.refusal) != std::string::npos;
}

void require_stated_memory(const extreme_scene& scene, judgement& made) {
    if (scene.most_bytes > 0 && made.bytes > scene.most_bytes)
        make_wrong(made, "holds " + std::to_string(made.bytes) + " bytes, more than the " +
                             std::to_string(scene.most_bytes) + " that are stated");
}

}  // namespace aabb
