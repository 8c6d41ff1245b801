#include "../compositions.hpp"
#include "engines.hpp"

using namespace aabb;

namespace {

struct recording {
    std::string name;
    std::vector<std::vector<box>> frames;
};

std::vector<recording> recordings() {
    std::mt19937 random(7);
    recording general{"random boxes that move", {random_boxes(random, 250, 2)}};
    recording lattice{"boxes that step on a lattice", {lattice_boxes(random, 250)}};
    for (int frame = 1; frame < 6; ++frame) {
        general.frames.push_back(general.frames.back());
        lattice.frames.push_back(lattice.frames.back());
        for (std::size_t i = 0; i < 250; ++i)
            for (int k = 0; k < 3; ++k) {
                const float step = uniform(random, -0.2F, 0.2F);
                const auto stride = static_cast<float>(static_cast<int>(random() % 3) - 1);
                general.frames.back()[i].min[k] += step;
                general.frames.back()[i].max[k] += step;
                lattice.frames.back()[i].min[k] += stride;
                lattice.frames.back()[i].max[k] += stride;
            }
    }
    recording flat = general;
    flat.name = "flat boxes in a plane";
    for (std::vector<box>& frame : flat.frames)
        for (box& b : frame) b.min[1] = b.max[1] = 3;
    return {general, lattice, flat};
}

/// Pairs, frame by frame, while some leave and come back and others stay away.
std::vector<std::vector<index_pair>> answers_of(global_stage& stage, const recording& r) {
    const auto size = static_cast<std::uint32_t>(r.frames[0].size());
    for (std::uint32_t id = 0; id < size; ++id) stage.insert(id);
    std::vector<std::vector<index_pair>> answers;
    for (std::size_t frame = 0; frame < r.frames.size(); ++frame) {
        for (std::uint32_t id = 0; frame > 0 && id < size; id += 3)
            frame % 2 == 1 ? stage.remove(id) : stage.insert(id);
        answers.push_back(pairs_of(stage, r.frames[frame]));
    }
    return answers;
}

}  // namespace

TEST_CASE("every composed global search equals brute force, frame by frame") {
    REQUIRE(!all_global_compositions().empty());
    for (const recording& r : recordings()) {
        const std::vector<std::vector<index_pair>> expected = answers_of(*make_box_engine("brute_force"), r);
        for (const std::vector<index_pair>& pairs : expected) REQUIRE(!pairs.empty());
        for (const aabb::composition& composition : all_global_compositions()) {
            const auto found = answers_of(*global_of(composition, instrumentation::none), r);
            for (std::size_t frame = 0; frame < found.size(); ++frame) {
                INFO(text_of_global(composition) << ", " << r.name << ", frame " << frame);
                REQUIRE(found[frame] == expected[frame]);
            }
        }
    }
}

TEST_CASE("every composed local detection with an exact triangle test equals CGAL") {
    for (const mesh_case& c : mesh_cases()) {
        const std::vector<index_pair> pairs = pairs_of(*make_mesh_engine("cgal"), c.a, c.pose_a, c.b, c.pose_b);
        for (const aabb::composition& composition : all_local_compositions()) {
            if (!is_exact_locally(composition)) continue;
            INFO(text_of_local(composition) << ", " << c.name);
            const auto stage = local_of(composition, instrumentation::none);
            REQUIRE(pairs_of(*stage, c.a, c.pose_a, c.b, c.pose_b) == pairs);
        }
    }
}

TEST_CASE("two meshes moved together keep their pairs, up to 10^7 times their size") {
    const mesh ball = sphere(12);
    const pose still = turned({1, 2, 3}, 0.4, {0, 0, 0});
    const pose near = turned({3, -1, 1}, 1.3, {0.6, 0.3, -0.2});
    for (const aabb::composition& composition : all_local_compositions()) {
        if (!is_exact_locally(composition)) continue;
        INFO(text_of_local(composition));
        const auto stage = local_of(composition, instrumentation::none);
        const std::vector<index_pair> pairs = pairs_of(*stage, ball, still, ball, near);
        const std::vector<index_pair> touching = pairs_of(*stage, ball, still, ball, still);
        REQUIRE(pairs.size() > 50);
        REQUIRE(touching.size() > 1000);
        for (const double far : {1e3, 1e5, 1e7}) {
            pose a = still;
            pose b = near;
            for (pose* p : {&a, &b})
                for (int k = 0; k < 3; ++k) p->translation[k] += far * (k + 1);
            REQUIRE(pairs_of(*stage, ball, a, ball, b) == pairs);
            REQUIRE(pairs_of(*stage, ball, a, ball, a) == touching);
        }
    }
}

TEST_CASE("every composition and engine holds a mesh against itself alike, and again when it has deformed") {
    mesh ball = sphere(6);
    const auto self_pairs = [](local_stage& stage) {
        std::vector<index_pair> pairs;
        stage.self_pairs(0, pairs);
        return sorted(pairs);
    };
    std::vector<std::pair<std::string, std::unique_ptr<local_stage>>> stages;
    for (const engine_info& engine : engines())
        if (engine.exact && engine.collides_meshes) stages.emplace_back(engine.name, make_mesh_engine(engine.name));
    for (const aabb::composition& composition : all_local_compositions())
        if (is_exact_locally(composition))
            stages.emplace_back(text_of_local(composition), local_of(composition, instrumentation::none));
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

TEST_CASE("an inexact engine follows a mesh that deforms") {
    for_each_mesh_engine([&](local_stage& stage, const engine_info&) {
        mesh m = one_triangle({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}});
        const mesh needle = one_triangle({{{0.5F, 0.5F, 9}, {0.6F, 0.5F, 11}, {0.5F, 0.7F, 11}}});
        stage.add_model(m);
        stage.add_model(needle);
        REQUIRE(stage.count_pairs(0, {}, 1, {}) == 0);
        for (vec3f& v : m.vertices) v[2] = 10;
        stage.refit(0);
        REQUIRE(stage.count_pairs(0, {}, 1, {}) == 1);
    });
}
