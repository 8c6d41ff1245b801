module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:still;

import aabb.geometry;
import :boxes;
import :random;

namespace aabblab {

/// Unit cubes that never move: what was learnt in one frame stays true.
class still final : public generated_boxes {
public:
    static constexpr std::string_view name = "still";
    static constexpr std::string_view summary = "unit cubes in a cube, none of which ever moves: all frames are equal";

    using config = scene_size;
    static constexpr auto parameters = size_parameters;

    still(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, sizeof(aabb::box)) {
        const double width = width_for(c.objects, 3);
        boxes_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) boxes_.push_back(cube_at(random_.point(width), 1));
    }

private:
    void place(std::span<aabb::box> boxes) override { std::ranges::copy(boxes_, boxes.begin()); }

    std::vector<aabb::box> boxes_;
};

}  // namespace aabblab
