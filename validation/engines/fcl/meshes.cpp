module;
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

module aabb.engines;

import :engine;
import :mesh_engine;

namespace aabb {

namespace {

/// A mesh as FCL's bounding volume hierarchy.
template <class Volume>
class fcl_tree {
public:
    /// Builds the tree, or refits it if it has the same triangles.
    void build(const mesh& m, std::span<const vec3d> vertices) {
        // `tree_` is null until this succeeds: FCL would continue a failed refit, and write beyond the vertices.
        std::unique_ptr<tree> built = std::move(tree_);
        if (built && has_same_triangles(*built, m)) {
            require_done(built->beginReplaceModel());
            for (const vec3d& v : vertices) require_done(built->replaceVertex({v[0], v[1], v[2]}));
            require_done(built->endReplaceModel(/*refit=*/true, /*bottomup=*/true));
        } else {
            std::vector<fcl::Vector3d> points;
            for (const vec3d& v : vertices) points.emplace_back(v[0], v[1], v[2]);
            std::vector<fcl::Triangle> triangles;
            for (const auto& t : m.triangles) triangles.emplace_back(t[0], t[1], t[2]);
            built = std::make_unique<tree>();
            require_done(built->beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size())));
            require_done(built->addSubModel(points, triangles));
            require_done(built->endModel());
        }
        tree_ = std::move(built);
    }

    [[nodiscard]] fcl::BVHModel<Volume>& get() const { return *tree_; }

    [[nodiscard]] std::size_t bytes() const {
        if (!tree_) return 0;
        return static_cast<std::size_t>(tree_->getNumBVs()) * sizeof(fcl::BVNode<Volume>) +
               static_cast<std::size_t>(tree_->num_tris) * sizeof(fcl::Triangle) +
               static_cast<std::size_t>(tree_->num_vertices) * sizeof(fcl::Vector3d);
    }

private:
    using tree = fcl::BVHModel<Volume>;

    /// Whether the tree has the same triangles as the mesh, which FCL does not check in a refit.
    [[nodiscard]] static bool has_same_triangles(const tree& built, const mesh& m) {
        const auto same = [](const fcl::Triangle& indices, const std::array<std::uint32_t, 3>& t) {
            return indices[0] == t[0] && indices[1] == t[1] && indices[2] == t[2];
        };
        const std::span indices(built.tri_indices, static_cast<std::size_t>(built.num_tris));
        return static_cast<std::size_t>(built.num_vertices) == m.vertices.size() &&
               std::ranges::equal(indices, m.triangles, same);
    }

    /// FCL reports a lack of memory by an error code, and would continue with an incomplete tree.
    static void require_done(int code) {
        if (code != fcl::BVH_OK) throw std::bad_alloc();
    }

    std::unique_ptr<tree> tree_;  // null after a failed build
};

template <class Volume>
struct fcl_model : engine_model {
    fcl_tree<Volume> local{};
    fcl_tree<Volume> transformed{};  ///< in the frame of another model, for trees without poses
    posed_pair poses{};              ///< of that model and this one

    [[nodiscard]] std::size_t bytes() const { return bytes_of(local, transformed); }
};

/// The common part of both engines.
template <class Volume>
class fcl_meshes : public model_engine<fcl_model<Volume>> {
protected:
    using model = fcl_model<Volume>;
    using model_query = typename model_engine<model>::model_query;

    /// Adds the intersecting pairs to the result.
    virtual void collide(const model_query& q, const fcl::CollisionRequestd& request,
                         fcl::CollisionResultd& result) = 0;

    /// The tree of mesh B, transformed into the frame of mesh A; kept until a pose changes. Transformed vertices are
    /// floats, relative to the offset and scale of A's `frame`, which turns them into doubles.
    [[nodiscard]] static fcl::BVHModel<Volume>& transformed(const model_query& q) {
        q.b.poses.renew(q.pose_a, q.pose_b, [&] {
            std::vector<vec3d> vertices;
            for (const vec3f& v : transformed_vertices(*q.a.source, q.pose_a, *q.b.source, q.pose_b, q.b.bounds))
                vertices.push_back(q.a.source->frame.vertex(in_double(v)));
            q.b.transformed.build(*q.b.source, vertices);
        });
        return q.b.transformed.get();
    }

private:
    void update_model(model& changed) final {
        changed.poses.forget();
        std::vector<vec3d> vertices;
        for (std::size_t v = 0; v < changed.source->vertices.size(); ++v)
            vertices.push_back(changed.source->given_vertex(v));
        changed.local.build(*changed.source, vertices);
    }

