module aabblab.queries;

import aabb.distance_stages;
import aabblab.stopwatch;

namespace aabblab {

/// Measures the distance at each pose of the second mesh, through trees that are built once.
distances_result measure_distances(const search_choice& choice, const std::vector<aabb::mesh>& meshes,
                                   const aabb::pose& pose_a, const given_poses& poses_b) {
    aabb::scene_traits traits = aabb::traits_of(meshes, meshes.size(), /*frames=*/1);
    aabb::composition c = select_composition(choice.named, traits);
    distances_result result;
    const wall_stopwatch building;
    const auto stage = aabb::compose_distance(c);
    for (const aabb::mesh& m : meshes) {
        stage->add_model(m);
        result.triangles.push_back(m.triangle_count());
    }
    result.build_ms = building.ms();
    c[aabb::strategy_kind::triangle] = {"distance", {}};
    result.method = to_text(c, aabb::stage::local_detection);
    for (std::size_t pose = 0; pose < poses_b.poses.size(); ++pose) {
        const wall_stopwatch measuring;
        try {
            result.distances.push_back(stage->distance(0, pose_a, 1, poses_b.poses[pose]));
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(poses_b.place_of(pose) + error.what());
        }
        result.query_ms.push_back(measuring.ms());
    }
    return result;
}

}  // namespace aabblab
