module;
#include <Eigen/Core>

module aabblab.stepping:corners;

import aabb.std;
import aabblab.vectors;
import :contact_law;

namespace aabblab {

using corners = std::array<Eigen::Vector3d, 3>;

/// Of a triangle where its mesh is.
[[nodiscard]] inline corners corners_of(const placed_mesh& m, std::uint32_t triangle) {
    const auto t = m.triangle(triangle);
    return {in_eigen(t[0]), in_eigen(t[1]), in_eigen(t[2])};
}

}  // namespace aabblab
