module;
#include <cmath>
#include <cstdint>
#include <string_view>
#include <tuple>

module aabblab.scenes:torus_knot;

import aabb.geometry;
import aabb.policy;
import :circle;
import :rings;

namespace aabblab {

/// A tube around the (2, 3) torus knot, the trefoil: closed, twisted into itself, without an inside in the middle.
struct torus_knot {
    static constexpr std::string_view name = "torus_knot";
    static constexpr std::string_view summary = "a tube around a trefoil knot";

    struct config {
        /// About how many: rings · vertices of a ring · 2, the nearest to it that keeps the triangles' shape.
        std::uint32_t triangles = 5000;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"triangles", &config::triangles, 96U, 100'000'000U, "about how many triangles"}};

    [[nodiscard]] static aabb::mesh make(const config& c) {
        // The knot is about 12.5 times as long as the tube is around.
        const auto [rings, around] = rings_for(c.triangles, 12.5);
        aabb::mesh m;
        for (std::uint32_t ring = 0; ring < rings; ++ring)
            for (std::uint32_t i = 0; i < around; ++i)
                m.vertices.push_back(surface(static_cast<double>(ring) / rings, static_cast<double>(i) / around));
        const auto at = [=](std::uint32_t ring, std::uint32_t i) { return ring % rings * around + i % around; };
        for (std::uint32_t ring = 0; ring < rings; ++ring)
            for (std::uint32_t i = 0; i < around; ++i) {
                m.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
                m.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
            }
        return m;
    }

private:
    /// The tube `along` the knot and `around` it, both in turns. The normal of the torus on which the knot lies and the
    /// knot's tangent give a frame that closes.
    [[nodiscard]] static aabb::vec3f surface(double along, double around) {
        constexpr double major = 2;
        constexpr double tube = 0.4;
        const circle_point u = on_circle(2 * along);
        const circle_point v = on_circle(3 * along);
        const aabb::vec3d normal = {v.cos * u.cos, v.cos * u.sin, v.sin};
        const double reach = major + v.cos;
        aabb::vec3d tangent = {-3 * v.sin * u.cos - 2 * reach * u.sin, -3 * v.sin * u.sin + 2 * reach * u.cos,
                               3 * v.cos};
        const double length = std::sqrt(aabb::dot(tangent, tangent));
        for (double& t : tangent.at) t /= length;
        const aabb::vec3d side = aabb::cross(normal, tangent);
        const circle_point w = on_circle(around);
        const aabb::vec3d centre = {reach * u.cos, reach * u.sin, v.sin};
        aabb::vec3f p{};
        for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(centre[k] + tube * (w.cos * normal[k] + w.sin * side[k]));
        return p;
    }
};

}  // namespace aabblab
