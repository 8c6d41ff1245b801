module;

#include "device.hpp"

module aabb.engines;

import aabb.base;
import :box_engine;
import :engine;

namespace aabb {

namespace {

using namespace embree;

class embree_boxes final : public box_engine {
public:
    explicit embree_boxes(RTCBuildQuality quality) : quality_(quality) {}

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        return {{"engine", bytes_of(boxes_) + bytes_of(ids_) + bytes_of(bounds_) + static_cast<std::size_t>(held_)}};
    }

private:
    /// There is nothing to gain, and Embree fails an assertion where so few boxes are all one point.
    static constexpr std::size_t few = 4;

    /// What a search has found so far: numbers of boxes, not yet ids.
    struct finding {
        std::vector<index_pair>& pairs;
        bool out_of_memory = false;
    };

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
        if (!scene_) begin();
        rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(bounds_.size()));
        rtcCommitGeometry(geometry_.get());
        rtcCommitScene(scene_.get());
        require_success(the_device());
    }

    void begin() {
        geometry_.reset(rtcNewGeometry(the_device(), RTC_GEOMETRY_TYPE_USER));
        require_success(the_device());
        rtcSetGeometryBuildQuality(geometry_.get(), quality_);
        rtcSetGeometryUserData(geometry_.get(), this);
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* asked) {
            *asked->bounds_o = static_cast<const embree_boxes*>(asked->geometryUserPtr)->bounds_[asked->primID];
        };
        rtcSetGeometryBoundsFunction(geometry_.get(), bounds_of_one, nullptr);
        scene_.reset(rtcNewScene(the_device()));
        require_success(the_device());
        // Embree heeds the quality of a geometry in scenes of low quality only.
        rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_LOW);
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC);
        rtcAttachGeometry(scene_.get(), geometry_.get());
    }

    void find(std::vector<index_pair>& pairs) override {
        if (ids_.size() <= few) return find_among_few(pairs);
        const auto known = static_cast<std::ptrdiff_t>(pairs.size());
        finding found{pairs};
        rtcCollide(scene_.get(), scene_.get(), collect, &found);
        require_success(the_device());
        if (found.out_of_memory) throw std::bad_alloc();
        // Only now: while it searches, Embree may still take denormals for zero.
        const auto apart = [&](index_pair p) { return !overlaps(boxes_[p.a], boxes_[p.b]); };
        pairs.erase(std::remove_if(pairs.begin() + known, pairs.end(), apart), pairs.end());
        for (auto p = pairs.begin() + known; p != pairs.end(); ++p) *p = {ids_[p->a], ids_[p->b]};
    }

    void find_among_few(std::vector<index_pair>& pairs) const {
        for (std::size_t j = 1; j < ids_.size(); ++j)
            for (std::size_t i = 0; i < j; ++i)
                if (overlaps(boxes_[i], boxes_[j])) pairs.push_back({ids_[i], ids_[j]});
    }

    /// Embree reports all pairs in the leaves that overlap, each from both sides. No exception may pass through it.
    static void collect(void* to, RTCCollision* collisions, unsigned count) {
        finding& found = *static_cast<finding*>(to);
        try {
            for (const RTCCollision& c : std::span(collisions, count))
                if (c.primID0 < c.primID1) found.pairs.push_back({c.primID0, c.primID1});
        } catch (const std::bad_alloc&) {
            found.out_of_memory = true;
        }
    }

    RTCBuildQuality quality_;
    std::ptrdiff_t held_ = 0;  // bytes that Embree holds
    std::vector<box> boxes_;
    std::vector<std::uint32_t> ids_;
    std::vector<RTCBounds> bounds_;
    geometry_pointer geometry_;
    scene_pointer scene_;
};

template <RTCBuildQuality Quality>
std::unique_ptr<global_stage> make_boxes() {
    return std::make_unique<embree_boxes>(Quality);
}

}  // namespace

engine embree_engine() {
    return {.name = "embree",
            .summary = "Embree's collision of a scene with itself, on a tree of low quality built anew in each frame",
            .exact = true,
            .boxes = make_boxes<RTC_BUILD_QUALITY_LOW>};
}

engine embree_refit_engine() {
    return {.name = "embree_refit",
            .summary = "the same on a good tree that is refitted while the number of boxes stays; for little motion",
            .exact = true,
            .boxes = make_boxes<RTC_BUILD_QUALITY_REFIT>};
}

}  // namespace aabb
