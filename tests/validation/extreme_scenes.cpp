#include "../compositions.hpp"

import aabb.extreme;
import aabb.pipeline;
import aabb.validation;

using namespace aabb;

namespace {

std::vector<extreme_judge> judges() {
    std::vector<extreme_judge> result;
    for (extreme_scene& scene : extreme_scenes(extreme_size::small)) result.emplace_back(std::move(scene));
    return result;
}

void require_expected(const extreme_scene& scene, const extreme_result& result, bool must_be_exact = true) {
    INFO(scene.name << ": " << verdict_names[static_cast<std::size_t>(result.outcome)] << " " << result.reason);
    CHECK(is_as_expected(scene, result, must_be_exact));
}

}  // namespace

TEST_CASE("every global search is exact on every extreme scene, or rejects it as required") {
    std::vector<aabb::composition> compositions = global_compositions();
    // Cells of a configured edge do not fit in memory in worlds of any size.
    std::erase_if(compositions, [](const aabb::composition& c) {
        return std::ranges::any_of(c[strategy_kind::partition].settings,
                                   [](const setting& s) { return s.name == "cell_size"; });
    });
    REQUIRE(compositions.size() > 50);
    for (const extreme_judge& judge : judges()) {
        if (!judge.scene().make_boxes) continue;
        for (const engine_info& engine : engines()) {
            if (!engine.searches_boxes) continue;
            INFO(engine.name);
            require_expected(judge.scene(), judge.judge([&] { return make_box_engine(engine.name); }));
        }
        for (const aabb::composition& c : compositions) {
            INFO(text_of_global(c));
            require_expected(judge.scene(), judge.judge([&] { return global_of(c); }));
        }
    }
}

TEST_CASE("every local detection is exact on every extreme scene, or rejects it as required") {
    for (const extreme_judge& judge : judges()) {
        if (!judge.scene().make_meshes) continue;
        for (const engine_info& engine : engines()) {
            if (!engine.collides_meshes) continue;
            INFO(engine.name);
            require_expected(judge.scene(), judge.judge([&] { return make_mesh_engine(engine.name); }), engine.exact);
        }
        for (const aabb::composition& c : exact_local_compositions()) {
            INFO(text_of_local(c));
            extreme_result result = judge.judge([&] { return local_of(c); });
            require_stated_memory(judge.scene(), result);
            require_expected(judge.scene(), result);
        }
    }
}

TEST_CASE(
    "through every tree, distances are 0 exactly where meshes meet, and right elsewhere, on every extreme scene") {
    for (const extreme_judge& judge : judges()) {
        if (!judge.scene().make_meshes) continue;
        for (const aabb::composition& c : compositions_of_every_tree()) {
            if (!c[strategy_kind::tree].settings.empty()) continue;  // for the time that they take
            INFO(text_of_local(c));
            require_expected(judge.scene(), judge.judge([&] { return compose_by_distance(c); }));
        }
    }
}
