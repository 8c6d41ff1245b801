// FCL's distance of two meshes, by trees of rectangle swept spheres, as its documentation uses it.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>

#include "peers.hpp"

namespace aabblab {

namespace {

using tree = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<tree> tree_of(const aabb::mesh& m) {
    std::vector<fcl::Vector3d> points;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        const aabb::vec3d at = m.given_vertex(v);
        points.emplace_back(at[0], at[1], at[2]);
    }
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : m.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    auto built = std::make_shared<tree>();
    built->beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size()));
    built->addSubModel(points, triangles);
    built->endModel();
    return built;
}

fcl::Transform3d in_fcl(const aabb::pose& p) {
    fcl::Transform3d result = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) result.linear()(i, j) = p.rotation[static_cast<std::size_t>(3 * i + j)];
        result.translation()[i] = p.translation[i];
    }
    return result;
}

}  // namespace

distance_peer fcl_distances() {
    return {.name = "fcl", .distance = [](const aabb::mesh& a, const aabb::mesh& b) -> distance_peer::measurement {
                return [of_a = tree_of(a), of_b = tree_of(b)](const aabb::pose& at) {
                    const fcl::DistanceRequestd request;
                    fcl::DistanceResultd result;
                    fcl::distance(of_a.get(), fcl::Transform3d::Identity(), of_b.get(), in_fcl(at), request, result);
                    return std::max(0.0, result.min_distance);
                };
            }};
}

}  // namespace aabblab
