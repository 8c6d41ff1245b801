module;
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// What lists of scenes are written with.
module aabb.extreme:making;

import aabb.geometry;
import aabb.pipeline;
import :scene;

namespace aabb {

using box_frames = std::vector<std::vector<box>>;
using pose_frames = std::vector<std::vector<pose>>;

/// A scene of these frames, in which all objects are there all the time.
[[nodiscard]] inline extreme_scene scene_of_boxes(std::string name, std::string summary,
                                                  std::function<box_frames()> make) {
    extreme_scene made{.name = std::move(name), .summary = std::move(summary)};
    made.make_boxes = [make = std::move(make)]() -> std::unique_ptr<box_scene> {
        return std::make_unique<known_boxes>(make());
    };
    return made;
}

[[nodiscard]] inline extreme_scene scene_of_meshes(std::string name, std::string summary,
                                                   std::function<std::unique_ptr<mesh_scene>()> make) {
    extreme_scene made{.name = std::move(name), .summary = std::move(summary)};
    made.make_meshes = std::move(make);
    return made;
}

/// The same scene, to be refused by a sentence that says this.
[[nodiscard]] inline extreme_scene refused(extreme_scene scene, std::string refusal) {
    scene.refusal = std::move(refusal);
    return scene;
}

/// The box with this corner and these extents.
[[nodiscard]] inline box box_at(const vec3f& low, const vec3f& extents) {
    box b{low, low};
    for (int k = 0; k < 3; ++k) b.max[k] += extents[k];
    return b;
}

[[nodiscard]] inline pose shifted(double x, double y, double z) {
    return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, y, z}};
}

}  // namespace aabb
