module aabblab.scenes:flat;

import :boxes;

namespace aabblab {

class flat final : public drifting_boxes {
public:
    static constexpr std::string_view name = "flat";
    static constexpr std::string_view summary =
        "unit cubes that drift in the plane of x and y; on z all are equal, so that this axis separates none";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    flat(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed) { drift(c, 2); }
};

}  // namespace aabblab