    [[nodiscard]] std::optional<index_pair> any_pair(const model_query& q) final {
        const fcl::CollisionResultd result = collide_up_to(q, 1);
        if (!result.isCollision()) return std::nullopt;
        return pair_of(result.getContact(0));
    }

    void append_pairs(const model_query& q, std::vector<index_pair>& pairs) final {
        const fcl::CollisionResultd result = collide_up_to(q, std::numeric_limits<std::size_t>::max());
        for (std::size_t i = 0; i < result.numContacts(); ++i) pairs.push_back(pair_of(result.getContact(i)));
    }

    [[nodiscard]] static index_pair pair_of(const fcl::Contactd& contact) {
        return {static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2)};
    }

    /// FCL's result with at most this number of pairs. No contact points: with them FCL reports a pair once per point.
    [[nodiscard]] fcl::CollisionResultd collide_up_to(const model_query& q, std::size_t most_contacts) {
        fcl::CollisionRequestd request;
        request.num_max_contacts = most_contacts;
        request.enable_contact = false;
        fcl::CollisionResultd result;
        collide(q, request, result);
        return result;
    }
};

/// Oriented boxes. FCL uses the raw poses, so that no vertex is rounded to float. It requires rotations; at other
/// poses, it gets B's vertices in A's frame.
class fcl_oriented final : public fcl_meshes<fcl::OBBRSSd> {
    /// Collides both trees. FCL takes only rigid transforms: at other poses, B is transformed into A's frame first.
    void collide(const model_query& q, const fcl::CollisionRequestd& request, fcl::CollisionResultd& result) override {
        if (is_rigid(q.pose_a) && is_rigid(q.pose_b)) {
            fcl::collide(&q.a.local.get(), transform(q.pose_a), &q.b.local.get(), transform(q.pose_b), request, result);
            return;
        }
        const fcl::Transform3d identity = fcl::Transform3d::Identity();
        fcl::collide(&q.a.local.get(), identity, &transformed(q), identity, request, result);
    }

    /// The pose in FCL's type; ours stores the rotation matrix by rows.
    [[nodiscard]] static fcl::Transform3d transform(const pose& p) {
        fcl::Transform3d result = fcl::Transform3d::Identity();
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) result.linear()(i, j) = p.rotation[static_cast<std::size_t>(3 * i + j)];
            result.translation()[i] = p.translation[i];
        }
        return result;
    }
};

/// Axis-aligned boxes, which need both trees in one frame.
class fcl_axis_aligned final : public fcl_meshes<fcl::AABBd> {
    /// Calls the parts of FCL's own call, which would copy and rebuild both trees in each query: B's tree is refitted
    /// for each new pose and cached until the pose changes.
    void collide(const model_query& q, const fcl::CollisionRequestd& request, fcl::CollisionResultd& result) override {
        fcl::Transform3d identity = fcl::Transform3d::Identity();
        fcl::detail::MeshCollisionTraversalNode<fcl::AABBd> node;
        fcl::detail::initialize(node, q.a.local.get(), identity, transformed(q), identity, request, result);
        fcl::detail::collide(&node);
    }
};

}  // namespace

std::unique_ptr<local_stage> make_fcl_meshes() {
    return std::make_unique<fcl_oriented>();
}

engine fcl_aabb_engine() {
    return {.name = "fcl_aabb",
            .summary =
                "FCL's trees of axis-aligned boxes, the second mesh's refitted for each new pose, with vertices "
                "rounded to float in the first mesh's frame",
            .exact = false,
            .meshes = make_stage<local_stage, fcl_axis_aligned>};
}

}  // namespace aabb
