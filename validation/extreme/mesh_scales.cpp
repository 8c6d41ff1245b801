module;
#include <memory>
#include <string>
#include <utility>
#include <vector>

module aabb.extreme;

import aabb.geometry;
import aabb.pipeline;
import :bodies;
import :known_scenes;
import :making;
import :scene;

namespace aabb {

namespace {

/// Two balls of that radius that pass through each other.
std::unique_ptr<mesh_scene> balls_of(double radius) {
    return std::make_unique<known_poses>(
        ball(5, radius), pose_frames{{{}, turned(0.4, {0.8 * radius, 0.5 * radius, 0.1 * radius})},
                                     {turned(-1, {radius, 0, 0}), turned(2, {0.5 * radius, 0, radius})}});
}

/// One of radius 1, the other of that radius, on the first one's surface.
std::unique_ptr<mesh_scene> ball_on_ball(double radius) {
    return std::make_unique<known_poses>(std::vector{ball(5, 1), ball(5, radius)},
                                         pose_frames{{{}, shifted(0, 0, 1 + radius / 2)}, {{}, shifted(0, 1, 0)}});
}

/// Both moved that far, and as much apart as ever.
std::unique_ptr<mesh_scene> balls_moved(double far) {
    return std::make_unique<known_poses>(ball(5, 1),
                                         pose_frames{{shifted(far, -far, far), turned(0.4, {far + 1, -far, far + 0.5})},
                                                     {shifted(-far, far, 0), shifted(-far, far, 0)}});
}

}  // namespace

std::vector<extreme_scene> mesh_scale_scenes() {
    std::vector<extreme_scene> all;
    for (const auto& [name, radius] : {std::pair{"scale_1e-44", 1e-44},
                                       {"scale_1e-39", 1e-39},
                                       {"scale_1e-30", 1e-30},
                                       {"scale_1e-10", 1e-10},
                                       {"scale_1e10", 1e10},
                                       {"scale_1e30", 1e30},
                                       {"scale_1e37", 1e37}})
        all.push_back(scene_of_meshes(name, "two balls of that radius through each other",
                                      [size = radius] { return balls_of(size); }));
    for (const auto& [name, radius] : {std::pair{"beside_1e-6", 1e-6}, {"beside_1e6", 1e6}, {"beside_1e-38", 1e-38}})
        all.push_back(scene_of_meshes(name, "a ball of that radius on one of radius 1",
                                      [size = radius] { return ball_on_ball(size); }));
    for (const auto& [name, far] : {std::pair{"moved_1e6", 1e6}, {"moved_1e9", 1e9}, {"moved_1e15", 1e15}})
        all.push_back(scene_of_meshes(name, "both moved that far, as near to each other as ever",
                                      [way = far] { return balls_moved(way); }));
    return all;
}

}  // namespace aabb
