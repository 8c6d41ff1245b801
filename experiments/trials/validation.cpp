module aabblab.trials;

import aabblab.fmt;
import aabblab.progress;

namespace aabblab {

namespace {

std::string text_of(const aabb::index_pair& pair) {
    return fmt::format("the pair {} {}", pair.a, pair.b);
}

std::string text_of(const aabb::contact& c) {
    return fmt::format("the contact of objects {} {} in their triangles {} {}", c.a, c.b, c.triangle_a, c.triangle_b);
}

/// Describes the first difference; empty if there is none.
template <class T>
std::string first_difference(const aabb::set_difference<T>& d) {
    if (d.false_negatives.empty() && d.false_positives.empty()) return {};
    if (d.false_positives.empty() || (!d.false_negatives.empty() && d.false_negatives[0] < d.false_positives[0]))
        return text_of(d.false_negatives[0]) + " is a false negative";
    return text_of(d.false_positives[0]) + (d.repeated ? " is reported more than once" : " is a false positive");
}

class validated_runner {
public:
    validated_runner(const candidate& tested, const scene_choice& choice, const scene_frames& scene)
        : candidate_(tested),
          choice_(choice),
          scene_(scene),
          runner_(tested, scene, aabb::instrumentation::counters),
          tally_(scene.meshes() != nullptr) {}

    /// Runs a frame with work counters, and compares pairs of boxes and contacts with the ground truth. A difference is
    /// a failure if the candidate must be exact. Boxes are not comparable if it divides objects (`whole_boxes`).
    void compare_frame(std::size_t frame, const aabb::ground_truth& truth) {
        runner_.update();
        runner_.search();
        runner_.detect();
        if (frame == 0) first_frame_ = runner_.counters();
        tally_.add(runner_.sorted_pairs(), runner_.sorted_contacts());
        if (candidate_.whole_boxes) {
            const aabb::set_difference boxes(truth.pairs(), runner_.sorted_pairs());
            if (candidate_.exact_boxes) record_failure(frame, first_difference(boxes));
            box_false_negatives_ += boxes.false_negatives.size();
            box_false_positives_ += boxes.false_positives.size();
        }
        if (!scene_.meshes()) return;
        const aabb::set_difference contacts(truth.contacts(), runner_.sorted_contacts());
        if (candidate_.exact) record_failure(frame, first_difference(contacts));
        contact_false_negatives_ += contacts.false_negatives.size();
        contact_false_positives_ += contacts.false_positives.size();
        classify(contacts);
    }

    /// The row of results.csv for all frames, without times; errors are those of contacts or, without meshes, of boxes.
    [[nodiscard]] validated_row result() const {
        validated_row v;
        v.scene = choice_;
        v.objects = scene_.objects();
        v.frames = scene_.frames();
        v.name = candidate_.name;
        v.failure = failure_;
        v.candidates = tally_.candidates();
        v.contacts = tally_.contacts();
        v.digest = tally_.digest();
        v.false_negatives = scene_.meshes() ? contact_false_negatives_ : box_false_negatives_;
        v.false_positives = scene_.meshes() ? contact_false_positives_ : box_false_positives_;
        add_differences(v.differences, "missing", box_false_negatives_, classes_.false_negatives);
        add_differences(v.differences, "invented", box_false_positives_, classes_.false_positives);
        v.status = v.differences.empty() ? "exact" : "inexact";
        if (scene_.meshes()) {
            v.triangles = 0;
            for (const aabb::mesh& m : scene_.meshes()->meshes) *v.triangles += m.triangles.size();
            v.box_inflation = runner_.box_inflation();
        }
        fill_counts(v);
        // The memory of an external engine is unknown.
        if (!candidate_.reported) fill_bytes(v);
        return v;
    }

private:
    /// Sums the work after frame 0, or of frame 0 if it is the only one; empty if all is 0: engines have no counters.
    void fill_counts(row& r) const {
        aabb::work_counters work = runner_.counters();
        if (scene_.frames() > 1)
            for (std::size_t i = 0; i < work.counts.size(); ++i) work.counts[i] -= first_frame_.counts[i];
        if (std::ranges::any_of(work.counts, [](std::uint64_t n) { return n > 0; }))
            std::ranges::copy(work.counts, r.counts.begin());
    }

    /// Sums the bytes by column; parts without a column of their own belong to the last one, `engine`.
    void fill_bytes(row& r) const {
        r.bytes.fill(0);
        for (const auto& parts : {runner_.global_bytes(), runner_.local_bytes()})
            for (const aabb::part_bytes& part : parts) {
                auto column = std::ranges::find(byte_columns, part.part);
                if (column == byte_columns.end()) --column;
                *r.bytes[static_cast<std::size_t>(column - byte_columns.begin())] += part.bytes;
            }
    }

    void record_failure(std::size_t frame, const std::string& difference) {
        if (!failure_.empty() || difference.empty()) return;
        failure_ = text_of(candidate_.name) + " has a wrong result on " + choice_.kind + " (" +
                   parameters_text(choice_) + "), frame " + std::to_string(frame) + ": " + difference;
    }

