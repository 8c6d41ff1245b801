module aabblab.scenes:line;

import :boxes;

namespace aabblab {

class line final : public drifting_boxes {
public:
    static constexpr std::string_view name = "line";
    static constexpr std::string_view summary =
        "unit cubes that drift along x; on y and z all are equal, so that these axes separate none";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    line(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed) { drift(c, 1); }
};

}  // namespace aabblab
