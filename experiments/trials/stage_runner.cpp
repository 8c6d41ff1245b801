module aabblab.trials;

import aabblab.filters;
import aabblab.pair_output;

namespace aabblab {

/// Makes the scene; messages about poses name the file that they come from, if any.
scene_frames::scene_frames(const scene_choice& choice) {
    const scene_info& info = scene_named(choice.kind);
    if (info.has_meshes)
        meshes_ = make_mesh_scene(choice);
    else
        box_scene_ = make_box_scene(choice);
    if (info.has_meshes && info.reads_file)
        poses_file_ = std::ranges::find(choice.settings, "file", &aabb::setting::name)->value;
    filter_by(filter_of(choice, objects()));
}

bool scene_frames::next() {
    if (!(meshes_ ? meshes_->next(poses_) : box_scene_->next(boxes_))) return false;
    if (box_scene_) note_changes(box_scene_->present());
    if (compares_) note_motion();
    ++frames_run_;
    return true;
}

void scene_frames::take_results(std::span<const aabb::index_pair> pairs, std::span<const aabb::contact> contacts) {
    if (meshes_)
        meshes_->take_contacts(contacts);
    else
        box_scene_->take_pairs(pairs);
}

void scene_frames::rethrow(const aabb::input_error& error) const {
    if (poses_file_.empty()) throw;
    throw aabb::input_error(poses_file_ + ": frame " + std::to_string(frames_run_ - 1) + ": " + error.what());
}

void scene_frames::place(aabb::posed_boxes& boxes) const try {
    boxes.update(poses_);
} catch (const aabb::input_error& error) {
    rethrow(error);
}

/// Compares the presence of every object with the previous frame, so that only changed objects are inserted or removed.
/// @param present by object; empty if all are present
void scene_frames::note_changes(std::span<const std::uint8_t> present) {
    arrivals_.clear();
    departures_.clear();
    present_.resize(boxes_.size(), 0);
    for (std::uint32_t object = 0; object < boxes_.size(); ++object) {
        const bool is_present = present.empty() || present[object] != 0;
        if (is_present == (present_[object] != 0)) continue;
        present_[object] = is_present;
        (is_present ? arrivals_ : departures_).push_back(object);
    }
}

void scene_frames::note_motion() {
    moved_.clear();
    for (std::uint32_t object = 0; object < boxes_.size(); ++object)
        if (object >= previous_.size() || boxes_[object] != previous_[object]) moved_.push_back(object);
    previous_ = boxes_;
}

stage_runner::stage_runner(const candidate& tested, const scene_frames& scene, aabb::instrumentation counted)
    : stage_runner(stages{tested.make_global(counted), scene.meshes() ? tested.make_local(counted) : nullptr}, scene,
                   counted) {}

/// Connects the stages for a scene. Boxes go to the broad phase directly. Meshes need a pipeline, which derives boxes
/// from their poses; without a broad phase it takes every two objects to the narrow phase.
stage_runner::stage_runner(stages given, const scene_frames& scene, aabb::instrumentation counted)
    : scene_(scene), stages_(std::move(given)) {
    if (stages_.global && scene.filter())
        stages_.global = filtered(std::move(stages_.global), *scene.filter(), counted);
    if (stages_.global) stages_.global->expect(scene.frames());  // few frames do not repay much preparation
    if (!scene.meshes()) return;
    if (stages_.global)
        pipeline_.emplace(*scene.meshes(), *stages_.global, *stages_.local);
    else
        pipeline_.emplace(*scene.meshes(), *stages_.local);
}

/// Passes the scene's current frame to the stages: poses of meshes to the pipeline, boxes to the broad phase, after the
/// removal and insertion of objects. If poses from a file are rejected, the error names file and frame.
void stage_runner::update() try {
    if (pipeline_) return pipeline_->update(scene_.poses());
    for (const std::uint32_t object : scene_.departures()) stages_.global->remove(object);
    stages_.global->insert_all(scene_.arrivals());
    if (const auto moved = scene_.moved()) stages_.global->moved(*moved);
    stages_.global->update(scene_.boxes());
} catch (const aabb::input_error& error) {
    scene_.rethrow(error);
}

void stage_runner::search() {
    if (pipeline_) return pipeline_->search();
    pairs_.clear();
    stages_.global->search(pairs_);
    if (const auto boxes = scene_.boxes_in_double(); !boxes.empty()) aabb::float_boxes::drop_disjoint(boxes, pairs_);
}

void stage_runner::detect() try {
    if (pipeline_) pipeline_->detect();
} catch (const aabb::input_error& error) {
    scene_.rethrow(error);
}

const std::vector<aabb::index_pair>& stage_runner::sorted_pairs() {
    if (pipeline_) pairs_.assign(pipeline_->candidates().begin(), pipeline_->candidates().end());
    sort_rows(pairs_);
    return pairs_;
}

const std::vector<aabb::contact>& stage_runner::sorted_contacts() {
    if (pipeline_) contacts_.assign(pipeline_->contacts().begin(), pipeline_->contacts().end());
    sort_rows(contacts_);
    return contacts_;
}

aabb::work_counters stage_runner::counters() const {
    aabb::work_counters work;
    if (stages_.global) work = stages_.global->counters();
    if (stages_.local)
        for (std::size_t i = 0; i < work.counts.size(); ++i) work.counts[i] += stages_.local->counters().counts[i];
    return work;
}

std::vector<aabb::part_bytes> stage_runner::global_bytes() const {
    std::vector<aabb::part_bytes> parts = stages_.global ? stages_.global->bytes() : std::vector<aabb::part_bytes>{};
    if (pipeline_ && pipeline_->division_bytes() > 0) parts.push_back({"prepare", pipeline_->division_bytes()});
    return parts;
}

/// The memory of the narrow phase by part, and that of the meshes, which it reads but does not own.
std::vector<aabb::part_bytes> stage_runner::local_bytes() const {
    if (!stages_.local) return {};
    std::vector<aabb::part_bytes> parts = stages_.local->bytes();
    std::size_t triangles = 0, vertices = 0;
    for (const aabb::mesh& m : scene_.meshes()->meshes) {
        triangles += aabb::bytes_of(m.triangles);
        vertices += aabb::bytes_of(m.vertices, m.given);
    }
    parts.push_back({"triangles", triangles});
    parts.push_back({"vertices", vertices});
    return parts;
}

std::size_t stage_runner::held_bytes() const {
    std::size_t sum = buffer_bytes();
    for (const aabb::part_bytes& part : global_bytes()) sum += part.bytes;
    for (const aabb::part_bytes& part : local_bytes())
        if (part.part != "triangles" && part.part != "vertices") sum += part.bytes;
    return sum;
}

/// The mean over the trees of the area of boxes over that of tight ones, minus 1. Empty without trees.
std::optional<double> stage_runner::box_inflation() const {
    if (!stages_.local) return std::nullopt;
    double sum = 0;
    const std::uint32_t models = pipeline_->models();
    for (std::uint32_t model = 0; model < models; ++model) {
        const std::optional<aabb::tree_validation> tree = stages_.local->validate_tree(model);
        if (!tree) return std::nullopt;
        sum += tree->area_inflation;
    }
    return sum / static_cast<double>(models);
}

elapsed time_detection(stage_runner& runner) {
    stopwatch watch;
    runner.detect();
    return watch.lap();
}

/// Times the phases of each frame and passes its results to the scene, whose bodies may react to their contacts.
/// @param on_frame receives the times and results of each frame
/// @param detect runs the narrow phase and returns its time
void run_frames(scene_frames& scene, stage_runner& runner, const std::function<void(const searched_frame&)>& on_frame,
                std::size_t most_frames, const timed_detection& detect) {
    for (std::uint32_t frame = 0; frame < most_frames && scene.next(); ++frame) {
        phases took;
        stopwatch watch;
        runner.update();
        took.update = watch.lap();
        runner.search();
        took.search = watch.lap();
        // Some broad phases sort during the search; this counts as update, where other strategies sort.
        const double share = runner.share_of_update();
        const elapsed sorting{share * took.search.wall_ms, share * took.search.cpu_ms};
        took.update += sorting;
        took.search += {-sorting.wall_ms, -sorting.cpu_ms};
        took.detect = detect(runner);
        const searched_frame result{frame, took, runner.sorted_pairs(), runner.sorted_contacts()};
        on_frame(result);
        scene.take_results(result.pairs, result.contacts);
    }
}

/// Adds a frame's results to their numbers and digest, of contacts in a scene of meshes, otherwise of pairs of boxes.
void tally::add(std::span<const aabb::index_pair> pairs, std::span<const aabb::contact> contacts) {
    candidates_ += pairs.size();
    if (meshes_) {
        contacts_ += contacts.size();
        for (const aabb::contact& c : contacts) digest_.add(std::array{frame_, c.a, c.b, c.triangle_a, c.triangle_b});
    } else {
        digest_.add(frame_, pairs);
    }
    ++frame_;
}

}  // namespace aabblab
