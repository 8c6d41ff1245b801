#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Imports, so it comes last.
#include "hit_geometry.hpp"

import aabb.base;
import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabblab.configs;

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

void require_no_engine(const std::optional<std::string>& engine) {
    if (engine)
        throw aabb::input_error("--geometry is constructed by the triangle test, so --engine does not go with it");
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

}  // namespace aabblab
