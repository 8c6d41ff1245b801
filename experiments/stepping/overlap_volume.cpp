module;
#include <Eigen/Geometry>

module aabblab.stepping;

import aabblab.vectors;
import :corners;

namespace aabblab {

namespace {

using Eigen::Vector3d;

/// n·x <= offset is inside.
struct half_space {
    Vector3d normal;
    double offset;
};

using polygon = std::vector<Vector3d>;

half_space below(const corners& t) {
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    return {normal, dot(normal, t[0])};
}

std::vector<half_space> half_spaces_of(const placed_mesh& m, std::uint32_t most) {
    std::vector<half_space> all;
    for (std::uint32_t t = 0; t < std::min(most, m.mesh->triangle_count()); ++t) all.push_back(below(corners_of(m, t)));
    return all;
}

/// What of a convex polygon is inside (Sutherland and Hodgman 1974).
polygon clipped(const polygon& p, const half_space& h) {
    polygon kept;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vector3d& from = p[i];
        const Vector3d& to = p[(i + 1) % p.size()];
        const double d_from = dot(h.normal, from) - h.offset;
        const double d_to = dot(h.normal, to) - h.offset;
        if (d_from <= 0) kept.push_back(from);
        if ((d_from < 0 && d_to > 0) || (d_from > 0 && d_to < 0)) {
            kept.emplace_back(from + (to - from) * (d_from / (d_from - d_to)));
        }
    }
    return kept;
}

/// Six times the volume of the cone from the origin over what is left of the triangles.
double cones_over(const placed_mesh& m, std::span<const half_space> inside, const Vector3d& origin) {
    double sum = 0;
    for (std::uint32_t t = 0; t < m.mesh->triangle_count(); ++t) {
        polygon left;
        for (const Vector3d& corner : corners_of(m, t)) left.emplace_back(corner - origin);
        for (const half_space& h : inside) {
            left = clipped(left, {h.normal, h.offset - dot(h.normal, origin)});
            if (left.size() < 3) break;
        }
        for (std::size_t i = 2; i < left.size(); ++i) sum += dot(left[0], left[i - 1].cross(left[i]));
    }
    return sum;
}

}  // namespace

double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second) {
    // Seen from a point of the floor, what lies in its plane has no volume.
    const Vector3d origin = corners_of(first, 0)[0];
    double sum = cones_over(second, half_spaces_of(first, is_floor ? 1 : first.mesh->triangle_count()), origin);
    if (!is_floor) sum += cones_over(first, half_spaces_of(second, second.mesh->triangle_count()), origin);
    return sum / 6;
}

}  // namespace aabblab
