module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

module aabblab.scenes:flat;

import aabb.geometry;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes in one plane. All have the same extent on the third axis, where sorting and cutting are in vain.
class flat final : public generated_boxes {
public:
    static constexpr std::string_view name = "flat";
    static constexpr std::string_view summary =
        "unit cubes that drift in the plane of x and y; on z all are alike, so that this axis tells nothing";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    flat(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each), corners_(drifting_corners(c, 2, random_)) {}

private:
    void advance() override { corners_.advance(random_); }
    void place(std::span<aabb::box> boxes) override { place_cubes(corners_, boxes); }

    drifting_points corners_;
};

}  // namespace aabblab
