module aabblab.trials;

import aabblab.progress;

namespace aabblab {

namespace {

std::string text_of(const aabb::index_pair& pair) {
    return "the pair " + std::to_string(pair.a) + " " + std::to_string(pair.b);
}

std::string text_of(const aabb::contact& c) {
    return "the contact of objects " + std::to_string(c.a) + " " + std::to_string(c.b) + " in their triangles " +
           std::to_string(c.triangle_a) + " " + std::to_string(c.triangle_b);
}

/// Describes the first difference; empty if there is none.
template <class T>
std::string first_of(const aabb::set_difference<T>& d) {
    if (d.missing.empty() && d.invented.empty()) return {};
    if (d.invented.empty() || (!d.missing.empty() && d.missing[0] < d.invented[0]))
        return text_of(d.missing[0]) + " is missing";
    return text_of(d.invented[0]) +
           (d.repeated ? " is reported more than once" : " is reported, but is not in the exact answer");
}

/// Compares one candidate with the ground truth.
class validated_player {
public:
    validated_player(const contender& candidate, const scene_choice& choice, const scene_play& scene)
        : candidate_(candidate),
          choice_(choice),
          scene_(scene),
          player_(candidate, scene, aabb::instrumentation::counters),
          tally_(scene.meshes() != nullptr) {}

    void play(std::size_t frame, const aabb::exact_answer& exact) {
        player_.update();
        player_.search();
        player_.detect();
        if (frame == 0) first_frame_ = player_.counters();
        tally_.add(player_.sorted_pairs(), player_.sorted_contacts());
        if (candidate_.whole_boxes) {
            const aabb::set_difference boxes(exact.pairs(), player_.sorted_pairs());
            if (candidate_.exact_boxes) note(frame, first_of(boxes));
            boxes_missing_ += boxes.missing.size();
            boxes_invented_ += boxes.invented.size();
        }
        if (!scene_.meshes()) return;
        const aabb::set_difference contacts(exact.contacts(), player_.sorted_contacts());
        if (candidate_.exact) note(frame, first_of(contacts));
        contacts_missing_ += contacts.missing.size();
        contacts_invented_ += contacts.invented.size();
        classify(contacts);
    }

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
        v.missing = scene_.meshes() ? contacts_missing_ : boxes_missing_;
        v.invented = scene_.meshes() ? contacts_invented_ : boxes_invented_;
        add_differences(v.differences, "missing", boxes_missing_, classes_.missing);
        add_differences(v.differences, "invented", boxes_invented_, classes_.invented);
        v.status = v.differences.empty() ? "exact" : "inexact";
        if (scene_.meshes()) {
            v.triangles = 0;
            for (const aabb::mesh& m : scene_.meshes()->meshes) *v.triangles += m.triangles.size();
            v.box_inflation = player_.box_inflation();
        }
        take_counts(v);
        // The memory of an external engine is unknown.
        if (!candidate_.told) take_bytes(v);
        return v;
    }

private:
    /// Leaves the counts empty if they are all 0, since engines have no counters.
    void take_counts(row& r) const {
        aabb::work_counters work = player_.counters();
        if (scene_.frames() > 1)
            for (std::size_t i = 0; i < work.counts.size(); ++i) work.counts[i] -= first_frame_.counts[i];
        if (std::ranges::any_of(work.counts, [](std::uint64_t n) { return n > 0; }))
            std::ranges::copy(work.counts, r.counts.begin());
    }

    void take_bytes(row& r) const {
        r.bytes.fill(0);
        for (const auto& parts : {player_.global_bytes(), player_.local_bytes()})
            for (const aabb::part_bytes& part : parts) {
                auto column = std::ranges::find(byte_columns, part.part);
                if (column == byte_columns.end()) --column;
                *r.bytes[static_cast<std::size_t>(column - byte_columns.begin())] += part.bytes;
            }
    }

    void note(std::size_t frame, const std::string& difference) {
        if (!failure_.empty() || difference.empty()) return;
        failure_ = text_of(candidate_.name) + " is wrong on " + choice_.kind + " (" + parameters_text(choice_) +
                   "), frame " + std::to_string(frame) + ": " + difference;
    }

