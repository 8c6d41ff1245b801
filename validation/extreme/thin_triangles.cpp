module;
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

module aabb.extreme;

import aabb.geometry;
import aabb.pipeline;
import :bodies;
import :draws;
import :known_scenes;
import :making;
import :scene;

namespace aabb {

namespace {

/// @param height of a triangle over its length
std::unique_ptr<mesh_scene> needles(float height) {
    draws random(51);
    std::vector<triangle3f> triangles;
    for (int i = 0; i < 60; ++i) {
        const vec3f from = random.point(-1, 1);
        const vec3f to = random.point(-1, 1);
        vec3f beside = to;
        for (int k = 0; k < 3; ++k) beside[k] = (from[k] + to[k]) / 2 + height * random.between(-1, 1);
        triangles.push_back({{from, to, beside}});
    }
    return std::make_unique<known_poses>(
        soup_of(triangles), pose_frames{{{}, {}}, {{}, shifted(1e-7, 0, 0)}, {{}, turned(1e-6, {0, 0, 0})}});
}

/// Segments and points among triangles of whole numbers, so that they meet.
std::unique_ptr<mesh_scene> zero_areas() {
    draws random(52);
    std::vector<triangle3f> triangles;
    const auto whole = [&] { return static_cast<float>(random.below(5)); };
    for (std::uint32_t i = 0; i < 60; ++i) {
        triangle3f t{{{whole(), whole(), whole()}, {whole(), whole(), whole()}, {whole(), whole(), whole()}}};
        if (i % 3 > 0) t[2] = t[1];
        if (i % 3 > 1) t[1] = t[0];
        if (i % 6 > 3) t[2] = t[0];
        triangles.push_back(t);
    }
    return std::make_unique<known_poses>(soup_of(triangles), pose_frames{{{}, {}}, {{}, shifted(1, 0, 0)}});
}

}  // namespace

std::vector<extreme_scene> thin_triangle_scenes() {
    return {
        scene_of_meshes("slivers", "a millionth as high as long", [] { return needles(1e-6F); }),
        scene_of_meshes("thinnest", "as high as a step of the last place", [] { return needles(1e-8F); }),
        scene_of_meshes("zero_areas", "triangles, segments and points", zero_areas),
    };
}

}  // namespace aabb
