module;

#include "device.hpp"

module aabb.engines;

import :box_engine;
import :engine;

namespace aabb {

namespace {

using namespace embree;

class embree_boxes final : public box_engine {
public:
    explicit embree_boxes(RTCBuildQuality quality) : quality_(quality) {}

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        return {{"engine", bytes_of(boxes_, ids_, bounds_) + static_cast<std::size_t>(embree_bytes_)}};
    }

private:
    /// A brute-force threshold; Embree also fails an assertion if so few boxes are all the same point.
    static constexpr std::size_t brute_force_threshold = 4;

    /// Clamps the boxes to Embree's range, and builds or refits its tree of them if they are too many for brute force.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        ids_.assign(ids.begin(), ids.end());
        boxes_.clear();
        bounds_.clear();
        for (const std::uint32_t id : ids) {
            boxes_.push_back(boxes[id]);
            bounds_.push_back(clamped_to_embree(boxes[id]));
        }
        if (ids_.size() <= brute_force_threshold) return;
        const charge_to charging(embree_bytes_);  // counts Embree's allocations
        // Embree calls this for the bounds of one box, of index primID.
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* request) {
            *request->bounds_o = static_cast<const RTCBounds*>(request->geometryUserPtr)[request->primID];
        };
        if (!scene_.scene) scene_.begin(quality_, /*is_dynamic=*/true, bounds_of_one);
        scene_.commit(bounds_.data(), bounds_.size());
    }

    /// Collides Embree's scene of clamped boxes with itself, and keeps the pairs whose given boxes overlap.
    void find_pairs(std::vector<index_pair>& pairs) override {
        if (ids_.size() <= brute_force_threshold) return find_by_brute_force(pairs);
        const std::size_t known = pairs.size();  // pairs of earlier queries
        pair_collector collected{pairs};         // indices of boxes, not yet ids
        rtcCollide(scene_.scene.get(), scene_.scene.get(), collect, &collected);
        require_success(embree_device());
        collected.require_memory();
        // Filtered only after the search, during which Embree may flush denormals.
        collected.drop(known, [&](index_pair p) { return !overlaps(boxes_[p.a], boxes_[p.b]); });
        for (index_pair& p : std::span(pairs).subspan(known)) p = {ids_[p.a], ids_[p.b]};
    }

    void find_by_brute_force(std::vector<index_pair>& pairs) const {
        for (std::size_t j = 1; j < ids_.size(); ++j)
            for (std::size_t i = 0; i < j; ++i)
                if (overlaps(boxes_[i], boxes_[j])) pairs.push_back({ids_[i], ids_[j]});
    }

    /// Embree reports all pairs in overlapping leaves, in both orders.
    static void collect(void* collector, RTCCollision* collisions, unsigned count) {
        pair_collector& collected = *static_cast<pair_collector*>(collector);
        collected.append_safely([&] {
            for (const RTCCollision& c : std::span(collisions, count))
                if (c.primID0 < c.primID1) collected.pairs.push_back({c.primID0, c.primID1});
        });
    }

    RTCBuildQuality quality_;
    std::ptrdiff_t embree_bytes_ = 0;  // bytes that Embree holds
    std::vector<box> boxes_;
    std::vector<std::uint32_t> ids_;
    std::vector<RTCBounds> bounds_;
    user_scene scene_;
};

}  // namespace

engine embree_engine() {
    return {.name = "embree",
            .summary = "Embree's collision of a scene with itself, on a tree of low quality rebuilt in each frame",
            .boxes = make_stage<global_stage, embree_boxes, RTC_BUILD_QUALITY_LOW>};
}

engine embree_refit_engine() {
    return {
        .name = "embree_refit",
        .summary = "as embree, on a better tree, refitted while the number of boxes stays the same; for little motion",
        .boxes = make_stage<global_stage, embree_boxes, RTC_BUILD_QUALITY_REFIT>};
}

}  // namespace aabb
