#include "../experiments/program.hpp"

import aabb.registry;
import aabblab.trials;
import aabblab.scenes;
import aabblab.stepping;

namespace {

const aabblab::scene_choice few_balls{
    "dropped", {{"balls", "8"}, {"frames", "150"}, {"height", "0.05"}, {"speed", "3"}, {"depth", "0.002"}}, {}, 3};

/// Where an integrator looks.
class looked_at final : public aabb::mesh_scene {
public:
    explicit looked_at(const aabblab::stepped_world& world) {
        meshes = world.meshes;
        mesh_of = world.mesh_of();
    }
    [[nodiscard]] std::size_t frames() const override { return 1000; }
    bool next(std::vector<aabb::pose>& poses) override {
        poses = now;
        return true;
    }
    std::vector<aabb::pose> now;
};

}  // namespace

TEST_CASE("dropped balls fall, meet and stay above the floor, whoever finds their contacts") {
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

TEST_CASE("an inexact composition is timed on the motion that it makes itself") {
    const temporary_folder folder;
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

TEST_CASE("the scene dropped is what symplectic_euler makes of its world") {
    aabblab::scene_frames scene(few_balls);
    const aabb::composition c;
    aabblab::stage_runner stage_runner(aabblab::candidate_of(c, true), scene, aabb::instrumentation::none);
    std::vector<std::vector<aabb::pose>> played;
    aabblab::run_frames(scene, stage_runner, [&](const aabblab::searched_frame&) {
        played.emplace_back(scene.poses().begin(), scene.poses().end());
    });

    const aabblab::stepped_world world =
        aabblab::dropped_world({.balls = 8, .height = 0.05, .speed = 3, .depth = 0.002},
                               {scene.meshes()->meshes[0], scene.meshes()->meshes[1]}, 3);
    auto* const looked = new looked_at(world);
    aabblab::motion_state state = world.start();
    world.place(state.position, looked->now);
    aabblab::scene_frames looks{std::unique_ptr<aabb::mesh_scene>(looked)};
    aabblab::stage_runner finder(aabblab::candidate_of(c, true), looks, aabb::instrumentation::none);
    aabblab::dynamics forces(world);
    const auto euler = aabblab::integrator_named("symplectic_euler")->make(0);
    const aabblab::acceleration_of acceleration = [&](const auto& position, const auto& velocity, auto& result) {
        world.place(position, looked->now);
        looks.next();
        finder.update();
        finder.search();
        finder.detect();
        forces.accelerate(position, velocity, finder.sorted_contacts(), result);
    };
    for (std::size_t frame = 0; frame < played.size(); ++frame) {
        INFO("frame " << frame);
        std::vector<aabb::pose> poses;
        world.place(state.position, poses);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const aabb::vec3d apart = poses[i].translation - played[frame][i].translation;
            REQUIRE(dot(apart, apart) < 1e-20);
        }
        euler->advance(acceleration, state, 0.001);
    }
}