    /// Classifies the differences of each pair of objects.
    void classify(const aabb::set_difference<aabb::contact>& contacts) {
        struct triangle_pairs {
            std::vector<aabb::index_pair> missing, invented;
        };
        std::map<aabb::index_pair, triangle_pairs> by_objects;
        for (const aabb::contact& c : contacts.missing)
            by_objects[{c.a, c.b}].missing.push_back({c.triangle_a, c.triangle_b});
        for (const aabb::contact& c : contacts.invented) {
            std::vector<aabb::index_pair>& invented = by_objects[{c.a, c.b}].invented;
            const aabb::index_pair pair{c.triangle_a, c.triangle_b};
            if (invented.empty() || invented.back() != pair) invented.push_back(pair);
        }
        const aabb::mesh_scene& meshes = *scene_.meshes();
        for (const auto& [objects, lists] : by_objects)
            classes_ += aabb::compare_triangle_pairs(
                lists.missing, lists.invented, meshes.meshes[meshes.mesh_of[objects.a]], scene_.poses()[objects.a],
                meshes.meshes[meshes.mesh_of[objects.b]], scene_.poses()[objects.b]);
    }

    void add_differences(std::vector<difference>& differences, std::string_view what, std::uint64_t boxes,
                         std::span<const std::size_t> classes) const {
        const auto add = [&](std::string_view kind, std::uint64_t count) {
            if (count > 0)
                differences.push_back({choice_, candidate_.name, std::string(what), std::string(kind), count});
        };
        add("boxes", boxes);
        for (std::size_t i = 0; i < classes.size(); ++i) add(aabb::difference_class_names[i], classes[i]);
    }

    const contender& candidate_;
    const scene_choice& choice_;
    const scene_play& scene_;
    player player_;
    tally tally_;
    std::string failure_;
    aabb::work_counters first_frame_;
    std::uint64_t boxes_missing_ = 0;
    std::uint64_t boxes_invented_ = 0;
    std::uint64_t contacts_missing_ = 0;
    std::uint64_t contacts_invented_ = 0;
    aabb::differences classes_;
};

}  // namespace

scene_validation validate_scene(const scene_choice& choice, std::span<const contender> contenders) {
    scene_play scene(choice);
    return validate_scene(choice, scene, contenders);
}

scene_validation validate_scene(const scene_choice& choice, scene_play& scene, std::span<const contender> contenders) {
    aabb::exact_answer exact(scene.objects(), scene.meshes());
    tally exact_tally(scene.meshes() != nullptr);
    std::deque<validated_player> players;
    std::vector<validated_row> results(contenders.size());
    std::vector<std::size_t> places;  // indices of the players among the candidates
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        try {
            players.emplace_back(contenders[i], choice, scene);
            places.push_back(i);
        } catch (const engine_timeout& error) {
            results[i].name = contenders[i].name;
            results[i].failure = error.what();
        }
    }
    std::optional<aabb::posed_boxes> world;
    if (scene.meshes()) world.emplace(*scene.meshes());
    progress shown("validating " + choice.kind, scene.frames() * (contenders.size() + 1));
    std::size_t done = 0;
    for (std::size_t frame = 0; scene.next(); ++frame) {
        if (world) scene.in_frame([&] { world->update(scene.poses()); });
        if (world)
            exact.play({world->boxes(), scene.poses(), {}, {}});
        else
            exact.play({scene.boxes(), {}, scene.arrivals(), scene.departures()});
        exact_tally.add(exact.pairs(), exact.contacts());
        shown.at(++done);
        for (validated_player& p : players) {
            p.play(frame, exact);
            shown.at(++done);
        }
        scene.tell(exact.pairs(), exact.contacts());
    }
    for (std::size_t i = 0; i < players.size(); ++i) results[places[i]] = players[i].result();
    return {scene.objects(), scene.frames(), exact.name(), exact_tally.digest(), std::move(results)};
}

}  // namespace aabblab
