// Pairs by FCL: a dynamic AABB tree of boxes, whose candidates `fcl::collide` tests, and two trees of triangles.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

#include <limits>
#include <memory>

#include "exchange.hpp"

namespace {

/// What the callback receives: it tests a candidate, and stores its objects if they collide.
struct collected_pairs {
    std::vector<std::array<std::size_t, 2>> pairs;

    static bool collide(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
        const fcl::CollisionRequestd request;
        fcl::CollisionResultd result;
        fcl::collide(a, b, request, result);
        const auto id = [](const fcl::CollisionObjectd* object) {
            return *static_cast<const std::size_t*>(object->getUserData());
        };
        if (result.isCollision()) static_cast<collected_pairs*>(data)->pairs.push_back({id(a), id(b)});
        return false;
    }
};

void find_boxes(const std::vector<std::vector<lists::box>>& frames, lists::pair_file& out) {
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        const std::vector<lists::box>& boxes = frames[frame];
        std::vector<std::size_t> ids(boxes.size());
        std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
        fcl::DynamicAABBTreeCollisionManagerd manager;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const fcl::Vector3d min(boxes[i].min[0], boxes[i].min[1], boxes[i].min[2]);
            const fcl::Vector3d max(boxes[i].max[0], boxes[i].max[1], boxes[i].max[2]);
            const auto shape = std::make_shared<fcl::Boxd>(max - min);
            objects.push_back(
                std::make_unique<fcl::CollisionObjectd>(shape, fcl::Matrix3d::Identity(), (min + max) / 2));
            ids[i] = i;
            objects.back()->setUserData(&ids[i]);
            manager.registerObject(objects.back().get());
        }
        manager.setup();
        collected_pairs collected;
        manager.collide(&collected, collected_pairs::collide);
        for (const auto& [a, b] : collected.pairs) out.add(frame, a, b);
    }
}

using tree = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<tree> tree_of(const lists::mesh& m) {
    std::vector<fcl::Vector3d> vertices;
    for (const auto& v : m.vertices) vertices.emplace_back(v[0], v[1], v[2]);
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : m.triangles)
        triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                               static_cast<std::size_t>(t[2]));
    auto model = std::make_shared<tree>();
    model->beginModel();
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
}

void find_triangles(const lists::mesh& a, const lists::mesh& b, lists::pair_file& out) {
    fcl::CollisionRequestd request;
    request.num_max_contacts = std::numeric_limits<std::size_t>::max();
    fcl::CollisionResultd result;
    const fcl::Transform3d identity = fcl::Transform3d::Identity();
    fcl::collide(tree_of(a).get(), identity, tree_of(b).get(), identity, request, result);
    for (std::size_t i = 0; i < result.numContacts(); ++i) out.add(result.getContact(i).b1, result.getContact(i).b2);
}

}  // namespace

int main(int count, char** values) {
    return lists::run(count, values, "FCL " FCL_VERSION, find_boxes, find_triangles);
}
