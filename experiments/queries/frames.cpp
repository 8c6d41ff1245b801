module aabblab.queries;

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

/// Adds a row per contact. The geometry is set up once for consecutive contacts of the same two objects.
void add_contacts(number_table& rows, const searched_frame& frame, const scene_frames& scene,
                  std::optional<hit_geometry>& geometry) {
    const auto mesh_of = [&](std::uint32_t object) -> const aabb::mesh& {
        return scene.meshes()->meshes[scene.meshes()->mesh_of[object]];
    };
    const aabb::contact* before = nullptr;
    for (const aabb::contact& c : frame.contacts) {
        std::string cells;
        if (geometry) {
            if (before == nullptr || !are_of_same_objects(c, *before))
                geometry->set_meshes(mesh_of(c.a), scene.poses()[c.a], mesh_of(c.b), scene.poses()[c.b]);
            cells = to_cells((*geometry)({c.triangle_a, c.triangle_b}));
            before = &c;
        }
        rows.add({frame.number, c.a, c.b, c.triangle_a, c.triangle_b}, cells);
    }
}

}  // namespace

/// The triangle test for --geometry, which must construct intersections. In a composition, only strategies are allowed.
std::unique_ptr<aabb::triangle_test> constructing_test(const aabb::strategy_choice& choice, bool composed) {
    auto test = composed ? aabb::make_triangle_test(choice) : triangle_test_named(choice);
    if (test->constructs()) return test;
    std::vector<std::string> names = constructing_tests();
    const std::vector<std::string> strategies = aabb::strategy_names(aabb::strategy_kind::triangle);
    if (composed)
        std::erase_if(names, [&](const std::string& name) { return std::ranges::count(strategies, name) == 0; });
    throw aabb::input_error(
        fmt::format("--geometry: {} decides whether triangles intersect, but does not construct their intersection; "
                    "give --triangle {}",
                    choice.name, fmt::join(names, " or ")));
}

void hit_geometry::set_meshes(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b,
                              const aabb::pose& pose_b) {
    a_ = &a;
    b_ = &b;
    pose_a_ = pose_a;
    to_a_.emplace(pose_a, pose_b, aabb::bounds_of(b), a.frame, b.frame);
}

aabb::triangle_intersection hit_geometry::operator()(aabb::index_pair triangles) const {
    const aabb::triangle3f s = a_->triangle(triangles.a);
    const aabb::triangle3f t = (*to_a_)(b_->triangle(triangles.b));
    return aabb::transformed(test_->intersection(in_double(s), in_double(t)), pose_a_);
}

/// Makes the stages of a search. An engine takes the place of the last one; strategies without a name are selected.
search_method method_of(const search_choice& choice, const aabb::scene_traits& traits) {
    constexpr auto uncounted = aabb::instrumentation::none;
    const aabb::composition c = select_composition(choice.named, traits);
    search_method method;
    for (const aabb::stage stage : choice.stages) {
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
    if (choice.geometry) method.geometry.emplace(c[aabb::strategy_kind::triangle]);
    return method;
}

/// Searches every frame, and sums up times and results. Moves the stages out of `method`, but uses its name and
/// geometry. `rows` receives every result and is committed at the end; it may be null.
frames_result search_frames(scene_frames& scene, search_method& method, number_table* rows) {
    const bool meshes = scene.meshes() != nullptr;
    frames_result result;
    result.objects = scene.objects();
    std::optional<stage_runner> searcher;
    const wall_stopwatch building;
    searcher.emplace(std::move(method.run_stages), scene);
    result.build_ms = building.ms();
    progress shown("frames searched", scene.frames());
    tally totals(meshes);
    run_frames(scene, *searcher, [&](const searched_frame& frame) {
        result.ms.push_back(whole_nanoseconds(frame.ms()));
        const std::string where = fmt::format("{}, frame {}", method.name, frame.number);
        if (meshes) {
            require_each_once(frame.contacts, where);
            if (rows) add_contacts(*rows, frame, scene, method.geometry);
        } else {
            require_each_once(frame.pairs, where);
            if (rows)
                for (const auto [a, b] : frame.pairs) rows->add({frame.number, a, b});
        }
        totals.add(frame.pairs, frame.contacts);
        result.object_pairs += count_object_pairs(frame.contacts);
        shown.update(frame.number + 1);
    });
    if (rows) rows->commit();
    result.pairs = totals.candidates();
    result.contacts = totals.contacts().value_or(0);
    result.digest = totals.digest();
    return result;
}

}  // namespace aabblab
