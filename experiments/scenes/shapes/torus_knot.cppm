module;
#include <Eigen/Geometry>

module aabblab.scenes:torus_knot;

import aabblab.vectors;
import :circle;
import :shape;

namespace aabblab {

/// A closed tube around the (2, 3) torus knot, the trefoil.
struct torus_knot {
    static constexpr std::string_view name = "torus_knot";
    static constexpr std::string_view summary = "a tube around a trefoil knot";

    /// The number of triangles is 2 · rings · vertices per ring, the nearest one that keeps their shape.
    using config = shape_size<5000>;
    static constexpr auto parameters = config::parameters(96, "about how many triangles");

    /// Puts rings of vertices along the knot and joins each to the next, the last to the first.
    [[nodiscard]] static aabb::mesh make(const config& c) {
        // The length of the knot is about 12.5 times the circumference of the tube.
        const auto [rings, around] = rings_for(c.triangles, /*aspect=*/12.5);
        aabb::mesh m;
        for (std::uint32_t ring = 0; ring < rings; ++ring)
            for (std::uint32_t i = 0; i < around; ++i)
                m.vertices.push_back(surface(static_cast<double>(ring) / rings, static_cast<double>(i) / around));
        const auto index_of = [=](std::uint32_t ring, std::uint32_t i) { return ring % rings * around + i % around; };
        add_bands(m, rings, around, index_of);
        return m;
    }

private:
    /// The point of the tube's surface at `along` turns of the knot and `around` turns of the tube. The centre line
    /// lies on a torus, with angle u = 2 · along about its axis and v = 3 · along about its tube. The ring around a
    /// point of the line lies in the plane of the torus normal and the direction across the knot: both return after a
    /// turn of the knot, so that the tube closes without a twist.
    [[nodiscard]] static aabb::vec3f surface(double along, double around) {
        constexpr double major = 2;
        constexpr double tube = 0.4;
        const circle_point u = on_circle(2 * along);
        const circle_point v = on_circle(3 * along);
        const Eigen::Vector3d normal = {v.cos * u.cos, v.cos * u.sin, v.sin};
        const double radius = major + v.cos;
        Eigen::Vector3d tangent = {-3 * v.sin * u.cos - 2 * radius * u.sin, -3 * v.sin * u.sin + 2 * radius * u.cos,
                                   3 * v.cos};
        tangent /= length_of(tangent);
        const Eigen::Vector3d side = normal.cross(tangent);
        const circle_point w = on_circle(around);
        const Eigen::Vector3d centre = {radius * u.cos, radius * u.sin, v.sin};
        return in_float(centre + (normal * w.cos + side * w.sin) * tube);
    }
};

}  // namespace aabblab
