module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

module aabblab.scenes:one_huge;

import aabb;
import :boxes;
import :motion;
import :random;

namespace aabblab {

/// Unit cubes and one that is huge, which overlaps whatever lies within it: by default an eighth of all objects.
class one_huge final : public generated_boxes {
public:
    static constexpr std::string_view name = "one_huge";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube, and object 0, which spans a large part of their world";

    struct config : motion_config {
        /// Edge of the huge box over the world's side.
        double span = 0.5;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"span", &config::span, 0.0, 1.0,
                                                             "edge of the huge box over the side of the world"}});

    one_huge(const config& c, std::uint64_t seed)
        : one_huge(c, seed, std::min(c.objects, 1U), width_for(c.objects, 3)) {}

private:
    one_huge(const config& c, std::uint64_t seed, std::uint32_t huge, double width)
        : generated_boxes(name, c, seed, drifting_points::bytes_each),
          edge_(c.span * (width + 1)),
          step_(step_of(c, (edge_ + c.objects - 1) / std::max(c.objects, 1U), {width + 1, width + 1, width + 1})),
          huge_(huge, 3, width + 1 - edge_, {step_, step_}, random_),
          unit_(c.objects - huge, 3, width, {step_, step_}, random_) {}

    void advance() override {
        huge_.advance(random_);
        unit_.advance(random_);
    }

    void place(std::span<aabb::box> boxes) override {
        if (boxes.empty()) return;
        boxes[0] = cube_at(huge_[0], edge_);
        for (std::size_t i = 0; i < unit_.size(); ++i) boxes[i + 1] = cube_at(unit_[i], 1);
    }

    double edge_;
    double step_;
    drifting_points huge_;
    drifting_points unit_;
};

}  // namespace aabblab
