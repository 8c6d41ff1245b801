module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

module aabblab.scenes:line;

import aabb.geometry;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes along one line. All have the same extents on the other two axes, where sorting and cutting are in vain.
class line final : public generated_boxes {
public:
    static constexpr std::string_view name = "line";
    static constexpr std::string_view summary =
        "unit cubes that drift along x; on y and z all are alike, so that these axes tell nothing";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    line(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each), corners_(drifting_corners(c, 1, random_)) {}

private:
    void advance() override { corners_.advance(random_); }
    void place(std::span<aabb::box> boxes) override { place_cubes(corners_, boxes); }

    drifting_points corners_;
};

}  // namespace aabblab
