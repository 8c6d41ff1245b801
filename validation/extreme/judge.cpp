module aabb.extreme;

import aabb.base;
import aabb.geometry;
import aabb.pipeline;
import :comparison;

namespace aabb {

// Defined in judge_meshes.cpp.
void play(const extreme_scene& scene, const exact_meshes& exact, local_stage& stage, judgement& made);
void refuse_each_query(const extreme_scene& scene, const std::function<std::unique_ptr<local_stage>()>& make,
                       judgement& made);

namespace {

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
        add(made, {exact[frame].pairs, found}, "frame " + std::to_string(frame));
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
