#include "../experiments/program.hpp"

import aabb.registry;
import aabblab.trials;
import aabblab.scenes;
import aabblab.stepping;

namespace {

const aabblab::scene_choice few_balls{
    "dropped", {{"balls", "8"}, {"frames", "150"}, {"height", "0.05"}, {"speed", "3"}, {"depth", "0.002"}}, {}, 3};

/// A scene whose poses an integrator sets.
class evaluated_scene final : public aabb::mesh_scene {
public:
    explicit evaluated_scene(const aabblab::stepped_world& world) {
        meshes = world.meshes;
        mesh_of = world.mesh_of();
    }
    [[nodiscard]] std::size_t frames() const override { return 1000; }
    bool next(std::vector<aabb::pose>& poses) override {
        poses = current;
        return true;
    }
    std::vector<aabb::pose> current;
};

}  // namespace

TEST_CASE("dropped balls fall, collide and stay above the floor with every tree") {
    std::vector<std::vector<aabb::pose>> first;
    for (const char* const tree : {"canonical", "compressed", "quantized"}) {
        aabb::composition c;
        c[aabb::strategy_kind::tree] = {tree, {}};
        aabblab::scene_frames scene(few_balls);
        aabblab::stage_runner stage_runner(aabblab::candidate_of(c, true), scene, aabb::instrumentation::none);
        std::size_t on_floor = 0;
        std::size_t on_each_other = 0;
        std::vector<std::vector<aabb::pose>> poses;
        aabblab::run_frames(scene, stage_runner, [&](const aabblab::searched_frame& frame) {
            poses.emplace_back(scene.poses().begin(), scene.poses().end());
            for (const aabb::contact& contact : frame.contacts) ++(contact.a == 0 ? on_floor : on_each_other);
            for (const aabb::pose& p : poses.back()) REQUIRE(p.translation[2] > -0.01);
        });
        REQUIRE(on_floor > 100);
        REQUIRE(on_each_other > 100);
        if (first.empty()) first = poses;
        REQUIRE(poses == first);
    }
}

TEST_CASE_METHOD(in_folder, "an inexact composition is timed on its own motion") {
    const auto config = folder.write("lost.toml", R"(name = "lost"
seed = 3
[[scene]]
kind = "dropped"
balls = 8
frames = 150
height = 0.05
speed = 3
depth = 0.002
[compose]
prepare = ["none", { name = "neighbour_list", margin = 0, every = 64 }]
[measure]
repeats = 2
)");
    REQUIRE(holds(run_well({"run", config, "--out", folder / "out"}).out, "neighbour_list:margin=0,every=64"));
}

TEST_CASE("the scene dropped integrates its world by symplectic_euler") {
    aabblab::scene_frames scene(few_balls);
    const aabb::composition c;
    aabblab::stage_runner stage_runner(aabblab::candidate_of(c, true), scene, aabb::instrumentation::none);
    std::vector<std::vector<aabb::pose>> recorded;
    aabblab::run_frames(scene, stage_runner, [&](const aabblab::searched_frame&) {
        recorded.emplace_back(scene.poses().begin(), scene.poses().end());
    });

    const aabblab::stepped_world world =
        aabblab::dropped_world({.balls = 8, .height = 0.05, .speed = 3, .depth = 0.002},
                               {scene.meshes()->meshes[0], scene.meshes()->meshes[1]}, 3);
    auto* const evaluated = new evaluated_scene(world);
    aabblab::motion_state state = world.start();
    world.place(state, evaluated->current);
    aabblab::scene_frames frames{std::unique_ptr<aabb::mesh_scene>(evaluated)};
    aabblab::stage_runner finder(aabblab::candidate_of(c, true), frames, aabb::instrumentation::none);
    aabblab::dynamics forces(world);
    const auto euler = aabblab::integrator_named("symplectic_euler")->make(0);
    const aabblab::equations_of_motion equations{[&](const auto& at, auto& rates) {
        world.place(at, evaluated->current);
        frames.next();
        finder.update();
        finder.search();
        finder.detect();
        forces.accelerate(at, finder.sorted_contacts(), rates);
    }};
    for (std::size_t frame = 0; frame < recorded.size(); ++frame) {
        INFO("frame " << frame);
        std::vector<aabb::pose> poses;
        world.place(state, poses);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const aabb::vec3d difference = poses[i].translation - recorded[frame][i].translation;
            REQUIRE(dot(difference, difference) < 1e-20);
        }
        euler->advance(equations, state, 0.001);
    }
}
