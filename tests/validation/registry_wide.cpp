#include "../compositions.hpp"
#include "engines.hpp"

using namespace aabb;

TEST_CASE("every composed local detection with an exact triangle test equals CGAL") {
    for (const mesh_case& c : mesh_cases()) {
        const std::vector<index_pair> pairs = pairs_of(*make_mesh_engine("cgal"), c.a, c.pose_a, c.b, c.pose_b);
        for (const aabb::composition& composition : exact_local_compositions()) {
            INFO(text_of_local(composition) << ", " << c.name);
            const auto stage = local_of(composition, instrumentation::none);
            REQUIRE(pairs_of(*stage, c.a, c.pose_a, c.b, c.pose_b) == pairs);
        }
    }
}

TEST_CASE("two meshes moved together keep their pairs, as far as 10^7 times their size") {
    const mesh ball = sphere(8);
    const pose unmoved = turned({1, 2, 3}, 0.4, {0, 0, 0});
    const pose near = turned({3, -1, 1}, 1.3, {0.6, 0.3, -0.2});
    for (const aabb::composition& composition : exact_local_compositions()) {
        INFO(text_of_local(composition));
        const auto stage = local_of(composition, instrumentation::none);
        const std::vector<index_pair> pairs = pairs_of(*stage, ball, unmoved, ball, near);
        const std::vector<index_pair> touching = pairs_of(*stage, ball, unmoved, ball, unmoved);
        REQUIRE(pairs.size() > 50);
        REQUIRE(touching.size() > 1000);
        for (const double far : {1e3, 1e5, 1e7}) {
            pose a = unmoved;
            pose b = near;
            for (pose* p : {&a, &b})
                for (int k = 0; k < 3; ++k) p->translation[k] += far * (k + 1);
            REQUIRE(pairs_of(*stage, ball, a, ball, b) == pairs);
            REQUIRE(pairs_of(*stage, ball, a, ball, a) == touching);
        }
    }
}

TEST_CASE("all compositions and engines find the same self-intersections, also after a deformation") {
    mesh ball = sphere(6);
    const auto self_pairs = [](local_stage& stage) {
        std::vector<index_pair> pairs;
        stage.self_pairs(0, pairs);
        return sorted(pairs);
    };
    std::vector<std::pair<std::string, std::unique_ptr<local_stage>>> stages;
    for (const engine_info& engine : engines())
        if (engine.exact && engine.collides_meshes) stages.emplace_back(engine.name, make_mesh_engine(engine.name));
    for (const aabb::composition& composition : exact_local_compositions())
        stages.emplace_back(text_of_local(composition), local_of(composition));
    for (auto& [name, stage] : stages) stage->add_model(ball);
    for (const bool deformed : {false, true}) {
        if (deformed)
            for (std::size_t v = 0; v < ball.vertices.size(); v += 3) ball.vertices[v][1] = -ball.vertices[v][1];
        std::vector<index_pair> truth;
        for (auto& [name, stage] : stages) {
            INFO(name << (deformed ? ", deformed" : ""));
            if (deformed) stage->refit(0);
            const std::vector<index_pair> pairs = self_pairs(*stage);
            if (truth.empty()) truth = pairs;
            REQUIRE(pairs == truth);
        }
        REQUIRE(truth.size() > 100);
    }
}
