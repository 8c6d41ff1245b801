#include "../compositions.hpp"

import aabb.validation;
import aabblab.configs;
import aabblab.trials;
import aabblab.scenes;

TEST_CASE("every composition is exact on every scene of boxes") {
    std::vector<aabblab::candidate> candidates;
    for (const aabb::composition& c : global_compositions()) candidates.push_back(aabblab::candidate_of(c, false));
    for (const aabb::engine_info& engine : aabb::engines())
        if (const auto candidate = aabblab::candidate_of(engine, false)) candidates.push_back(*candidate);
    REQUIRE(candidates.size() > 500);
    for (const aabblab::scene_info& info : aabblab::scene_kinds()) {
        if (info.has_meshes || info.reads_file) continue;
        aabblab::scene_choice scene{info.name, {{"objects", "100"}, {"frames", "4"}}, {}, 3};
        // Enlarged by a margin, long and large boxes overlap millions of cells of a fine grid.
        if (info.name == "needles") scene.settings.push_back({"length", "4"});
        if (info.name == "mixed_sizes") scene.settings.push_back({"ratio", "20"});
        if (info.name == "adversarial") scene.settings.push_back({"construction", "shells"});
        // All candidates at once would take more memory than some machines have.
        for (std::size_t at = 0; at < candidates.size(); at += 250) {
            const auto batch = std::span(candidates).subspan(at, std::min<std::size_t>(250, candidates.size() - at));
            const aabblab::scene_validation validation = aabblab::validate_scene(scene, batch);
            REQUIRE(validation.candidates.size() == batch.size());
            for (const aabblab::validated_row& v : validation.candidates) {
                INFO(info.name << ": " << v.failure);
                REQUIRE(v.failure.empty());
                REQUIRE(v.digest == validation.digest);
            }
        }
    }
}

TEST_CASE("every narrow-phase composition is as exact as it states on every scene of meshes") {
    std::vector<aabblab::candidate> candidates;
    for (const aabb::composition& c : local_compositions()) candidates.push_back(aabblab::candidate_of(c, true));
    for (const aabb::engine_info& engine : aabb::engines())
        if (const auto candidate = aabblab::candidate_of(engine, true)) candidates.push_back(*candidate);
    // The broad phase decides nothing here, but its preparation may: parts of meshes become separate models.
    for (const aabb::strategy_choice& prepare : all_choices(aabb::strategy_kind::prepare)) {
        aabb::composition c;
        c[aabb::strategy_kind::prepare] = prepare;
        if (c != aabb::composition()) candidates.push_back(aabblab::candidate_of(c, true));
        c[aabb::strategy_kind::prepare].settings = {{"size", "0.3"}};
        if (prepare.name == "split_mesh") candidates.push_back(aabblab::candidate_of(c, true));
    }
    REQUIRE(candidates.size() > 100);
    for (const aabblab::scene_info& info : aabblab::scene_kinds()) {
        if (!info.has_meshes || info.reads_file) continue;
        aabblab::scene_choice scene{
            info.name, {{"frames", "3"}}, {"icosphere:triangles=180", "torus_knot:triangles=300"}, 3};
        if (info.name == "mesh_swarm") scene.settings.push_back({"objects", "6"});
        if (info.name == "dropped") scene.settings.insert(scene.settings.end(), {{"balls", "4"}, {"height", "0"}});
        const aabblab::scene_validation validation = aabblab::validate_scene(scene, candidates);
        REQUIRE(validation.candidates.size() == candidates.size());
        REQUIRE(validation.candidates[0].contacts.value() > 100);
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const aabblab::validated_row& v = validation.candidates[i];
            INFO(info.name << ": " << v.failure);
            REQUIRE(v.failure.empty());
            if (candidates[i].exact) REQUIRE(v.digest == validation.digest);
            REQUIRE(v.triangles == 180 + 300);
            REQUIRE(v.box_inflation.has_value() == !v.name[aabb::strategy_kind::tree].empty());
            if (v.name[aabb::strategy_kind::tree].starts_with("compressed_literal")) REQUIRE(*v.box_inflation > 0);
        }
    }
}

TEST_CASE("arrivals and departures of objects in a scene are consistent") {
    aabblab::scene_frames scene({"population", {{"objects", "200"}, {"frames", "5"}}, {}, 1});
    std::vector<bool> present(200);
    std::size_t changes = 0;
    for (bool first = true; scene.next(); first = false) {
        for (const std::uint32_t object : scene.arrivals()) {
            REQUIRE_FALSE(present[object]);
            present[object] = true;
        }
        for (const std::uint32_t object : scene.departures()) {
            REQUIRE(present[object]);
            present[object] = false;
        }
        if (!first) changes += scene.arrivals().size() + scene.departures().size();
    }
    REQUIRE(changes > 0);
}
