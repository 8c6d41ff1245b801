module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "../embree/device.hpp"

module aabb.engines;

import aabb.base;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import aabb.triangle.devillers_guigue;
import :mesh_engine;

namespace aabb {

namespace {

using namespace embree;

/// The boxes of triangles in a scene.
class triangle_scene {
public:
    /// @param held where what Embree allocates is added up; must outlive this
    triangle_scene(RTCBuildQuality quality, std::ptrdiff_t& held) : quality_(quality), held_(&held) {}
    triangle_scene(triangle_scene&&) = default;
    triangle_scene& operator=(triangle_scene&&) = delete;
    triangle_scene(const triangle_scene&) = delete;
    triangle_scene& operator=(const triangle_scene&) = delete;
    ~triangle_scene() {
        const charge_to here(*held_);
        scene_.reset();
        geometry_.reset();
    }

    void build(std::span<const triangle3f> triangles) {
        bounds_.clear();
        for (const triangle3f& t : triangles) bounds_.push_back(workable(bounds_of(t)));
        const charge_to here(*held_);
        scene_.reset();
        geometry_.reset(rtcNewGeometry(the_device(), RTC_GEOMETRY_TYPE_USER));
        require_success(the_device());
        rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(bounds_.size()));
        rtcSetGeometryUserData(geometry_.get(), bounds_.data());
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* asked) {
            *asked->bounds_o = static_cast<const RTCBounds*>(asked->geometryUserPtr)[asked->primID];
        };
        rtcSetGeometryBoundsFunction(geometry_.get(), bounds_of_one, nullptr);
        rtcCommitGeometry(geometry_.get());
        scene_.reset(rtcNewScene(the_device()));
        require_success(the_device());
        rtcSetSceneBuildQuality(scene_.get(), quality_);
        rtcAttachGeometry(scene_.get(), geometry_.get());
        rtcCommitScene(scene_.get());
        require_success(the_device());
        // Needed while it builds only.
        aabb::release(bounds_);
    }

    [[nodiscard]] RTCScene get() const { return scene_.get(); }

private:
    RTCBuildQuality quality_;
    std::ptrdiff_t* held_;
    std::vector<RTCBounds> bounds_;
    geometry_pointer geometry_;
    scene_pointer scene_;
};

/// Embree knows no poses: the second mesh is moved and built anew for every new one, and kept while that stays.
class embree_meshes final : public mesh_engine {
public:
    explicit embree_meshes(RTCBuildQuality quality) : quality_(quality) {}

    std::uint32_t add_model(const mesh& m) override {
        require_ieee_arithmetic();
        require_valid(m);
        model made{&m, triangles_of(m), triangle_scene(quality_, *held_), {}};
        made.scene.build(made.triangles);
        models_.push_back(std::move(made));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    void refit(std::uint32_t number) override {
        model& changed = models_[number];
        moved_.reset();
        changed.fit.renew([&] {
            require_ieee_arithmetic();
            require_still_valid(*changed.source, changed.triangles.size());
            changed.triangles = triangles_of(*changed.source);
            changed.scene.build(changed.triangles);
        });
    }

    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        std::vector<index_pair> pairs;
        find(model_a, pose_a, model_b, pose_b, pairs);
        if (pairs.empty()) return std::nullopt;
        return pairs.front();
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::size_t all = static_cast<std::size_t>(*held_);
        for (const model& m : models_) all += bytes_of(m.triangles);
        if (moved_) all += bytes_of(moved_->triangles);
        return {{"engine", all}};
    }

private:
    struct model {
        const mesh* source;
        std::vector<triangle3f> triangles;
        triangle_scene scene;
        mesh_fit fit;
    };
    /// B in A's frame.
    struct moved_model {
        std::uint32_t model;
        pose pose_a;
        pose pose_b;
        std::vector<triangle3f> triangles;
        triangle_scene scene;
    };
    struct finding {
        std::vector<index_pair>& pairs;
        bool out_of_memory = false;
    };

    [[nodiscard]] static std::vector<triangle3f> triangles_of(const mesh& m) {
        std::vector<triangle3f> all;
        all.reserve(m.triangles.size());
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) all.push_back(m.triangle(t));
        return all;
    }

    void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
              std::vector<index_pair>& pairs) override {
        require_ieee_arithmetic();
        models_[model_a].fit.require();
        models_[model_b].fit.require();
        if (!moved_ || moved_->model != model_b || moved_->pose_a != pose_a || moved_->pose_b != pose_b)
            move(model_b, pose_a, pose_b);
        const auto known = static_cast<std::ptrdiff_t>(pairs.size());
        finding found{pairs};
        rtcCollide(models_[model_a].scene.get(), moved_->scene.get(), collect, &found);
        require_success(the_device());
        if (found.out_of_memory) throw std::bad_alloc();
        // Only now: while it searches, Embree may take denormals for zero.
        const devillers_guigue_triangle test;
        const auto apart = [&](index_pair p) {
            return !test.intersects(models_[model_a].triangles[p.a], moved_->triangles[p.b]);
        };
        pairs.erase(std::remove_if(pairs.begin() + known, pairs.end(), apart), pairs.end());
    }

    void move(std::uint32_t number, const pose& pose_a, const pose& pose_b) {
        const model& b = models_[number];
        const relative_pose to_a(pose_a, pose_b, bounds_of(*b.source));
        moved_.reset();
        moved_model made{number, pose_a, pose_b, b.triangles, triangle_scene(quality_, *held_)};
        for (triangle3f& t : made.triangles) t = to_a(t);
        made.scene.build(made.triangles);
        moved_.emplace(std::move(made));
    }

    /// No exception may pass through Embree.
    static void collect(void* to, RTCCollision* collisions, unsigned count) {
        finding& found = *static_cast<finding*>(to);
        try {
            for (const RTCCollision& c : std::span(collisions, count)) found.pairs.push_back({c.primID0, c.primID1});
        } catch (const std::bad_alloc&) {
            found.out_of_memory = true;
        }
    }

    RTCBuildQuality quality_;
    std::unique_ptr<std::ptrdiff_t> held_ = std::make_unique<std::ptrdiff_t>(0);  // bytes that Embree holds
    std::vector<model> models_;
    std::optional<moved_model> moved_;
};

}  // namespace

std::unique_ptr<local_stage> make_embree_meshes(bool low) {
    return std::make_unique<embree_meshes>(low ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
}

}  // namespace aabb
