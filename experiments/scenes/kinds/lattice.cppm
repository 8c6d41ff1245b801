module;
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:lattice;

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabblab.files;

namespace aabblab {

/// Unit cubes side by side on an integer lattice: each touches its neighbours, corners included, without a gap, so
/// every answer hangs on closed comparisons, and sorted lists are full of ties. All move along the diagonal by the same
/// step; coordinates that are equal stay equal, whatever the step is rounded to.
class lattice final : public aabb::box_scene {
public:
    static constexpr std::string_view name = "lattice";
    static constexpr std::string_view summary =
        "unit cubes that touch on an integer lattice and move as one: nothing but ties; the seed does not matter";

    struct config {
        std::uint32_t objects = 1000;
        std::uint32_t frames = 20;
        /// How far all cubes move along each axis in a frame, in edges.
        double displacement = 0.25;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"objects", &config::objects, 0U, 0x7fffffffU, "how many cubes"},
        aabb::integer_parameter{"frames", &config::frames, 0U, 0x7ffffffeU, "frames after the first one"},
        aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                               "the way of all cubes along each axis in a frame, in edges"}};

    lattice(const config& c, std::uint64_t) : config_(c) {
        require_memory("a lattice of " + std::to_string(c.objects) + " objects", double{sizeof(aabb::box)} * c.objects);
        while (side_ * side_ * side_ < c.objects) ++side_;
    }

    [[nodiscard]] std::size_t objects() const override { return config_.objects; }
    [[nodiscard]] std::size_t frames() const override { return std::size_t{config_.frames} + 1; }

    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == frames()) return false;
        const double shift = static_cast<double>(frame_++) * config_.displacement;
        boxes.resize(config_.objects);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const std::size_t cell[3] = {i / (side_ * side_), i / side_ % side_, i % side_};
            for (int k = 0; k < 3; ++k) {
                boxes[i].min[k] = static_cast<float>(static_cast<double>(cell[k]) + shift);
                boxes[i].max[k] = static_cast<float>(static_cast<double>(cell[k] + 1) + shift);
            }
        }
        return true;
    }

private:
    config config_;
    std::size_t side_ = 1;
    std::size_t frame_ = 0;
};

}  // namespace aabblab
