module;
#include <algorithm>
#include <array>
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

/// Triangles, and their boxes in a scene.
class triangle_scene {
public:
    /// @param held where what Embree allocates is added up; must outlive this
    explicit triangle_scene(std::ptrdiff_t& held) : held_(&held) {}
    triangle_scene(triangle_scene&&) = default;
    triangle_scene& operator=(triangle_scene&&) = delete;
    triangle_scene(const triangle_scene&) = delete;
    triangle_scene& operator=(const triangle_scene&) = delete;
    ~triangle_scene() {
        const charge_to here(*held_);
        scene_.reset();
        geometry_.reset();
    }

    /// Anew; or refitted, where the quality is that and was before.
    /// @param m always the same mesh
    void build(RTCBuildQuality quality, const mesh& m, std::span<const vec3f> vertices) {
        triangles_.clear();
        triangles_.reserve(m.triangles.size());
        for (const auto& t : m.triangles) triangles_.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
        // For so few there is nothing to gain, and of low quality Embree fails an assertion where all are one point.
        if (triangles_.size() <= 4) quality = RTC_BUILD_QUALITY_MEDIUM;
        const charge_to here(*held_);
        if (quality != RTC_BUILD_QUALITY_REFIT || built_ != quality) begin(quality);
        built_.reset();  // what a failure leaves half-made is not refitted
        rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(triangles_.size()));
        rtcSetGeometryUserData(geometry_.get(), triangles_.data());
        rtcCommitGeometry(geometry_.get());
        rtcCommitScene(scene_.get());
        require_success(the_device());
        built_ = quality;
    }

    [[nodiscard]] std::span<const triangle3f> triangles() const { return triangles_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_of(triangles_); }
    [[nodiscard]] RTCScene get() const { return scene_.get(); }

private:
    void begin(RTCBuildQuality quality) {
        scene_.reset();
        geometry_.reset(rtcNewGeometry(the_device(), RTC_GEOMETRY_TYPE_USER));
        require_success(the_device());
        rtcSetGeometryBuildQuality(geometry_.get(), quality);
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* asked) {
            const auto* triangles = static_cast<const triangle3f*>(asked->geometryUserPtr);
            *asked->bounds_o = workable(bounds_of(triangles[asked->primID]));
        };
        rtcSetGeometryBoundsFunction(geometry_.get(), bounds_of_one, nullptr);
        scene_.reset(rtcNewScene(the_device()));
        require_success(the_device());
        // Embree heeds the quality of a geometry in scenes of low quality only, and can refit it in dynamic ones.
        const bool refits = quality == RTC_BUILD_QUALITY_REFIT;
        rtcSetSceneBuildQuality(scene_.get(), refits ? RTC_BUILD_QUALITY_LOW : quality);
        if (refits) rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC);
        rtcAttachGeometry(scene_.get(), geometry_.get());
    }

    std::ptrdiff_t* held_;
    std::optional<RTCBuildQuality> built_;
    std::vector<triangle3f> triangles_;
    geometry_pointer geometry_;
    scene_pointer scene_;
};

/// Embree knows no poses: the second mesh is moved, and its scene built or refitted, for every new one, and kept while
/// that stays.
class embree_meshes final : public mesh_engine {
public:
    explicit embree_meshes(RTCBuildQuality quality) : quality_(quality) {}

    std::uint32_t add_model(const mesh& m) override {
        require_ieee_arithmetic();
        require_valid(m);
        model made{&m, bounds_of(m), triangle_scene(*held_), {}, triangle_scene(*held_), {}};
        // Most meshes never deform, so only what is moved begins as one that refits.
        const bool refits = quality_ == RTC_BUILD_QUALITY_REFIT;
        made.still.build(refits ? RTC_BUILD_QUALITY_MEDIUM : quality_, m, m.vertices);
        models_.push_back(std::move(made));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    void refit(std::uint32_t number) override {
        model& changed = models_[number];
        changed.poses.reset();
        changed.fit.renew([&] {
            require_ieee_arithmetic();
            require_still_valid(*changed.source, changed.still.triangles().size());
            changed.bounds = bounds_of(*changed.source);
            changed.still.build(quality_, *changed.source, changed.source->vertices);
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
        for (const model& m : models_) all += bytes_of(m.still) + bytes_of(m.moved);
        return {{"engine", all}};
    }

private:
    struct model {
        const mesh* source;
        box bounds;
        triangle_scene still;
        mesh_fit fit;
        triangle_scene moved;                      // in the frame of another model
        std::optional<std::array<pose, 2>> poses;  // of that model and this one there; none where nothing is built
    };
    struct finding {
        std::vector<index_pair>& pairs;
        bool out_of_memory = false;
    };

    void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
              std::vector<index_pair>& pairs) override {
        require_ieee_arithmetic();
        const triangle_scene& a = models_[model_a].still;
        model& b = models_[model_b];
        models_[model_a].fit.require();
        b.fit.require();
        if (const std::array poses{pose_a, pose_b}; b.poses != poses) {
            b.poses.reset();
            b.moved.build(quality_, *b.source, moved_vertices(pose_a, pose_b, *b.source, b.bounds));
            b.poses = poses;
        }
        const auto known = static_cast<std::ptrdiff_t>(pairs.size());
        finding found{pairs};
        rtcCollide(a.get(), b.moved.get(), collect, &found);
        require_success(the_device());
        if (found.out_of_memory) throw std::bad_alloc();
        // Only now: while it searches, Embree may take denormals for zero.
        const devillers_guigue_triangle test;
        const auto apart = [&](index_pair p) { return !test.intersects(a.triangles()[p.a], b.moved.triangles()[p.b]); };
        pairs.erase(std::remove_if(pairs.begin() + known, pairs.end(), apart), pairs.end());
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
};

}  // namespace

std::unique_ptr<local_stage> make_embree_meshes() {
    return std::make_unique<embree_meshes>(RTC_BUILD_QUALITY_MEDIUM);
}

std::unique_ptr<local_stage> make_embree_meshes_low() {
    return std::make_unique<embree_meshes>(RTC_BUILD_QUALITY_LOW);
}

std::unique_ptr<local_stage> make_embree_meshes_refit() {
    return std::make_unique<embree_meshes>(RTC_BUILD_QUALITY_REFIT);
}

}  // namespace aabb
