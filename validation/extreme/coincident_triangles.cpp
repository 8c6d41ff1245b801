module;
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
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

constexpr triangle3f one{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
constexpr triangle3f across{{{0.5F, 0.5F, -1}, {0.5F, 0.5F, 1}, {0.25F, 3, 0}}};

/// No build can part them.
std::unique_ptr<mesh_scene> same_centroid() {
    draws random(41);
    std::vector<triangle3f> triangles;
    const auto whole = [&] { return static_cast<float>(random.below(17)) - 8; };
    for (int i = 0; i < 40; ++i) {
        const vec3f p{whole(), whole(), whole()};
        const vec3f q{whole(), whole(), whole()};
        triangles.push_back({{p, q, {-p[0] - q[0], -p[1] - q[1], -p[2] - q[2]}}});
    }
    return std::make_unique<known_poses>(soup_of(triangles),
                                         pose_frames{{{}, {}}, {{}, shifted(1, 0, 0)}, {{}, turned(1, {0, 0, 5})}});
}

/// Each four times, one after the other, and once more with its corners in another order.
std::unique_ptr<mesh_scene> duplicates() {
    mesh m = cube();
    // Those of one face and a half.
    m.triangles.resize(12);
    const auto once = m.triangles;
    for (int i = 0; i < 3; ++i) m.triangles.insert(m.triangles.end(), once.begin(), once.end());
    for (const auto& t : once) m.triangles.push_back({t[2], t[0], t[1]});
    return std::make_unique<known_poses>(std::move(m),
                                         pose_frames{{{}, shifted(1, 1, 1)}, {{}, turned(0.5, {1, 0, 1})}});
}

std::unique_ptr<mesh_scene> one_triangle_each() {
    return std::make_unique<known_poses>(
        std::vector{soup_of({one}), soup_of({across})},
        pose_frames{{{}, {}}, {{}, shifted(0, 0, 1)}, {{}, shifted(0, 0, 1.5)}, {shifted(3, 3, 3), shifted(3, 3, 3)}});
}

mesh coincident(std::uint32_t count) {
    mesh m = soup_of({one});
    m.triangles.resize(count, m.triangles[0]);
    return m;
}

std::uint32_t many_at(extreme_size size) {
    switch (size) {
        case extreme_size::small: return 300;
        case extreme_size::quick: return 20'000;
        case extreme_size::full: break;
    }
    return 1'000'000;
}

}  // namespace

std::vector<extreme_scene> coincident_triangle_scenes(extreme_size size) {
    const std::uint32_t many = many_at(size);
    extreme_scene against_one =
        scene_of_meshes("many_against_one", std::to_string(many) + " times the same triangle, against one", [many] {
            return std::make_unique<known_poses>(std::vector{coincident(many), soup_of({across})},
                                                 pose_frames{{{}, {}}});
        });
    against_one.asked = extreme_query::count_pairs;
    extreme_scene against_itself = scene_of_meshes(
        "many_against_many", "the same against itself: any one pair",
        [many] { return std::make_unique<known_poses>(coincident(many), pose_frames{{{}, shifted(0.5, 0.5, 0)}}); });
    against_itself.asked = extreme_query::first_pair;
    // The largest layout has an internal node of 32 bytes and a leaf of 28 for each triangle; the rest is for stacks.
    for (extreme_scene* scene : {&against_one, &against_itself}) scene->most_bytes = std::size_t{many} * 64 + 65'536;
    return {scene_of_meshes("same_centroid", "all triangles about one point", same_centroid),
            scene_of_meshes("duplicates", "each triangle five times", duplicates),
            scene_of_meshes("one_triangle", "meshes of a triangle each", one_triangle_each), against_one,
            against_itself};
}

}  // namespace aabb
