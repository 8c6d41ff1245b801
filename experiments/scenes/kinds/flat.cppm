module aabblab.scenes:flat;

import aabb.std;
import :boxes;

namespace aabblab {

/// Unit cubes in one plane. All have the same extent on the third axis, where sorting and cutting are in vain.
class flat final : public drifting_boxes {
public:
    static constexpr std::string_view name = "flat";
    static constexpr std::string_view summary =
        "unit cubes that drift in the plane of x and y; on z all are alike, so that this axis tells nothing";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    flat(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed) { drift(c, 2); }
};

}  // namespace aabblab
