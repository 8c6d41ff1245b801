module;
#include <Eigen/Core>

module aabblab.scenes:teleport;

import :boxes;

namespace aabblab {

class teleport final : public generated_boxes {
public:
    static constexpr std::string_view name = "teleport";
    static constexpr std::string_view summary =
        "unit cubes, each at a new random position in every frame: no coherence between frames";

    using config = scene_size;
    static constexpr auto parameters = size_parameters<config>("how many boxes");

    teleport(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, 0), width_(width_for(c.objects, 3)) {}

private:
    void place(std::span<aabb::box> boxes) override {
        for (aabb::box& b : boxes) b = cube_at(random_.point(width_), 1);
    }

    double width_;
};

}  // namespace aabblab
