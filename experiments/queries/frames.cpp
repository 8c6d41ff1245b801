module aabblab.queries;

import aabb.distance_stages;
import aabb.triangle.intersection;
import aabb.validation;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.progress;
import aabblab.stopwatch;

namespace aabblab {

namespace {

bool are_of_same_objects(const aabb::contact& c, const aabb::contact& other) {
    return c.a == other.a && c.b == other.b;
}

std::size_t count_object_pairs(std::span<const aabb::contact> sorted) {
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) pairs += i == 0 || !are_of_same_objects(sorted[i], sorted[i - 1]);
    return pairs;
}

/// The geometry of the contacts of two objects in the current frame.
hit_geometry geometry_of(const scene_frames& scene, const aabb::contact& c) {
    const auto mesh_of = [&](std::uint32_t object) -> const aabb::mesh& {
        return scene.meshes()->meshes[scene.meshes()->mesh_of[object]];
    };
    return {mesh_of(c.a), scene.poses()[c.a], mesh_of(c.b), scene.poses()[c.b]};
}

class scene_in_floats final : public aabb::box_scene {
public:
    explicit scene_in_floats(std::unique_ptr<aabb::box_scene> scene) : scene_(std::move(scene)) {}

    [[nodiscard]] std::size_t objects() const override { return scene_->objects(); }
    [[nodiscard]] std::size_t frames() const override { return scene_->frames(); }
    bool next(std::vector<aabb::box>& boxes) override { return scene_->next(boxes); }
    [[nodiscard]] std::span<const std::uint8_t> present() const override { return scene_->present(); }
    void take_pairs(std::span<const aabb::index_pair> pairs) override { scene_->take_pairs(pairs); }

private:
    std::unique_ptr<aabb::box_scene> scene_;
};

}  // namespace

std::unique_ptr<aabb::box_scene> in_floats(std::unique_ptr<aabb::box_scene> scene) {
    return std::make_unique<scene_in_floats>(std::move(scene));
}

aabb::intersection_kind hit_geometry::kind(aabb::index_pair triangles) const {
    return intersection_kind_of(poses_, a_.given_triangle(triangles.a), b_.given_triangle(triangles.b));
}

aabb::triangle_intersection hit_geometry::operator()(aabb::index_pair triangles) const {
    return intersection_of(poses_, a_.given_triangle(triangles.a), b_.given_triangle(triangles.b));
}

std::map<std::string, std::uint64_t> by_name(const kind_counts& counts) {
    std::map<std::string, std::uint64_t> named;
    for (std::size_t k = 0; k < counts.size(); ++k)
        if (k > 0 || counts[k] > 0) named.emplace(aabb::intersection_kind_names[k], counts[k]);
    return named;
}

/// A line with the number of pairs of triangles of each kind of intersection that occurs; empty if there is none.
std::string to_text(const kind_counts& counts) {
    // In the order of `intersection_kind`.
    constexpr std::array<std::string_view, std::tuple_size_v<kind_counts>> words{
        "do not intersect", "touch in a point", "touch along a segment", "pass through each other",
        "overlap in a plane"};
    std::string line;
    for (std::size_t k = 0; k < counts.size(); ++k)
        if (counts[k] > 0) line += fmt::format("{}{} {}", line.empty() ? "" : ", ", grouped(counts[k]), words[k]);
    return line.empty() ? line : line + "\n";
}

bool hit_filter::keeps(aabb::intersection_kind kind) {
    using enum aabb::intersection_kind;
    if (!touching_ && (kind == point || kind == segment)) return false;
    ++counts_[static_cast<std::size_t>(kind)];
    return true;
}

