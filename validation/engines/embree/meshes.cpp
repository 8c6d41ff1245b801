module;

#include "device.hpp"

module aabb.engines;

import aabb.base;
import aabb.local_detection;
import aabb.triangle.devillers_guigue;
import :engine;
import :mesh_engine;

namespace aabb {

namespace {

using namespace embree;

/// Triangles, and their boxes in a scene.
class triangle_scene {
public:
    /// @param held where what Embree allocates is added up
    explicit triangle_scene(std::shared_ptr<std::ptrdiff_t> held) : held_(std::move(held)) {}
    triangle_scene(triangle_scene&&) = default;
    triangle_scene& operator=(triangle_scene&&) = delete;
    triangle_scene(const triangle_scene&) = delete;
    triangle_scene& operator=(const triangle_scene&) = delete;
    ~triangle_scene() {
        if (!held_) return;  // moved away
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

    std::shared_ptr<std::ptrdiff_t> held_;
    std::optional<RTCBuildQuality> built_;
    std::vector<triangle3f> triangles_;
    geometry_pointer geometry_;
    scene_pointer scene_;
};

struct embree_model : engine_model {
    triangle_scene still;
    triangle_scene moved;                        ///< in the frame of another model
    std::optional<std::array<pose, 2>> poses{};  ///< of that model and this one there; none where nothing is built

    [[nodiscard]] std::size_t bytes() const { return bytes_of(still) + bytes_of(moved); }
};

/// Embree knows no poses: the second mesh is moved, and its scene built or refitted, for every new one, and kept while
/// that stays.
class embree_meshes final : public model_engine<embree_model> {
public:
    explicit embree_meshes(RTCBuildQuality quality) : quality_(quality) {}

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> all = model_engine::bytes();
        all[0].bytes += static_cast<std::size_t>(*held_);
        return all;
    }

private:
    /// What a search has found so far.
    struct finding {
        std::vector<index_pair>& pairs;
        bool out_of_memory = false;
    };

    [[nodiscard]] embree_model model_of(const engine_model& base) override {
        embree_model made{base, triangle_scene(held_), triangle_scene(held_)};
        // Most meshes never deform, so only what is moved begins as one that refits.
        const bool refits = quality_ == RTC_BUILD_QUALITY_REFIT;
        made.still.build(refits ? RTC_BUILD_QUALITY_MEDIUM : quality_, *base.source, base.source->vertices);
        return made;
    }

    void follow(embree_model& changed) override {
        changed.poses.reset();
        changed.still.build(quality_, *changed.source, changed.source->vertices);
    }

    [[nodiscard]] std::optional<index_pair> any_pair(const asked& q) override {
        std::vector<index_pair> pairs;
        append_pairs(q, pairs);
        if (pairs.empty()) return std::nullopt;
        return pairs.front();
    }

    void append_pairs(const asked& q, std::vector<index_pair>& pairs) override {
        if (const std::array poses{q.pose_a, q.pose_b}; q.b.poses != poses) {
            q.b.poses.reset();
            q.b.moved.build(quality_, *q.b.source, moved_vertices(q.pose_a, q.pose_b, *q.b.source, q.b.bounds));
            q.b.poses = poses;
        }
        const auto known = static_cast<std::ptrdiff_t>(pairs.size());
        finding found{pairs};
        rtcCollide(q.a.still.get(), q.b.moved.get(), collect, &found);
        require_success(the_device());
        if (found.out_of_memory) throw std::bad_alloc();
        // Only now: while it searches, Embree may take denormals for zero.
        const devillers_guigue_triangle test;
        const std::span<const triangle3f> of_a = q.a.still.triangles();
        const std::span<const triangle3f> of_b = q.b.moved.triangles();
        const auto apart = [&](index_pair p) { return !test.intersects(of_a[p.a], of_b[p.b]); };
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
    std::shared_ptr<std::ptrdiff_t> held_ = std::make_unique<std::ptrdiff_t>(0);  // bytes that Embree holds
};

template <RTCBuildQuality Quality>
std::unique_ptr<local_stage> make_meshes() {
    return std::make_unique<embree_meshes>(Quality);
}

}  // namespace

engine embree_meshes_engine() {
    return {.name = "embree_meshes",
            .summary =
                "Embree's collision of two scenes of medium quality, built anew for each new pose, with "
                "Devillers and Guigue's test in double",
            .meshes = make_meshes<RTC_BUILD_QUALITY_MEDIUM>};
}

engine embree_meshes_low_engine() {
    return {.name = "embree_meshes_low",
            .summary = "as embree_meshes, with scenes of low quality, which are built faster",
            .meshes = make_meshes<RTC_BUILD_QUALITY_LOW>};
}

engine embree_meshes_refit_engine() {
    return {.name = "embree_meshes_refit",
            .summary = "as embree_meshes, with scenes that are refitted for each new pose and when vertices move",
            .meshes = make_meshes<RTC_BUILD_QUALITY_REFIT>};
}

}  // namespace aabb
