module aabb.extreme;

namespace aabb {

std::vector<extreme_scene> extreme_scenes(extreme_size size) {
    std::vector<extreme_scene> all;
    for (const std::vector<extreme_scene>& some :
         {box_scenes(), bad_box_scenes(), mesh_scenes(size), bad_mesh_scenes(), other_arithmetic_scenes()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

}  // namespace aabb