    /// Counts the differing pairs of triangles by geometric class (`aabb::difference_class`: coplanar, touching, …). As
    /// contacts are sorted, a false positive that is reported repeatedly follows itself; it counts once.
    void classify(const aabb::set_difference<aabb::contact>& contacts) {
        struct triangle_pairs {
            std::vector<aabb::index_pair> false_negatives, false_positives;
        };
        std::map<aabb::index_pair, triangle_pairs> by_objects;
        for (const aabb::contact& c : contacts.false_negatives)
            by_objects[{c.a, c.b}].false_negatives.push_back({c.triangle_a, c.triangle_b});
        for (const aabb::contact& c : contacts.false_positives) {
            std::vector<aabb::index_pair>& false_positives = by_objects[{c.a, c.b}].false_positives;
            const aabb::index_pair pair{c.triangle_a, c.triangle_b};
            if (false_positives.empty() || false_positives.back() != pair) false_positives.push_back(pair);
        }
        const aabb::mesh_scene& meshes = *scene_.meshes();
        for (const auto& [objects, lists] : by_objects)
            classes_ += aabb::compare_triangle_pairs(
                lists.false_negatives, lists.false_positives, meshes.meshes[meshes.mesh_of[objects.a]],
                scene_.poses()[objects.a], meshes.meshes[meshes.mesh_of[objects.b]], scene_.poses()[objects.b]);
    }

    /// Appends rows of differences.csv, one for each number that is not 0.
    /// @param what the column's word for false negatives or false positives
    /// @param boxes the number of differing pairs of boxes
    /// @param classes the numbers of differing pairs of triangles, by geometric class (coplanar, touching, …)
    void add_differences(std::vector<difference>& differences, std::string_view what, std::uint64_t boxes,
                         std::span<const std::size_t> classes) const {
        const auto add = [&](std::string_view kind, std::uint64_t count) {
            if (count > 0)
                differences.push_back({choice_, candidate_.name, std::string(what), std::string(kind), count});
        };
        add("boxes", boxes);
        for (std::size_t i = 0; i < classes.size(); ++i) add(aabb::difference_class_names[i], classes[i]);
    }

    const candidate& candidate_;
    const scene_choice& choice_;
    const scene_frames& scene_;
    stage_runner runner_;
    tally tally_;
    std::string failure_;
    aabb::work_counters first_frame_;
    std::uint64_t box_false_negatives_ = 0, box_false_positives_ = 0;
    std::uint64_t contact_false_negatives_ = 0, contact_false_positives_ = 0;
    aabb::differences classes_;
};

}  // namespace

scene_validation validate_scene(const scene_choice& choice, std::span<const candidate> candidates) {
    scene_frames scene(choice);
    return validate_scene(choice, scene, candidates);
}

/// Compares candidates with the ground truth, frame by frame. All see the same frames: a scene whose bodies react to
/// contacts reacts to those of the ground truth. A candidate whose external engine times out fails alone.
/// @param choice the description of the scene, for messages
scene_validation validate_scene(const scene_choice& choice, scene_frames& scene,
                                std::span<const candidate> candidates) {
    aabb::ground_truth truth(scene.objects(), scene.meshes(), scene.filter());
    tally truth_tally(scene.meshes() != nullptr);
    std::deque<validated_runner> runners;
    std::vector<validated_row> results(candidates.size());
    std::vector<std::size_t> indices;  // of the runners among the candidates
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        try {
            runners.emplace_back(candidates[i], choice, scene);
            indices.push_back(i);
        } catch (const engine_timeout& error) {
            results[i].name = candidates[i].name;
            results[i].failure = error.what();
        }
    }
    std::optional<aabb::posed_boxes> posed;
    if (scene.meshes()) posed.emplace(*scene.meshes());
    progress shown("validating " + choice.kind, scene.frames() * (candidates.size() + 1));
    std::size_t finished_runs = 0;
    for (std::size_t frame = 0; scene.next(); ++frame) {
        if (posed) scene.place(*posed);
        if (posed)
            truth.compute({.boxes = posed->boxes(), .poses = scene.poses(), .arrivals = {}, .departures = {}});
        else
            truth.compute({.boxes = scene.boxes(),
                           .poses = {},
                           .arrivals = scene.arrivals(),
                           .departures = scene.departures(),
                           .boxes_in_double = scene.boxes_in_double()});
        truth_tally.add(truth.pairs(), truth.contacts());
        shown.update(++finished_runs);
        for (validated_runner& r : runners) {
            r.compare_frame(frame, truth);
            shown.update(++finished_runs);
        }
        scene.take_results(truth.pairs(), truth.contacts());
    }
    for (std::size_t i = 0; i < runners.size(); ++i) {
        validated_row& result = results[indices[i]];
        result = runners[i].result();
        const auto& output = candidates[indices[i]].reported;
        if (!output) continue;
        if (result.failure.empty() && output->faulty_rows > 0)
            result.failure = text_of(result.name) + " has a wrong result on " + choice.kind + " (" +
                             parameters_text(choice) + "): " + output->fault();
        output->is_wrong = !result.failure.empty() || !result.differences.empty();
    }
    return {scene.objects(), scene.frames(), truth.name(), truth_tally.digest(), std::move(results)};
}

}  // namespace aabblab
