#pragma once

import aabb.geometry;
import aabb.std;

namespace aabblab {

/// What a library finds of two meshes, with its trees built: A lies as its vertices are, B at a rotation and
/// translation. The functions that make it take A and B, which must outlive it.
struct distance_peer {
    /// Measures the distance.
    using measurement = std::function<double(const aabb::pose& of_b)>;
    /// Appends the pairs of triangles, a of A and b of B, at a distance of at most d, in any order.
    using search = std::function<void(const aabb::pose& of_b, double d, std::vector<aabb::index_pair>& pairs)>;

    std::string name;
    std::function<measurement(const aabb::mesh& a, const aabb::mesh& b)> distance;
    std::function<search(const aabb::mesh& a, const aabb::mesh& b)> within = nullptr;  ///< null if it has none
};

// Each is defined where its library is installed.
[[nodiscard]] distance_peer cgal_distances();
[[nodiscard]] distance_peer embree_distances();
[[nodiscard]] distance_peer fcl_distances();

/// R x + t.
[[nodiscard]] inline aabb::vec3d moved(const aabb::pose& by, const aabb::vec3d& x) {
    aabb::vec3d image = by.translation;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            image[static_cast<int>(i)] += by.rotation[3 * i + j] * x[static_cast<int>(j)];
    return image;
}

/// The inverse of a rotation and translation.
[[nodiscard]] inline aabb::pose inverse_of(const aabb::pose& p) {
    aabb::pose inverse;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) inverse.rotation[3 * i + j] = p.rotation[3 * j + i];
    inverse.translation = {};
    const aabb::vec3d back = moved(inverse, p.translation);
    inverse.translation = {-back[0], -back[1], -back[2]};
    return inverse;
}

/// A ball around a triangle.
struct triangle_ball {
    aabb::vec3d centre;
    double radius;

    explicit triangle_ball(const aabb::triangle3d& t)
        : centre{(t[0][0] + t[1][0] + t[2][0]) / 3, (t[0][1] + t[1][1] + t[2][1]) / 3,
                 (t[0][2] + t[1][2] + t[2][2]) / 3},
          radius(0) {
        for (int i = 0; i < 3; ++i) radius = std::max(radius, std::sqrt(dot(t[i] - centre, t[i] - centre)));
        radius *= 1 + 1e-12;  // for rounding
    }
};

}  // namespace aabblab
