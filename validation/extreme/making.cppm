module;
#include <random>

/// Helpers to define the extreme scenes.
module aabb.extreme:making;

import aabb.extreme;
import aabb.pipeline;
import aabb.std;

namespace aabb {

// The parts of the list of extreme scenes.
[[nodiscard]] std::vector<extreme_scene> box_scenes();
[[nodiscard]] std::vector<extreme_scene> invalid_box_scenes();
[[nodiscard]] std::vector<extreme_scene> mesh_scenes(extreme_size size);
/// Includes valid poses close to the limit of rejection.
[[nodiscard]] std::vector<extreme_scene> invalid_mesh_scenes();
[[nodiscard]] std::vector<extreme_scene> other_arithmetic_scenes();

using box_frames = std::vector<std::vector<box>>;
using pose_frames = std::vector<std::vector<pose>>;

/// A scene of these frames, in which all objects are always present.
[[nodiscard]] inline extreme_scene scene_of_boxes(std::string name, std::string summary,
                                                  std::function<box_frames()> make) {
    extreme_scene scene{.name = std::move(name), .summary = std::move(summary)};
    scene.make_boxes = [make = std::move(make)]() -> std::unique_ptr<box_scene> {
        return std::make_unique<known_boxes>(make());
    };
    return scene;
}

[[nodiscard]] inline extreme_scene scene_of_meshes(std::string name, std::string summary,
                                                   std::function<std::unique_ptr<mesh_scene>()> make) {
    extreme_scene scene{.name = std::move(name), .summary = std::move(summary)};
    scene.make_meshes = std::move(make);
    return scene;
}

/// Meshes at these poses; a single mesh is shared by all objects.
template <class Meshes>
[[nodiscard]] std::unique_ptr<mesh_scene> posed(Meshes meshes, pose_frames frames) {
    return std::make_unique<known_poses>(std::move(meshes), std::move(frames));
}

/// Marks the scene as invalid: it must be rejected with a message that contains `rejection`.
[[nodiscard]] inline extreme_scene rejected(extreme_scene scene, std::string rejection) {
    scene.rejection = std::move(rejection);
    return scene;
}

[[nodiscard]] inline box box_at(const vec3f& low, const vec3f& extents) {
    box b{low, low};
    for (int k = 0; k < 3; ++k) b.max[k] += extents[k];
    return b;
}

[[nodiscard]] inline pose shifted(double x, double y, double z) {
    return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, y, z}};
}

/// Random numbers that do not depend on the standard library, which specifies engines but not distributions.
class draws {
public:
    explicit draws(std::uint32_t seed) : engine_(seed) {}

    /// A random number in [low, high).
    [[nodiscard]] float between(float low, float high) {
        return low + (high - low) * (static_cast<float>(engine_() >> 8U) * 0x1p-24F);
    }
    /// A random number in [0, count).
    [[nodiscard]] std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(engine_() % count); }
    /// Each coordinate in [low, high).
    [[nodiscard]] vec3f point(float low, float high) {
        // Braced lists are evaluated from left to right.
        return vec3f{between(low, high), between(low, high), between(low, high)};
    }

private:
    std::mt19937 engine_;
};

/// The mesh of these triangles, in which no two share vertices.
[[nodiscard]] inline mesh soup_of(const std::vector<triangle3f>& triangles) {
    mesh m;
    for (const triangle3f& t : triangles) {
        const auto first = static_cast<std::uint32_t>(m.vertices.size());
        for (const vec3f& corner : t.corner) m.vertices.push_back(corner);
        m.triangles.push_back({first, first + 1, first + 2});
    }
    return m;
}

/// The cube from 0 to 2 with 8 triangles per face; coordinates are integers.
[[nodiscard]] inline mesh cube() {
    mesh m;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int u = 0; u < 2; ++u)
                for (int v = 0; v < 2; ++v) {
                    const auto first = static_cast<std::uint32_t>(m.vertices.size());
                    for (int corner = 0; corner < 4; ++corner) {
                        vec3f p{};
                        p[axis] = static_cast<float>(2 * side);
                        p[(axis + 1) % 3] = static_cast<float>(u + corner % 2);
                        p[(axis + 2) % 3] = static_cast<float>(v + (corner > 1 ? 1 : 0));
                        m.vertices.push_back(p);
                    }
                    m.triangles.push_back({first, first + 1, first + 2});
                    m.triangles.push_back({first + 1, first + 3, first + 2});
                }
    return m;
}

/// The mesh with its coordinates times a factor, plus an offset. The mesh gets doubles, which need not be floats.
[[nodiscard]] inline mesh in_double(mesh m, double factor, const vec3d& offset) {
    std::vector<vec3d> vertices;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        const vec3d p = m.given_vertex(v);
        vertices.push_back({p[0] * factor + offset[0], p[1] * factor + offset[1], p[2] * factor + offset[2]});
    }
    set_vertices(m, std::move(vertices));
    return m;
}

/// A sphere around the origin with `rings` rings; half of the triangles at the poles have zero area.
[[nodiscard]] inline mesh ball(std::uint32_t rings, double radius) {
    mesh m;
    const std::uint32_t segments = 2 * rings;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            const double polar_angle = std::numbers::pi * i / rings;
            const double azimuth = 2 * std::numbers::pi * j / segments;
            const double axis_distance = i == 0 || i == rings ? 0 : radius * std::sin(polar_angle);
            m.vertices.push_back({static_cast<float>(axis_distance * std::cos(azimuth)),
                                  static_cast<float>(axis_distance * std::sin(azimuth)),
                                  static_cast<float>(radius * std::cos(polar_angle))});
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            const std::uint32_t p = i * segments + j, q = i * segments + (j + 1) % segments;
            m.triangles.push_back({p, p + segments, q});
            m.triangles.push_back({q, p + segments, q + segments});
        }
    return m;
}

/// A rotation about z, computed in double, then a translation.
[[nodiscard]] inline pose turned(double angle, const vec3d& shift) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c, -s, 0, s, c, 0, 0, 0, 1}, shift};
}

}  // namespace aabb
