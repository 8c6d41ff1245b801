module aabblab.checking;

import :comparison;
import :triangle_classes;
import aabb.registry;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.stopwatch;

namespace aabblab {

check_result check_triangles(const mesh_check& meshes, const pair_list& list) {
    const std::size_t poses = meshes.poses_b.poses.size();
    if (!list.has_frames && poses > 1)
        throw aabb::input_error(
            fmt::format("the list has no poses, but there are {}: expected the columns pose,a,b", grouped(poses)));
    // The ground truth of all poses, since the query passes each of them only once.
    std::vector<std::vector<aabb::index_pair>> truth(poses);
    const mesh_query query{.self = meshes.self,
                           .hits = {.touching = meshes.touching},
                           .by_pose = poses > 1,
                           .between = meshes.between,
                           .take = [&](std::uint32_t pose, std::span<const aabb::index_pair> pairs) {
                               truth[pose].insert(truth[pose].end(), pairs.begin(), pairs.end());
                           }};
    const mesh_result searched = search_meshes(
        query, {.stages = {aabb::stage::local_detection}, .named = {}, .engine = {}, .within = meshes.within},
        meshes.meshes, meshes.pose_a, meshes.poses_b, nullptr);
    const wall_stopwatch checking;
    const aabb::mesh& a = meshes.meshes.front();
    const aabb::mesh& b = meshes.meshes.back();
    list_comparison comparison(list, {poses, a.triangle_count(), b.triangle_count(), meshes.self.has_value()});
    triangle_classes classes(meshes.within, meshes.touching);
    for (std::size_t pose = 0; pose < poses; ++pose) {
        const posed_surface placed_a{a, meshes.pose_a, meshes.self ? "triangle" : "A"};
        const posed_surface placed_b{b, meshes.self ? meshes.pose_a : meshes.poses_b.poses[pose],
                                     meshes.self ? "triangle" : "B"};
        comparison.compare(truth[pose], [&](const frame_errors& errors) {
            errors.each([&](aabb::index_pair pair, bool is_listed) {
                classes.add({.frame = errors.frame, .pair = pair, .is_listed = is_listed}, placed_a, placed_b);
                return true;
            });
        });
    }
    check_result result = comparison.result({});
    classes.add_to(result);
    result.search_ms = searched.build_ms + std::accumulate(searched.query_ms.begin(), searched.query_ms.end(), 0.0);
    result.check_ms = checking.ms() - classes.ms();
    return result;
}

}  // namespace aabblab
