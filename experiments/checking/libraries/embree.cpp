// Pairs by Embree: rtcCollide of a scene of boxes with itself. Of triangles it finds candidates only, as it has no test
// of two triangles.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "exchange.hpp"

namespace {

/// An Embree scene with a user geometry of boxes.
class box_scene {
public:
    box_scene(RTCDevice device, std::vector<lists::box> boxes) : boxes_(std::move(boxes)), scene_(rtcNewScene(device)) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes_.size()));
        rtcSetGeometryUserData(geometry, boxes_.data());
        const auto bounds_of_one = [](const RTCBoundsFunctionArguments* request) {
            const lists::box& b = static_cast<const lists::box*>(request->geometryUserPtr)[request->primID];
            *request->bounds_o = {b.min[0], b.min[1], b.min[2], 0, b.max[0], b.max[1], b.max[2], 0};
        };
        rtcSetGeometryBoundsFunction(geometry, bounds_of_one, nullptr);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    box_scene(const box_scene&) = delete;
    box_scene& operator=(const box_scene&) = delete;
    ~box_scene() { rtcReleaseScene(scene_); }

    [[nodiscard]] RTCScene get() const { return scene_; }

private:
    std::vector<lists::box> boxes_;
    RTCScene scene_;
};

using pairs = std::vector<std::array<unsigned, 2>>;

/// Receives collisions, in both orders if a scene collides with itself.
void collect(void* data, RTCCollision* collisions, unsigned count) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<pairs*>(data)->push_back({collisions[i].primID0, collisions[i].primID1});
}

/// Embree's threads would call the callback at the same time.
RTCDevice device() {
    static const RTCDevice only = rtcNewDevice("threads=1");
    return only;
}

void find_boxes(const std::vector<std::vector<lists::box>>& frames, lists::pair_file& out) {
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        const box_scene scene(device(), frames[frame]);
        pairs collected;
        rtcCollide(scene.get(), scene.get(), collect, &collected);
        for (const auto& [a, b] : collected)
            if (a < b) out.add(frame, a, b);
    }
}

/// The boxes of the triangles, rounded to float.
std::vector<lists::box> boxes_of(const lists::mesh& m) {
    std::vector<lists::box> boxes;
    for (const auto& t : m.triangles) {
        lists::box& b = boxes.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = [&](int corner) { return m.vertices[static_cast<std::size_t>(corner)][k]; };
            b.min[k] = static_cast<float>(std::min({at(t[0]), at(t[1]), at(t[2])}));
            b.max[k] = static_cast<float>(std::max({at(t[0]), at(t[1]), at(t[2])}));
        }
    }
    return boxes;
}

void find_triangles(const lists::mesh& a, const lists::mesh& b, lists::pair_file& out) {
    const box_scene scene_a(device(), boxes_of(a)), scene_b(device(), boxes_of(b));
    pairs collected;
    rtcCollide(scene_a.get(), scene_b.get(), collect, &collected);
    for (const auto& [s, t] : collected) out.add(s, t);
}

}  // namespace

int main(int count, char** values) {
    return lists::run(count, values, "Embree " RTC_VERSION_STRING, find_boxes, find_triangles);
}
