/// The one parameter of every shape.
module aabblab.scenes:shape_size;

import aabb.policy;
import aabb.std;

namespace aabblab {

/// @tparam Usual how many triangles where nothing is said
template <std::uint32_t Usual>
struct shape_size {
    std::uint32_t triangles = Usual;

    [[nodiscard]] static constexpr auto parameters(std::uint32_t least, std::string_view help) {
        return std::tuple{aabb::integer_parameter{"triangles", &shape_size::triangles, least, 100'000'000U, help}};
    }
};

}  // namespace aabblab
