module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

module aabblab.scenes:far;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes far from the origin, where floats lie far apart: ends that were different become equal, and cubes that
/// were apart touch.
class far final : public generated_boxes {
public:
    static constexpr std::string_view name = "far";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube far from the origin, where their coordinates are rounded";

    struct config : motion_config {
        double distance = 1e4;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"distance", &config::distance, 0.0, 1e9,
                                                             "of the world from the origin, along each axis"}});

    far(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each),
          distance_(c.distance),
          corners_(drifting_corners(c, 3, random_)) {}

private:
    void advance() override { corners_.advance(random_); }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = cube_at(corners_[i] + aabb::vec3d{distance_, distance_, distance_}, 1);
    }

    double distance_;
    drifting_points corners_;
};

}  // namespace aabblab
