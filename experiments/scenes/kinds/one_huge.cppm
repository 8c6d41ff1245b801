module;
#include <Eigen/Core>

module aabblab.scenes:one_huge;

import :boxes;

namespace aabblab {

/// Unit cubes and huge cubes; a huge one overlaps all cubes within it, by default an eighth of them.
class one_huge final : public generated_boxes {
public:
    static constexpr std::string_view name = "one_huge";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube, and one or several huge ones that span a large part of it";

    struct config : motion_config {
        double span = 0.5;
        /// The first objects are the huge ones.
        std::uint32_t huge = 1;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters,
        std::tuple{aabb::number_parameter{"span", &config::span, 0.0, 1.0,
                                          "edge of a huge box over the side of the "
                                          "world"},
                   aabb::integer_parameter{"huge", &config::huge, 0U, 0x7fffffffU, "how many boxes are huge"}});

    /// The world is so wide that a unit cube overlaps two others on average; a huge edge is `span` of its side.
    one_huge(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, drifting_points::bytes_each) {
        const std::uint32_t huge = std::min(c.objects, c.huge);
        const double width = width_for(c.objects, /*axes=*/3);  // of the lowest corners; the world is wider by an edge
        edge_ = c.span * (width + 1);
        const double mean_extent = (huge * edge_ + (c.objects - huge)) / std::max(c.objects, 1U);
        const double step = step_of(c, mean_extent, {width + 1, width + 1, width + 1});
        huge_ = {huge, /*axes=*/3, width + 1 - edge_, {step, step}, random_};
        unit_ = {c.objects - huge, /*axes=*/3, width, {step, step}, random_};
    }

private:
    void advance() override {
        huge_.advance(random_);
        unit_.advance(random_);
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = i < huge_.size() ? cube_at(huge_[i], edge_) : cube_at(unit_[i - huge_.size()], 1);
    }

    double edge_ = 0;
    drifting_points huge_;
    drifting_points unit_;
};

}  // namespace aabblab
