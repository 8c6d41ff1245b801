module;
#include <Eigen/Core>

module aabblab.scenes:far;

import :boxes;

namespace aabblab {

/// Unit cubes far from the origin, where floats are coarse: different bounds become equal, and separate cubes touch.
class far final : public drifting_boxes {
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

    far(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed), distance_(c.distance) { drift(c); }

private:
    [[nodiscard]] aabb::box box_at(const Eigen::Vector3d& point, std::size_t) const override {
        return cube_at(point + Eigen::Vector3d::Constant(distance_), 1);
    }

    double distance_;
};

}  // namespace aabblab
