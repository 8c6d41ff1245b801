module;
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

module aabb.engines;

import aabb.base;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import :mesh_engine;

namespace aabb {

namespace {

using fcl_tree = fcl::BVHModel<fcl::OBBRSSd>;

/// FCL's trees of oriented boxes in double. It takes the raw poses, so that no vertex is rounded to float.
class fcl_meshes final : public mesh_engine {
public:
    std::uint32_t add_model(const mesh& m) override {
        models_.push_back({&m, tree_of(m), {}});
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    void refit(std::uint32_t model) override {
        auto& [triangles, tree, fit] = models_[model];
        fit.renew([&] {
            require_ieee_arithmetic();
            require_valid(*triangles);
            const std::vector<fcl::Vector3d> vertices = vertices_of(*triangles);
            // A tree whose refit broke off FCL would take for one in the midst of it, and write beyond its vertices.
            std::unique_ptr<fcl_tree> refitted = tree ? std::move(tree) : tree_of(*triangles);
            refitted->beginReplaceModel();
            refitted->replaceSubModel(vertices);
            refitted->endReplaceModel(true, true);
            tree = std::move(refitted);
        });
    }

    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        const fcl::CollisionResultd result = collide(model_a, pose_a, model_b, pose_b, 1);
        if (!result.isCollision()) return std::nullopt;
        return pair_of(result.getContact(0));
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::size_t all = 0;
        for (const model& m : models_)
            if (m.tree)
                all += static_cast<std::size_t>(m.tree->getNumBVs()) * sizeof(fcl::BVNode<fcl::OBBRSSd>) +
                       static_cast<std::size_t>(m.tree->num_tris) * sizeof(fcl::Triangle) +
                       static_cast<std::size_t>(m.tree->num_vertices) * sizeof(fcl::Vector3d);
        return {{"engine", all}};
    }

private:
    struct model {
        const mesh* triangles;
        std::unique_ptr<fcl_tree> tree;  // none after a refit that broke off
        mesh_fit fit;
    };

    [[nodiscard]] static std::vector<fcl::Vector3d> vertices_of(const mesh& m) {
        std::vector<fcl::Vector3d> vertices;
        for (const vec3f& v : m.vertices) vertices.emplace_back(v[0], v[1], v[2]);
        return vertices;
    }

    [[nodiscard]] static std::unique_ptr<fcl_tree> tree_of(const mesh& m) {
        require_ieee_arithmetic();
        require_valid(m);
        const std::vector<fcl::Vector3d> vertices = vertices_of(m);
        std::vector<fcl::Triangle> triangles;
        for (const auto& t : m.triangles) triangles.emplace_back(t[0], t[1], t[2]);
        auto tree = std::make_unique<fcl_tree>();
        require_done(tree->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size())));
        require_done(tree->addSubModel(vertices, triangles));
        require_done(tree->endModel());
        return tree;
    }

    /// FCL says by a number that memory ran out, and would go on with half a tree.
    static void require_done(int code) {
        if (code != fcl::BVH_OK) throw std::bad_alloc();
    }

    [[nodiscard]] static fcl::Transform3d transform(const pose& p) {
        fcl::Transform3d all = fcl::Transform3d::Identity();
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) all.linear()(i, j) = p.rotation[static_cast<std::size_t>(3 * i + j)];
            all.translation()[i] = p.translation[i];
        }
        return all;
    }

    [[nodiscard]] static index_pair pair_of(const fcl::Contactd& contact) {
        return {static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2)};
    }

    void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
              std::vector<index_pair>& pairs) override {
        const fcl::CollisionResultd result =
            collide(model_a, pose_a, model_b, pose_b, std::numeric_limits<std::size_t>::max());
        for (std::size_t i = 0; i < result.numContacts(); ++i) pairs.push_back(pair_of(result.getContact(i)));
    }

    /// Without contact points each pair of triangles is reported once.
    [[nodiscard]] fcl::CollisionResultd collide(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                const pose& pose_b, std::size_t most) const {
        require_ieee_arithmetic();
        models_[model_a].fit.require();
        models_[model_b].fit.require();
        fcl::CollisionRequestd request;
        request.num_max_contacts = most;
        request.enable_contact = false;
        fcl::CollisionResultd result;
        fcl::collide(models_[model_a].tree.get(), transform(pose_a), models_[model_b].tree.get(), transform(pose_b),
                     request, result);
        return result;
    }

    std::vector<model> models_;
};

}  // namespace

std::unique_ptr<local_stage> make_fcl_meshes() {
    return std::make_unique<fcl_meshes>();
}

}  // namespace aabb
