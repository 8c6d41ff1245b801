/// Parameters that several kinds of scenes share.
module aabblab.scenes:parameters;

import aabb.policy;
import aabb.std;

namespace aabblab {

template <class Config>
[[nodiscard]] constexpr auto frames_parameter() {
    return aabb::integer_parameter{"frames", &Config::frames, 0U, 0x7ffffffeU, "frames after the first one"};
}

template <class Config>
[[nodiscard]] constexpr auto size_parameters(std::string_view help) {
    return std::tuple{aabb::integer_parameter{"objects", &Config::objects, 0U, 0x7fffffffU, help},
                      frames_parameter<Config>()};
}

enum class scaling : unsigned char { yes, no };

template <class Config>
[[nodiscard]] constexpr auto normalise_parameter(std::string_view help) {
    return aabb::choice_parameter{"normalise", &Config::normalise, std::array<std::string_view, 2>{"yes", "no"}, help};
}

}  // namespace aabblab
