#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

namespace aabb::embree {

struct release {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using scene_pointer = std::unique_ptr<RTCSceneTy, release>;
using geometry_pointer = std::unique_ptr<RTCGeometryTy, release>;

/// Embree's calls do not throw; this throws the first error since the last call.
inline void require_success(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree fails with its error " + std::to_string(error));
}

/// The account to which Embree's allocations are charged; null if they are not counted.
inline thread_local std::ptrdiff_t* charged_account = nullptr;

class charge_to {
public:
    explicit charge_to(std::ptrdiff_t& account) { charged_account = &account; }
    charge_to(const charge_to&) = delete;
    charge_to& operator=(const charge_to&) = delete;
    ~charge_to() { charged_account = nullptr; }
};

/// The only device of the process, which is never released. Releasing the last device would reset Embree's limit of one
/// thread, and a second thread would disturb later timings.
inline RTCDevice embree_device() {
    static const RTCDevice only_device = [] {
        const RTCDevice device = rtcNewDevice("threads=1");
        require_success(device);
        const auto count_bytes = [](void*, std::ptrdiff_t bytes, bool) {
            if (charged_account) *charged_account += bytes;
            return true;
        };
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, nullptr);
        return device;
    }();
    return only_device;
}

/// A scene with a single geometry of user-defined boxes.
struct user_scene {
    geometry_pointer geometry;
    scene_pointer scene;

    /// Creates an empty scene; `bounds` returns the bounds of a box.
    void begin(RTCBuildQuality quality, bool is_dynamic, RTCBoundsFunction bounds) {
        scene.reset();
        geometry.reset(rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER));
        require_success(embree_device());
        rtcSetGeometryBuildQuality(geometry.get(), quality);
        rtcSetGeometryBoundsFunction(geometry.get(), bounds, nullptr);
        scene.reset(rtcNewScene(embree_device()));
        require_success(embree_device());
        // Embree respects the quality of a geometry only in low-quality scenes, and refits only in dynamic scenes.
        rtcSetSceneBuildQuality(scene.get(), quality == RTC_BUILD_QUALITY_REFIT ? RTC_BUILD_QUALITY_LOW : quality);
        if (is_dynamic) rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_DYNAMIC);
        rtcAttachGeometry(scene.get(), geometry.get());
    }

    /// @param data passed to the bounds function
    void commit(void* data, std::size_t boxes) {
        rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(boxes));
        rtcSetGeometryUserData(geometry.get(), data);
        rtcCommitGeometry(geometry.get());
        rtcCommitScene(scene.get());
        require_success(embree_device());
    }
};

/// Embree builds with flushed denormals and ignores boxes beyond 1.844e18. Clamping to its range preserves the order of
/// coordinates, though not strictly, so that there are no false negatives.
inline float clamped_to_embree(float x) {
    constexpr float most = 1e18F;
    return std::abs(x) < std::numeric_limits<float>::min() ? 0 : std::clamp(x, -most, most);
}

/// A template because this header cannot import our box.
template <class Box>
RTCBounds clamped_to_embree(const Box& b) {
    return {clamped_to_embree(b.min[0]), clamped_to_embree(b.min[1]), clamped_to_embree(b.min[2]), 0,
            clamped_to_embree(b.max[0]), clamped_to_embree(b.max[1]), clamped_to_embree(b.max[2]), 0};
}

}  // namespace aabb::embree
