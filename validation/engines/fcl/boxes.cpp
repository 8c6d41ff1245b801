module;
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision_object.h>

module aabb.engines;

import :box_engine;
import :engine;

namespace aabb {

namespace {

// The size in Debian's libfcl. An Eigen alignment above EIGEN_MAX_ALIGN_BYTES=16 gives 256 and corrupts memory.
static_assert(sizeof(fcl::CollisionObjectd) == 224);

/// An object without geometry, which keeps our exact box: FCL would recompute boxes of geometries, with rounding.
class fcl_object final : public fcl::CollisionObjectd {
public:
    explicit fcl_object(std::uint32_t id) : fcl::CollisionObjectd(nullptr), id_(id) {}

    [[nodiscard]] std::uint32_t id() const { return id_; }
    void set_bounds(const box& b) {
        aabb.min_ = {b.min[0], b.min[1], b.min[2]};
        aabb.max_ = {b.max[0], b.max[1], b.max[2]};
    }

private:
    std::uint32_t id_;
};

class fcl_boxes final : public box_engine {
public:
    /// Counts objects and nodes of the tree, but not FCL's map from objects to nodes.
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        const std::size_t n = manager_.size();
        using node = fcl::DynamicAABBTreeCollisionManagerd::DynamicAABBNode;
        return {{"engine", bytes_of(objects_) + n * sizeof(fcl_object) + (n ? 2 * n - 1 : 0) * sizeof(node)}};
    }

private:
    [[nodiscard]] bool can_take_moved() const override { return true; }

    /// Updates FCL's tree (`manager_`) to the boxes of the present objects: removes those that left, and adds new ones.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        drop_absent(objects_, [&](const auto& object) { manager_.unregisterObject(object.get()); });
        if (!ids.empty() && objects_.size() <= ids.back()) objects_.resize(std::size_t{ids.back()} + 1);
        std::vector<fcl::CollisionObjectd*> arrivals, updated;
        for (const std::uint32_t id : ids) {
            if (!objects_[id]) {
                objects_[id] = std::make_unique<fcl_object>(id);
                arrivals.push_back(objects_[id].get());
            }
            objects_[id]->set_bounds(boxes[id]);
            updated.push_back(objects_[id].get());
        }
        manager_.registerObjects(arrivals);
        if (updated.size() < manager_.size())
            manager_.update(updated);
        else
            manager_.update();
    }

    void find_pairs(std::vector<index_pair>& pairs) override {
        manager_.collide(&pairs, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* collector) {
            static_cast<std::vector<index_pair>*>(collector)->push_back(
                ordered_pair(static_cast<fcl_object*>(a)->id(), static_cast<fcl_object*>(b)->id()));
            return false;
        });
    }

    std::vector<std::unique_ptr<fcl_object>> objects_;  // by id; null where absent
    fcl::DynamicAABBTreeCollisionManagerd manager_;     // destroyed first: it points to the objects
};

}  // namespace

// Defined in meshes.cpp.
std::unique_ptr<local_stage> make_fcl_meshes();

engine fcl_engine() {
    return {.name = "fcl",
            .summary = "FCL's dynamic AABB tree for boxes, and its trees of oriented boxes in double for meshes",
            .exact = false,
            .boxes = make_stage<global_stage, fcl_boxes>,
            .meshes = make_fcl_meshes};
}

}  // namespace aabb
