#include "../compositions.hpp"

import aabb.extreme;
import aabb.pipeline;
import aabb.validation;

using namespace aabb;

namespace {

enum class objects : std::uint8_t { boxes, meshes };

/// The judges of these scenes, each of which computes a ground truth.
std::vector<extreme_judge> judges_of(objects what) {
    std::vector<extreme_judge> result;
    for (extreme_scene& scene : extreme_scenes(extreme_size::small))
        if (what == objects::boxes ? static_cast<bool>(scene.make_boxes) : static_cast<bool>(scene.make_meshes))
            result.emplace_back(std::move(scene));
    return result;
}

void require_expected(const extreme_scene& scene, const extreme_result& result, bool must_be_exact = true) {
    INFO(scene.name << ": " << verdict_names[static_cast<std::size_t>(result.outcome)] << " " << result.reason);
    CHECK(is_as_expected(scene, result, must_be_exact));
}

}  // namespace

// With a sanitizer, without engines, which take long: other tests run them.
TEST_CASE("every global search is exact on every extreme scene, or rejects it as required") {
    std::vector<aabb::composition> compositions = global_compositions();
    // Cells of a configured edge do not fit in memory in worlds of any size.
    std::erase_if(compositions, [](const aabb::composition& c) {
        return std::ranges::any_of(c[strategy_kind::partition].settings,
                                   [](const setting& s) { return s.name == "cell_size"; });
    });
    REQUIRE(compositions.size() > 50);
    for (const extreme_judge& judge : judges_of(objects::boxes)) {
        for (const engine_info& engine : engines()) {
            if (!engine.searches_boxes || has_sanitizer) continue;
            INFO(engine.name);
            require_expected(judge.scene(), judge.judge([&] { return make_box_engine(engine.name); }));
        }
        for (const aabb::composition& c : compositions) {
            INFO(text_of_global(c));
            require_expected(judge.scene(), judge.judge([&] { return global_of(c); }));
        }
    }
}

// One test, since most of its time passes with the ground truth.
TEST_CASE("every local detection and distance is exact on every extreme scene, or rejected as required") {
    for (const extreme_judge& judge : judges_of(objects::meshes)) {
        for (const engine_info& engine : engines()) {
            if (!engine.collides_meshes || has_sanitizer) continue;
            INFO(engine.name);
            require_expected(judge.scene(), judge.judge([&] { return make_mesh_engine(engine.name); }), engine.exact);
        }
        for (const aabb::composition& c : exact_local_compositions()) {
            INFO(text_of_local(c));
            extreme_result result = judge.judge([&] { return local_of(c); });
            require_stated_memory(judge.scene(), result);
            require_expected(judge.scene(), result);
        }
        for (const aabb::composition& c : compositions_of_every_tree()) {
            if (!c[strategy_kind::tree].settings.empty()) continue;  // for the time that they take
            INFO("distances through " << text_of_local(c));
            require_expected(judge.scene(), judge.judge([&] { return compose_by_distance(c); }));
        }
    }
}
