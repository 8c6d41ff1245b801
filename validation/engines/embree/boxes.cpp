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
        return {{"engine", bytes_of(boxes_, ids_, bounds_) + static_cast<std::size_t>(held_)}};
    }

private:
    /// A brute-force threshold; Embree also fails an assertion if so few boxes are all the same point.
    static constexpr std::size_t few = 4;

    void take(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        ids_.assign(ids.begin(), ids.end());
        boxes_.clear();
        bounds_.clear();
        for (const std::uint32_t id : ids) {
            boxes_.push_back(boxes[id]);
            bounds_.push_back(workable(boxes[id]));
        }
        if (ids_.size() <= few) return;
        const charge_to here(held_);
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* request) {
            *request->bounds_o = static_cast<const RTCBounds*>(request->geometryUserPtr)[request->primID];
        };
        if (!scene_.scene) scene_.begin(quality_, true, bounds_of_one);
        scene_.commit(bounds_.data(), bounds_.size());
    }

    void find(std::vector<index_pair>& pairs) override {
        if (ids_.size() <= few) return find_among_few(pairs);
        const std::size_t known = pairs.size();
        finding collected{pairs};  // indices of boxes, not yet ids
        rtcCollide(scene_.scene.get(), scene_.scene.get(), collect, &collected);
        require_success(the_device());
        collected.require_all();
        // Filtered only after the search, during which Embree may flush denormals.
        collected.drop(known, [&](index_pair p) { return !overlaps(boxes_[p.a], boxes_[p.b]); });
        for (index_pair& p : std::span(pairs).subspan(known)) p = {ids_[p.a], ids_[p.b]};
    }

    void find_among_few(std::vector<index_pair>& pairs) const {
        for (std::size_t j = 1; j < ids_.size(); ++j)
            for (std::size_t i = 0; i < j; ++i)
                if (overlaps(boxes_[i], boxes_[j])) pairs.push_back({ids_[i], ids_[j]});
    }

    /// Embree reports all pairs in overlapping leaves, in both orders.
    static void collect(void* to, RTCCollision* collisions, unsigned count) {
        finding& collected = *static_cast<finding*>(to);
        collected.note([&] {
            for (const RTCCollision& c : std::span(collisions, count))
                if (c.primID0 < c.primID1) collected.pairs.push_back({c.primID0, c.primID1});
        });
    }

    RTCBuildQuality quality_;
    std::ptrdiff_t held_ = 0;  // bytes that Embree holds
    std::vector<box> boxes_;
    std::vector<std::uint32_t> ids_;
    std::vector<RTCBounds> bounds_;
    user_scene scene_;
};

}  // namespace

engine embree_engine() {
    return {.name = "embree",
            .summary = "Embree's collision of a scene with itself, on a tree of low quality rebuilt in each frame",
            .boxes = made<global_stage, embree_boxes, RTC_BUILD_QUALITY_LOW>};
}

engine embree_refit_engine() {
    return {
        .name = "embree_refit",
        .summary = "as embree, on a better tree, refitted while the number of boxes stays the same; for little motion",
        .boxes = made<global_stage, embree_boxes, RTC_BUILD_QUALITY_REFIT>};
}

}  // namespace aabb