/// Makes the stages of a search from named and selected strategies; an engine takes the place of the last stage.
search_method method_of(const search_choice& choice, const aabb::scene_traits& traits,
                        std::shared_ptr<const aabb::collision_filter> filter) {
    constexpr auto uncounted = aabb::instrumentation::none;
    const aabb::composition c = select_composition(choice.named, traits);
    search_method method;
    method.filter = std::move(filter);
    for (const aabb::stage stage : choice.stages) {
        if (stage == aabb::stage::local_detection && choice.within) {
            aabb::composition named = c;
            named[aabb::strategy_kind::triangle] = {"distance", {}};
            method.name += (method.name.empty() ? "" : ", ") + to_text(named, stage);
            aabb::near_stages near = aabb::compose_near(c, choice.within->d, method.filter.get());
            method.run_stages.local = std::move(near.local);
            if (method.run_stages.global) method.run_stages.global = std::move(near.global);
            continue;
        }
        const bool by_engine = choice.engine && stage == choice.stages.back();
        method.name += (method.name.empty() ? "" : ", ") + (by_engine ? *choice.engine : to_text(c, stage));
        method.exact &= by_engine ? aabb::is_exact_engine(*choice.engine) : is_exact(c, stage);
        if (stage == aabb::stage::global_search)
            method.run_stages.global =
                by_engine ? aabb::make_box_engine(*choice.engine) : aabb::compose_global_search(c, uncounted);
        else
            method.run_stages.local =
                by_engine ? aabb::make_mesh_engine(*choice.engine) : aabb::compose_local_detection(c, uncounted);
    }
    const bool is_of_triangles = method.run_stages.local != nullptr;
    if (method.filter && !(choice.within && is_of_triangles))
        method.run_stages.global = filtered(std::move(method.run_stages.global), *method.filter);
    if (choice.within && !is_of_triangles)
        method.run_stages.global = std::make_unique<aabb::within_stage>(
            std::move(method.run_stages.global), choice.within->d, choice.within->metric, choice.within->in_double);
    return method;
}

/// Searches every frame, and sums up times and results; moves the stages out of `method`.
/// @param hits which pairs of triangles are reported, and whether with their intersection
frames_result search_frames(scene_frames& scene, search_method& method, const frame_outputs& to,
                            const hit_choice& hits) {
    const auto [rows, drawing, intervals] = to;
    const bool meshes = scene.meshes() != nullptr;
    frames_result result;
    result.objects = scene.objects();
    std::optional<stage_runner> searcher;
    const wall_stopwatch building;
    searcher.emplace(std::move(method.run_stages), scene);
    result.build_ms = building.ms();
    progress shown("frames searched", scene.frames());
    tally totals(meshes);
    hit_filter wanted(hits.touching);
    std::vector<aabb::contact> contacts;
    run_frames(scene, *searcher, [&](const searched_frame& frame) {
        result.ms.push_back(whole_nanoseconds(frame.ms()));
        const std::string where = fmt::format("{}, frame {}", method.name, frame.number);
        contacts.clear();
        hit_drawing* const drawn = drawing && drawing->frame == frame.number ? &drawing->drawing : nullptr;
        if (drawn)
            for (std::size_t object = 0; object < scene.poses().size(); ++object)
                drawn->add_object(scene.meshes()->meshes[scene.meshes()->mesh_of[object]], scene.poses()[object]);
        if (meshes) {
            require_each_once(frame.contacts, where);
            for (const aabb::contact& c : frame.contacts) {
                const hit_geometry geometry = geometry_of(scene, c);
                const aabb::index_pair triangles{c.triangle_a, c.triangle_b};
                if (!wanted.keeps(geometry.kind(triangles))) continue;
                contacts.push_back(c);
                if (drawn) drawn->add_hit({c.a, c.triangle_a}, {c.b, c.triangle_b}, geometry(triangles));
                if (rows)
                    rows->add({frame.number, c.a, c.b, c.triangle_a, c.triangle_b},
                              hits.geometry ? to_cells(geometry(triangles)) : "");
            }
        } else {
            require_each_once(frame.pairs, where);
            if (rows)
                for (const auto [a, b] : frame.pairs) rows->add({frame.number, a, b});
        }
        if (intervals) intervals->add(frame.number, contacts);
        totals.add(frame.pairs, contacts);
        result.object_pairs += count_object_pairs(contacts);
        shown.update(frame.number + 1);
    });
    if (rows) rows->commit();
    if (intervals) intervals->write();
    result.pairs = totals.candidates();
    result.contacts = totals.contacts().value_or(0);
    result.kinds = wanted.counts();
    result.digest = totals.digest();
    return result;
}

}  // namespace aabblab
