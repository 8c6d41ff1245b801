module;
#include <array>
#include <cmath>

/// Rotations as unit quaternions in double, and what places a mesh with one.
module aabblab.scenes:rotation;

import aabb.geometry;
import :random;

namespace aabblab {

struct quaternion {
    double w, x, y, z;
};

[[nodiscard]] inline quaternion normalised(const quaternion& q) {
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / length, q.x / length, q.y / length, q.z / length};
}

/// q after p.
[[nodiscard]] inline quaternion composed(const quaternion& q, const quaternion& p) {
    return normalised({q.w * p.w - q.x * p.x - q.y * p.y - q.z * p.z, q.w * p.x + q.x * p.w + q.y * p.z - q.z * p.y,
                       q.w * p.y - q.x * p.z + q.y * p.w + q.z * p.x, q.w * p.z + q.x * p.y - q.y * p.x + q.z * p.w});
}

/// By 2 atan(angle / 2), which is `angle` radians for small ones, about a unit axis; needs no sine.
[[nodiscard]] inline quaternion turn(const aabb::vec3d& axis, double angle) {
    const double t = angle / 2;
    return normalised({1, t * axis[0], t * axis[1], t * axis[2]});
}

/// Evenly over all rotations.
[[nodiscard]] inline quaternion random_rotation(random_source& random) {
    while (true) {
        const quaternion q{random.within(), random.within(), random.within(), random.within()};
        const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
        if (square <= 1 && square > 1e-6) return normalised(q);
    }
}

/// Turns a mesh about its centre (in the mesh's frame) and brings the centre to a place.
[[nodiscard]] inline aabb::pose placed(const aabb::vec3d& centre, const quaternion& q, const aabb::vec3d& place) {
    aabb::pose p;
    p.rotation = {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z),     2 * (q.x * q.z + q.w * q.y),
                  2 * (q.x * q.y + q.w * q.z),     1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x),
                  2 * (q.x * q.z - q.w * q.y),     2 * (q.y * q.z + q.w * q.x),     1 - 2 * (q.x * q.x + q.y * q.y)};
    for (int i = 0; i < 3; ++i) {
        const double* row = &p.rotation[3 * static_cast<std::size_t>(i)];
        p.translation[i] = place[i] - (row[0] * centre[0] + row[1] * centre[1] + row[2] * centre[2]);
    }
    aabb::require_rigid(p);
    return p;
}

[[nodiscard]] inline aabb::vec3d centre_of(const aabb::box& b) {
    aabb::vec3d centre{};
    for (int k = 0; k < 3; ++k) centre[k] = (double{b.min[k]} + double{b.max[k]}) / 2;
    return centre;
}

[[nodiscard]] inline double longest_extent(const aabb::box& b) {
    const int k = aabb::longest_axis(b);
    return double{b.max[k]} - double{b.min[k]};
}

/// Moves the mesh's box to the origin and scales its longest extent; each vertex is rounded to float once.
inline void normalise(aabb::mesh& m, double wanted = 1) {
    const aabb::box bounds = aabb::bounds_of(m);
    const aabb::vec3d centre = centre_of(bounds);
    const double extent = longest_extent(bounds);
    if (extent == 0) return;
    for (aabb::vec3f& v : m.vertices)
        for (int k = 0; k < 3; ++k) {
            // A vertex that no triangle uses may lie anywhere; it stays finite.
            const double scaled = (double{v[k]} - centre[k]) / extent * wanted;
            v[k] = static_cast<float>(std::fmin(std::fmax(scaled, -0x1p100), 0x1p100));
        }
}

/// Whether meshes are scaled to one size; the values of a parameter.
enum class scaling : unsigned char { yes, no };

}  // namespace aabblab
