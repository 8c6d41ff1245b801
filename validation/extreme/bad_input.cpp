module;
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// A good frame, then one in which box 7 is bad.
extreme_scene with_box(const char* name, const char* summary, const box& bad, const char* refusal) {
    return refused(scene_of_boxes(name, summary,
                                  [bad] {
                                      std::vector<box> boxes(20, {{0, 0, 0}, {1, 1, 1}});
                                      box_frames all{boxes, boxes};
                                      all[1][7] = bad;
                                      return all;
                                  }),
                   refusal);
}

extreme_scene with_mesh(const char* name, const char* summary, const mesh& bad, const char* refusal) {
    return refused(
        scene_of_meshes(
            name, summary,
            [bad] { return std::make_unique<known_poses>(std::vector{cube(), bad}, pose_frames{{{}, {}}}); }),
        refusal);
}

}  // namespace

std::vector<extreme_scene> bad_box_scenes() {
    return {
        with_box("box_nan", "a coordinate that is no number", {{0, not_a_number, 0}, {1, 1, 1}},
                 "box 7 has a coordinate that is not finite"),
        with_box("box_infinite", "a box without end", {{0, 0, 0}, {1, 1, infinity}},
                 "box 7 has a coordinate that is not finite"),
        with_box("box_inverted", "a minimum above its maximum", {{0, 2, 0}, {1, 1, 1}}, "box 7 is inverted"),
    };
}

std::vector<extreme_scene> bad_mesh_scenes() {
    mesh no_number = cube();
    no_number.vertices[5][1] = not_a_number;
    mesh endless = cube();
    endless.vertices[6][2] = -infinity;
    mesh beyond = cube();
    beyond.triangles[3][1] = static_cast<std::uint32_t>(beyond.vertices.size());
    mesh empty = cube();
    empty.triangles.clear();
    return {
        with_mesh("vertex_nan", "a coordinate that is no number", no_number,
                  "vertex 5 has a coordinate that is not finite"),
        with_mesh("vertex_infinite", "an infinite coordinate", endless, "vertex 6 has a coordinate that is not finite"),
        with_mesh("no_such_vertex", "a triangle of a vertex that is not there", beyond, "triangle 3 uses vertex"),
        with_mesh("no_triangles", "a mesh of vertices only", empty, "the mesh has no triangles"),
    };
}

}  // namespace aabb
