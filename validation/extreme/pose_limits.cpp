module;
#include <limits>
#include <memory>
#include <string>
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

/// Off a rotation by that much in the product of its first two rows.
pose skewed(double error) {
    pose p = shifted(0.7, 0.2, 0.1);
    p.rotation[1] = error;
    return p;
}

/// Longer by half of the error, so that the square of a row is off by it.
pose stretched(double error) {
    pose p = shifted(0.7, 0.2, 0.1);
    for (const std::size_t i : {0, 4, 8}) p.rotation[i] = 1 + error / 2;
    return p;
}

extreme_scene with_pose(const char* name, const char* summary, const pose& second) {
    return scene_of_meshes(name, summary,
                           [second] { return std::make_unique<known_poses>(ball(4, 1), pose_frames{{{}, second}}); });
}

}  // namespace

std::vector<extreme_scene> pose_limit_scenes() {
    constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    pose nowhere = shifted(0, not_a_number, 0);
    pose no_rotation = shifted(0, 0, 0);
    no_rotation.rotation[4] = infinity;
    pose reflection = shifted(0, 0, 0);
    reflection.rotation[8] = -1;
    extreme_scene beyond_float =
        refused(with_pose("beyond_float", "seen from the other mesh, 1e39 away", shifted(1e39, 0, 0)),
                "seen from one mesh, the other lies beyond the range of float");
    beyond_float.answered_in_double = true;
    return {
        with_pose("skewed_within", "a rotation skewed by a little less than 1e-6", skewed(0.999e-6)),
        with_pose("stretched_within", "stretched by a little less than the limit", stretched(0.999e-6)),
        refused(with_pose("skewed_beyond", "a rotation skewed by a little more", skewed(1.001e-6)),
                "object 1: the pose is not rigid: its rotation is not orthonormal within 1e-6"),
        refused(with_pose("stretched_beyond", "stretched by a little more", stretched(1.001e-6)),
                "object 1: the pose is not rigid: its rotation is not orthonormal within 1e-6"),
        refused(with_pose("reflection", "a rotation that mirrors", reflection),
                "object 1: the pose is not rigid: its rotation is a reflection"),
        refused(with_pose("rotation_infinite", "a rotation with an infinite entry", no_rotation),
                "object 1: the pose is not rigid: its rotation has an entry that is not finite"),
        refused(with_pose("translation_nan", "a translation that is no number", nowhere),
                "object 1: the pose has a translation that is not finite"),
        beyond_float,
    };
}

}  // namespace aabb
