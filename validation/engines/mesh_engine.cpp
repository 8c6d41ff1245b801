module aabb.engines;

import aabb.base;
import :mesh_engine;

namespace aabb {

std::vector<vec3f> moved_vertices(const pose& pose_a, const pose& pose_b, const mesh& b, const box& bounds) {
    const relative_pose to_a(pose_a, pose_b, bounds);
    std::vector<vec3f> moved = b.vertices;
    for (vec3f& v : moved)
        if (contains(bounds, bounds_of(v))) v = to_a(v);
    return moved;
}

void mesh_engine::all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                            std::vector<index_pair>& pairs) {
    append_whole(pairs, [&] { find(model_a, pose_a, model_b, pose_b, pairs); });
}

std::uint64_t mesh_engine::count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                       const pose& pose_b) {
    std::vector<index_pair> pairs;
    all_pairs(model_a, pose_a, model_b, pose_b, pairs);
    return pairs.size();
}

void mesh_engine::self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) {
    std::vector<index_pair> both_ways;
    all_pairs(model, {}, model, {}, both_ways);
    append_whole(pairs, [&] {
        for (const index_pair pair : both_ways)
            if (pair.a < pair.b) pairs.push_back(pair);
    });
}

}  // namespace aabb
