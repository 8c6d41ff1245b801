// Pairs by Bullet: the overlapping pairs of its usual broad phase, btDbvtBroadphase, whose boxes have margins once they
// move, and the triangles of two btGImpactMeshShape for which gContactAddedCallback is called.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <memory>
#include <set>

#include "exchange.hpp"

namespace {

btVector3 vector_of(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

void find_boxes(const std::vector<std::vector<lists::box>>& frames, lists::pair_file& out) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    std::vector<std::size_t> ids(frames.front().size());
    std::vector<btBroadphaseProxy*> proxies;
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const lists::box& b = frames[frame][i];
            ids[i] = i;
            if (frame == 0)
                proxies.push_back(broadphase.createProxy(vector_of(b.min), vector_of(b.max), BOX_SHAPE_PROXYTYPE,
                                                         &ids[i], btBroadphaseProxy::DefaultFilter,
                                                         btBroadphaseProxy::AllFilter, &dispatcher));
            else
                broadphase.setAabb(proxies[i], vector_of(b.min), vector_of(b.max), &dispatcher);
        }
        broadphase.calculateOverlappingPairs(&dispatcher);
        const btBroadphasePairArray& pairs = broadphase.getOverlappingPairCache()->getOverlappingPairArray();
        const auto id = [](const btBroadphaseProxy* proxy) {
            return *static_cast<const std::size_t*>(proxy->m_clientObject);
        };
        for (int i = 0; i < pairs.size(); ++i) out.add(frame, id(pairs[i].m_pProxy0), id(pairs[i].m_pProxy1));
    }
}

/// A mesh in the layout that Bullet reads, and its shape.
class mesh_shape {
public:
    explicit mesh_shape(const lists::mesh& m) : triangles_(m.triangles) {
        for (const auto& v : m.vertices)
            for (const double x : v) vertices_.push_back(static_cast<btScalar>(x));
        arrays_ = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(triangles_.size()), triangles_.data()->data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(m.vertices.size()), vertices_.data(), static_cast<int>(3 * sizeof(btScalar)));
        shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
        shape_->updateBound();
    }

    [[nodiscard]] btGImpactMeshShape* get() const { return shape_.get(); }

private:
    std::vector<std::array<int, 3>> triangles_;
    std::vector<btScalar> vertices_;
    std::unique_ptr<btTriangleIndexVertexArray> arrays_;
    std::unique_ptr<btGImpactMeshShape> shape_;
};

/// The triangles of all contacts, of A and of B; a pair of triangles has a contact per point. Bullet's callback has no
/// argument for them.
struct {
    const btCollisionObject* object_a;
    std::set<std::array<int, 2>> pairs;
} collected;

bool collect(btManifoldPoint&, const btCollisionObjectWrapper* first, int, int first_index,
             const btCollisionObjectWrapper*, int, int second_index) {
    if (first->getCollisionObject() == collected.object_a)
        collected.pairs.insert({first_index, second_index});
    else
        collected.pairs.insert({second_index, first_index});
    return false;
}

void find_triangles(const lists::mesh& a, const lists::mesh& b, lists::pair_file& out) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    btDbvtBroadphase broadphase;
    btCollisionWorld world(&dispatcher, &broadphase, &configuration);
    const mesh_shape shape_a(a), shape_b(b);
    btCollisionObject object_a, object_b;
    object_a.setCollisionShape(shape_a.get());
    object_b.setCollisionShape(shape_b.get());
    object_a.setCollisionFlags(btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    world.addCollisionObject(&object_a);
    world.addCollisionObject(&object_b);
    collected.object_a = &object_a;
    gContactAddedCallback = collect;
    world.performDiscreteCollisionDetection();
    for (const auto& [s, t] : collected.pairs) out.add(s, t);
}

}  // namespace

int main(int count, char** values) {
    const int version = btGetVersion();
    return lists::run(count, values, "Bullet " + std::to_string(version / 100) + "." + std::to_string(version % 100),
                      find_boxes, find_triangles);
}
