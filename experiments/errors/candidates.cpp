module aabblab.errors;

import aabb.pipeline;
import aabb.registry;

namespace aabblab {

namespace {

/// Appends the pairs of two objects.
void add_candidates(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b, const aabb::pose& pose_b,
                    std::vector<aabb::triangle_pair<float>>& candidates) {
    const aabb::box bounds_b = aabb::bounds_of(b);
    const aabb::relative_pose to_a(pose_a, pose_b, bounds_b);
    if (!aabb::overlaps(aabb::bounds_of(a), to_a(bounds_b))) return;
    std::vector<aabb::box> boxes;
    std::vector<aabb::triangle3f> carried;
    for (std::uint32_t t = 0; t < a.triangle_count(); ++t) boxes.push_back(aabb::bounds_of(a.triangle(t)));
    for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
        carried.push_back(to_a(b.triangle(t)));
        boxes.push_back(aabb::bounds_of(carried.back()));
    }
    const auto search = aabb::compose_global_search({}, aabb::instrumentation::none);
    for (std::uint32_t id = 0; id < boxes.size(); ++id) search->insert(id);
    search->update(boxes);
    std::vector<aabb::index_pair> pairs;
    search->search(pairs);
    for (const aabb::index_pair p : pairs)
        if (p.a < a.triangle_count() && p.b >= a.triangle_count())
            candidates.push_back({a.triangle(p.a), carried[p.b - a.triangle_count()]});
}

}  // namespace

std::vector<aabb::triangle_pair<float>> candidate_triangles(const scene_choice& choice) {
    const std::unique_ptr<aabb::mesh_scene> scene = make_mesh_scene(choice);
    std::vector<aabb::triangle_pair<float>> candidates;
    const auto mesh_of = [&](std::size_t object) -> const aabb::mesh& { return scene->meshes[scene->mesh_of[object]]; };
    for (std::vector<aabb::pose> poses; scene->next(poses);)
        for (std::size_t a = 0; a < poses.size(); ++a)
            for (std::size_t b = a + 1; b < poses.size(); ++b)
                add_candidates(mesh_of(a), poses[a], mesh_of(b), poses[b], candidates);
    return candidates;
}

}  // namespace aabblab
