module;

#include "device.hpp"

module aabb.engines;

import aabb.triangle.devillers_guigue;
import :box_engine;
import :engine;
import :mesh_engine;

namespace aabb {

namespace {

using namespace embree;

/// Triangles, and a scene of their boxes.
class triangle_scene {
public:
    triangle_scene() = default;
    triangle_scene(triangle_scene&&) = default;  // movable only
    ~triangle_scene() {
        if (!embree_bytes_) return;  // moved away, or never built
        const charge_to charging(*embree_bytes_);
        scene_ = user_scene();
    }

    /// Builds the scene, or refits it if both this quality and the previous one are for refitting.
    /// @param m always the same mesh
    /// @param vertices of the mesh, perhaps transformed
    /// @param embree_bytes the account of Embree's allocations; always the same
    void build(RTCBuildQuality quality, const mesh& m, std::span<const vec3f> vertices,
               const std::shared_ptr<std::ptrdiff_t>& embree_bytes) {
        embree_bytes_ = embree_bytes;
        triangles_.clear();
        triangles_.reserve(m.triangles.size());
        for (const auto& t : m.triangles) triangles_.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
        // With low quality, Embree fails an assertion if so few boxes are all the same point.
        if (triangles_.size() <= 4) quality = RTC_BUILD_QUALITY_MEDIUM;
        const charge_to charging(*embree_bytes_);  // counts Embree's allocations
        const bool refits = quality == RTC_BUILD_QUALITY_REFIT;
        // Embree calls this for the bounds of one triangle, of index primID.
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* request) {
            const auto* triangles = static_cast<const triangle3f*>(request->geometryUserPtr);
            *request->bounds_o = clamped_to_embree(bounds_of(triangles[request->primID]));
        };
        if (!refits || built_ != quality) scene_.begin(quality, refits, bounds_of_one);
        built_.reset();  // so that a failed build is not refitted
        scene_.commit(triangles_.data(), triangles_.size());
        built_ = quality;
    }

    [[nodiscard]] bool is_new() const { return !embree_bytes_; }
    [[nodiscard]] std::span<const triangle3f> triangles() const { return triangles_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_of(triangles_); }
    [[nodiscard]] RTCScene get() const { return scene_.scene.get(); }

private:
    std::shared_ptr<std::ptrdiff_t> embree_bytes_;
    std::optional<RTCBuildQuality> built_;
    std::vector<triangle3f> triangles_;
    user_scene scene_;
};

struct embree_model : engine_model {
    triangle_scene local{};
    triangle_scene transformed{};  ///< in the frame of another model
    posed_pair poses{};            ///< of that model and this one

    [[nodiscard]] std::size_t bytes() const { return bytes_of(local, transformed); }
};

/// Embree has no poses: for each new pose, the second mesh is transformed and its scene rebuilt or refitted.
class embree_meshes final : public model_engine<embree_model> {
public:
    explicit embree_meshes(RTCBuildQuality quality) : quality_(quality) {}

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts = model_engine::bytes();
        parts[0].bytes += static_cast<std::size_t>(*embree_bytes_);
        return parts;
    }

private:
    void update_model(embree_model& changed) override {
        changed.poses.forget();
        // Most meshes never deform, so that only transformed meshes start with a refittable scene.
        const bool is_first = changed.local.is_new() && quality_ == RTC_BUILD_QUALITY_REFIT;
        changed.local.build(is_first ? RTC_BUILD_QUALITY_MEDIUM : quality_, *changed.source, changed.source->vertices,
                            embree_bytes_);
    }

    [[nodiscard]] std::optional<index_pair> any_pair(const model_query& q) override {
        std::vector<index_pair> pairs;
        append_pairs(q, pairs);
        if (pairs.empty()) return std::nullopt;
        return pairs.front();
    }

    /// Tests the pairs of triangles whose boxes overlap by Embree. It has no poses, so it gets B transformed into A's
    /// frame, a scene kept while neither pose changes.
    void append_pairs(const model_query& q, std::vector<index_pair>& pairs) override {
        q.b.poses.renew(q.pose_a, q.pose_b, [&] {
            q.b.transformed.build(quality_, *q.b.source,
                                  transformed_vertices(*q.a.source, q.pose_a, *q.b.source, q.pose_b, q.b.bounds),
                                  embree_bytes_);
        });
        const std::size_t known = pairs.size();  // pairs of earlier queries
        pair_collector collected{pairs};
        rtcCollide(q.a.local.get(), q.b.transformed.get(), collect, &collected);
        require_success(embree_device());
        collected.require_memory();  // the callback must not throw within Embree, so it only records that it failed
        // Tested only after the search, during which Embree may flush denormals.
        const devillers_guigue_triangle test;
        const std::span<const triangle3f> of_a = q.a.local.triangles();
        const std::span<const triangle3f> of_b = q.b.transformed.triangles();
        collected.drop(known, [&](index_pair p) { return !test.intersects(of_a[p.a], of_b[p.b]); });
    }

    static void collect(void* collector, RTCCollision* collisions, unsigned count) {
        pair_collector& collected = *static_cast<pair_collector*>(collector);
        collected.append_safely([&] {
            for (const RTCCollision& c : std::span(collisions, count))
                collected.pairs.push_back({c.primID0, c.primID1});
        });
    }

    RTCBuildQuality quality_;
    std::shared_ptr<std::ptrdiff_t> embree_bytes_ = std::make_unique<std::ptrdiff_t>(0);  // bytes that Embree holds
};

template <RTCBuildQuality Quality>
engine engine_of_quality(const char* name, const char* summary) {
    return {
        .name = name, .summary = summary, .exact = false, .meshes = make_stage<local_stage, embree_meshes, Quality>};
}

}  // namespace

engine embree_meshes_engine() {
    return engine_of_quality<RTC_BUILD_QUALITY_MEDIUM>(
        "embree_meshes",
        "Embree's collision of two scenes of medium quality, rebuilt for each new pose, with Devillers and Guigue's "
        "test in double");
}

engine embree_meshes_low_engine() {
    return engine_of_quality<RTC_BUILD_QUALITY_LOW>(
        "embree_meshes_low", "as embree_meshes, with scenes of low quality, which are built faster");
}

engine embree_meshes_refit_engine() {
    return engine_of_quality<RTC_BUILD_QUALITY_REFIT>(
        "embree_meshes_refit",
        "as embree_meshes, with scenes that are refitted for each new pose and when vertices move");
}

}  // namespace aabb
