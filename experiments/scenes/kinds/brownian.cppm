module;
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:brownian;

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabblab.files;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes that drift in a cube. As in Broadmark's Brownian scenes, they move at up to 0.75 of the world's side a
/// second, a frame is 1/30 s, and one hundredth of them change direction every frame.
class brownian final : public aabb::box_scene {
public:
    static constexpr std::string_view name = "brownian";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube with reflecting walls; a hundredth of them turn every frame";

    struct config {
        std::uint32_t objects = 1000;
        std::uint32_t frames = 20;
        /// Volume of all objects over the volume of the world.
        double density = 0.1;
        /// The longest way an object moves in a frame, in edges of a cube. auto: 0.75 / 30 of the world's side.
        std::optional<double> displacement;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"objects", &config::objects, 0U, 0x7fffffffU, "how many cubes"},
        aabb::integer_parameter{"frames", &config::frames, 0U, 0x7ffffffeU, "frames after the first one"},
        aabb::number_parameter{"density", &config::density, 1e-30, 1e6, "volume of the cubes over that of the world"},
        aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                               "the longest way of a cube in a frame, in edges; auto: 1/40 of the world's side"}};

    brownian(const config& c, std::uint64_t seed)
        : frames_(std::size_t{c.frames} + 1), random_(seed), points_(drifting(c, random_)) {}

    [[nodiscard]] std::size_t objects() const override { return points_.size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_; }

    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == frames_) return false;
        if (frame_++ > 0) points_.advance(random_);
        boxes.resize(points_.size());
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                boxes[i].min[k] = static_cast<float>(points_[i][k]);
                boxes[i].max[k] = static_cast<float>(points_[i][k] + 1);
            }
        return true;
    }

private:
    static drifting_points drifting(const config& c, random_source& random) {
        require_memory("a brownian scene of " + std::to_string(c.objects) + " objects",
                       c.objects * (drifting_points::bytes_each + sizeof(aabb::box)));
        const double side = cube_root(c.objects / c.density);
        return {c.objects, side - 1, c.displacement.value_or(0.75 * side / 30), random};
    }

    std::size_t frames_;
    std::size_t frame_ = 0;
    random_source random_;
    drifting_points points_;
};

}  // namespace aabblab
