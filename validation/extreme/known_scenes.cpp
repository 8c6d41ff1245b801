module;
#include <iterator>
#include <utility>
#include <vector>

module aabb.extreme;

import :known_scenes;
import :scene;

namespace aabb {

std::vector<extreme_scene> extreme_scenes(extreme_size size) {
    std::vector<extreme_scene> all;
    const auto add = [&](std::vector<extreme_scene> more) {
        all.insert(all.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
    };
    add(box_shape_scenes());
    add(box_place_scenes());
    add(box_change_scenes());
    add(bad_box_scenes());
    add(touching_mesh_scenes());
    add(coincident_triangle_scenes(size));
    add(thin_triangle_scenes());
    add(mesh_scale_scenes());
    add(pose_limit_scenes());
    add(bad_mesh_scenes());
    add(other_arithmetic_scenes());
    return all;
}

}  // namespace aabb
