module;
#include <memory>
#include <string>
#include <utility>
#include <vector>

module aabb.extreme;

import aabb.geometry;
import aabb.pipeline;
import :arithmetic;
import :bodies;
import :known_scenes;
import :making;
import :scene;

namespace aabb {

namespace {

extreme_scene computed_in(arithmetic kind, extreme_scene scene, std::string refusal) {
    scene.computed_in = kind;
    return refused(std::move(scene), std::move(refusal));
}

extreme_scene boxes(const char* name, const char* summary) {
    return scene_of_boxes(name, summary, [] {
        return box_frames{{{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{3, 0, 0}, {4, 1, 1}}}};
    });
}

extreme_scene meshes(const char* name, const char* summary) {
    return scene_of_meshes(name, summary,
                           [] { return std::make_unique<known_poses>(cube(), pose_frames{{{}, shifted(1, 1, 1)}}); });
}

}  // namespace

std::vector<extreme_scene> other_arithmetic_scenes() {
    const std::string flushes = "this thread flushes denormal numbers to zero";
    const std::string rounds = "this thread does not round to nearest";
    std::vector<extreme_scene> all;
    if (can_flush_denormals()) {
        const char* summary = "a thread that takes denormal numbers for zero";
        all.push_back(computed_in(arithmetic::denormals_flushed, boxes("flushed_boxes", summary), flushes));
        all.push_back(computed_in(arithmetic::denormals_flushed, meshes("flushed_meshes", summary), flushes));
    }
    const char* summary = "a thread that rounds upward";
    all.push_back(computed_in(arithmetic::rounded_upward, boxes("upward_boxes", summary), rounds));
    all.push_back(computed_in(arithmetic::rounded_upward, meshes("upward_meshes", summary), rounds));
    return all;
}

}  // namespace aabb
