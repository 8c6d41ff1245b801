module;
#include <memory>
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

/// A quarter turn about z, which rounds nothing.
constexpr pose quarter_turn{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 0}};

/// Two cubes of edge 2; in the second frame both stand elsewhere, and the second is turned so that it fills the same
/// space.
std::unique_ptr<mesh_scene> two_cubes(const vec3d& between) {
    const pose turned_second{quarter_turn.rotation, {between[0] + 2 + 7, between[1] + 5, between[2] - 3}};
    return std::make_unique<known_poses>(
        cube(), pose_frames{{{}, shifted(between[0], between[1], between[2])}, {shifted(7, 5, -3), turned_second}});
}

std::unique_ptr<mesh_scene> same_place() {
    const pose anywhere = turned(0.7, {0.3, -0.2, 0.1});
    return std::make_unique<known_poses>(ball(4, 1), pose_frames{{{}, {}}, {anywhere, anywhere}});
}

/// A corner of one stands on a face of the other, then on an edge.
std::unique_ptr<mesh_scene> corner_on_face() {
    const mesh corner = soup_of({{{{0, 0, 0}, {1, 1, 1}, {2, 1, 1}}}, {{{0, 0, 0}, {1, 1, 1}, {1, 2, 1}}}});
    return std::make_unique<known_poses>(
        std::vector{cube(), corner},
        pose_frames{{{}, shifted(0.5, 0.75, 2)}, {{}, shifted(0.5, 2, 2)}, {{}, shifted(1, 1, 2)}});
}

}  // namespace

std::vector<extreme_scene> touching_mesh_scenes() {
    return {
        scene_of_meshes("same_place", "a mesh in the place of its twin", same_place),
        scene_of_meshes("touch_at_vertices", "two cubes that share a corner", [] { return two_cubes({2, 2, 2}); }),
        scene_of_meshes("touch_along_edges", "two cubes that share an edge", [] { return two_cubes({2, 2, 0}); }),
        scene_of_meshes("touch_at_faces", "two cubes that share a face", [] { return two_cubes({2, 0, 0}); }),
        scene_of_meshes("corner_on_face", "a corner on a face, an edge, a vertex", corner_on_face),
    };
}

}  // namespace aabb
