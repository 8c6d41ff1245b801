module;
#include <Eigen/Core>

module aabblab.scenes:still;

import :boxes;

namespace aabblab {

class still final : public generated_boxes {
public:
    static constexpr std::string_view name = "still";
    static constexpr std::string_view summary = "unit cubes at rest in a cube: all frames are equal";

    using config = scene_size;
    static constexpr auto parameters = size_parameters<config>("how many boxes");

    still(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, sizeof(aabb::box)) {
        const double width = width_for(c.objects, 3);
        boxes_.resize(c.objects);
        for (aabb::box& b : boxes_) b = cube_at(random_.point(width), 1);
    }

private:
    void place(std::span<aabb::box> boxes) override { std::ranges::copy(boxes_, boxes.begin()); }

    std::vector<aabb::box> boxes_;
};

}  // namespace aabblab
