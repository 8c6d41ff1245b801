module;
#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

module aabb.engines;

import :box_engine;
import :engine;

namespace aabb {

namespace {

/// Clamps coordinates to 1e37, so that no extent overflows; clamped boxes overlap wherever the given ones do.
box clamped(box b) {
    constexpr float most = 1e37F;
    for (int k = 0; k < 3; ++k) {
        b.min[k] = std::clamp(b.min[k], -most, most);
        b.max[k] = std::clamp(b.max[k], -most, most);
    }
    return b;
}

/// A world for Bullet's sweep, which cannot grow later: the bounds of all boxes, larger by half of their extent on each
/// side, so that objects can move. The terms far / 1024 and 1e-20 give an extent to flat bounds, at any coordinate.
box world_around(const box& bounds) {
    box world = bounds;
    for (int k = 0; k < 3; ++k) {
        const float far = std::max(std::abs(bounds.min[k]), std::abs(bounds.max[k]));
        const float margin = (bounds.max[k] - bounds.min[k]) / 2 + far / 1024 + 1e-20F;
        world.min[k] -= margin;
        world.max[k] += margin;
    }
    return world;
}

btVector3 corner_of(const vec3f& v) {
    return {v[0], v[1], v[2]};
}

/// Sweep and prune (Cohen et al., I-COLLIDE, 1995) on coordinates that Bullet quantises within a world box. Their order
/// is preserved, and lower ends precede upper ends in the same step: false positives, but no false negatives.
class bullet_sap final : public box_engine {
public:
    /// Bytes by the sizes of Bullet's types, as it reports none: handles, six ends per object, and the cache of pairs.
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::size_t total = bytes_of(boxes_, proxies_, objects_);
        if (sweep_) {
            using handle = bt32BitAxisSweep3::Handle;
            using edge = bt32BitAxisSweep3::Edge;
            const auto pairs = static_cast<std::size_t>(sweep_->getOverlappingPairCache()->getNumOverlappingPairs());
            total += objects_.size() * (sizeof(handle) + 6 * sizeof(edge));
            total += pairs * (sizeof(btBroadphasePair) + 2 * sizeof(int));  // with the hash table
        }
        return {{"engine", total}};
    }

private:
    /// Moves the boxes in Bullet's sweep. A new sweep replaces it for more objects, or if a box leaves its world.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        boxes_.assign(boxes.begin(), boxes.end());
        box bounds = empty_box();
        for (const std::uint32_t id : ids) bounds = merged(bounds, clamped(boxes[id]));
        if (proxies_.size() < boxes.size() || (!ids.empty() && !contains(world_, bounds))) renew(bounds, boxes.size());
        drop_absent(proxies_, [&](btBroadphaseProxy* proxy) { sweep_->destroyProxy(proxy, nullptr); });
        for (const std::uint32_t id : ids) move_or_add(id, clamped(boxes[id]));
    }

    /// Makes an empty sweep for this number of objects, in a world around `bounds`: Bullet's sweep cannot grow.
    void renew(const box& bounds, std::size_t objects) {
        world_ = world_around(bounds);
        proxies_.assign(objects, nullptr);
        objects_.assign(objects + 1, 0);  // by number of the proxy, from 1
        // The last argument leaves out the tree that Bullet would keep for ray casts.
        sweep_ = std::make_unique<bt32BitAxisSweep3>(corner_of(world_.min), corner_of(world_.max),
                                                     static_cast<unsigned>(objects), nullptr, true);
    }

    /// Moves the object's proxy in Bullet's sweep, or creates it. Group and mask 1 admit all pairs.
    void move_or_add(std::uint32_t id, const box& b) {
        btBroadphaseProxy*& proxy = proxies_[id];
        if (proxy) {
            sweep_->setAabb(proxy, corner_of(b.min), corner_of(b.max), nullptr);
        } else {
            proxy = sweep_->createProxy(corner_of(b.min), corner_of(b.max), /*shapeType=*/0, nullptr, /*group=*/1,
                                        /*mask=*/1, nullptr);
            objects_[number_of(proxy)] = id;
        }
    }

    /// Appends the pairs in Bullet's cache whose boxes overlap: Bullet compares larger, quantised boxes.
    void find_pairs(std::vector<index_pair>& pairs) override {
        if (!sweep_) return;
        btOverlappingPairCache& cache = *sweep_->getOverlappingPairCache();
        const auto count = static_cast<std::size_t>(cache.getNumOverlappingPairs());
        if (count == 0) return;
        for (const btBroadphasePair& overlap : std::span(cache.getOverlappingPairArrayPtr(), count)) {
            const std::uint32_t a = objects_[number_of(overlap.m_pProxy0)];
            const std::uint32_t b = objects_[number_of(overlap.m_pProxy1)];
            if (overlaps(boxes_[a], boxes_[b])) pairs.push_back(ordered_pair(a, b));
        }
    }

    /// Bullet numbers proxies from 1.
    static std::size_t number_of(const btBroadphaseProxy* proxy) { return static_cast<std::size_t>(proxy->m_uniqueId); }

    std::vector<box> boxes_;
    std::vector<btBroadphaseProxy*> proxies_;  // by id; null where absent
    std::vector<std::uint32_t> objects_;       // ids by number of the proxy
    box world_ = empty_box();
    std::unique_ptr<bt32BitAxisSweep3> sweep_;
};

}  // namespace

engine bullet_sap_engine() {
    return {.name = "bullet_sap",
            .summary = "Bullet's incremental sweep on three axes; quadratic in the first frame and with much motion",
            .boxes = make_stage<global_stage, bullet_sap>};
}

}  // namespace aabb
