module;
#include <fmt/format.h>
#include <fmt/ranges.h>

module aabblab.queries;

import aabb.base;
import aabb.validation;

namespace aabblab {

std::unique_ptr<aabb::triangle_test> constructing_test(const aabb::strategy_choice& choice, bool composed) {
    std::unique_ptr<aabb::triangle_test> test =
        composed ? aabb::make_triangle_test(choice) : triangle_test_named(choice);
    if (test->constructs()) return test;
    std::vector<std::string> names = constructing_tests();
    const std::vector<std::string> strategies = aabb::strategy_names(aabb::strategy_kind::triangle);
    if (composed)
        std::erase_if(names, [&](const std::string& name) { return std::ranges::count(strategies, name) == 0; });
    throw aabb::input_error(
        fmt::format("--geometry: {} decides whether triangles intersect, not what they have in "
                    "common; give --triangle {}",
                    choice.name, fmt::join(names, " or ")));
}

hit_geometry::hit_geometry(const aabb::strategy_choice& triangle) : test_(constructing_test(triangle, true)) {}

void hit_geometry::take(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b, const aabb::pose& pose_b) {
    a_ = &a;
    b_ = &b;
    pose_a_ = pose_a;
    to_a_.emplace(pose_a, pose_b, aabb::bounds_of(b));
}

aabb::triangle_intersection hit_geometry::operator()(aabb::index_pair triangles) const {
    const aabb::triangle3f s = a_->triangle(triangles.a);
    const aabb::triangle3f t = (*to_a_)(b_->triangle(triangles.b));
    return aabb::carried(test_->intersection(in_double(s), in_double(t)), pose_a_);
}

search_method method_of(const search_choice& choice, const aabb::scene_outlook& outlook) {
    constexpr auto uncounted = aabb::instrumentation::none;
    const aabb::composition c = select_composition(choice.named, outlook);
    search_method method;
    for (const aabb::stage stage : choice.stages) {
        const bool by_engine = choice.engine && stage == choice.stages.back();
        method.name += (method.name.empty() ? "" : ", ") + (by_engine ? *choice.engine : to_text(c, stage));
        method.exact &= by_engine ? aabb::is_exact_engine(*choice.engine) : is_exact(c, stage);
        if (stage == aabb::stage::global_search)
            method.made.global =
                by_engine ? aabb::make_box_engine(*choice.engine) : aabb::compose_global_search(c, uncounted);
        else
            method.made.local =
                by_engine ? aabb::make_mesh_engine(*choice.engine) : aabb::compose_local_detection(c, uncounted);
    }
    if (choice.geometry) method.geometry.emplace(c[aabb::strategy_kind::triangle]);
    return method;
}

}  // namespace aabblab
