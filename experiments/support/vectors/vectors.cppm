module;
#include <Eigen/Core>

/// What is done with Eigen's vectors beside adding and scaling them, which is done by components. Sums are taken from
/// left to right, while the order of Eigen's follows from the processor. A vector stands before the number that scales
/// it: where several module files bring Eigen along, clang 19 emits no friends of its templates, and linking fails.
export module aabblab.vectors;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

[[nodiscard]] inline double dot(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

[[nodiscard]] inline double length_of(const Eigen::Vector3d& p) {
    return std::sqrt(dot(p, p));
}

[[nodiscard]] inline aabb::vec3f in_float(const Eigen::Vector3d& p) {
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

/// Without rounding.
template <class Real>
[[nodiscard]] inline Eigen::Vector3d in_eigen(const aabb::vec3<Real>& p) {
    return {p[0], p[1], p[2]};
}

[[nodiscard]] inline aabb::vec3d from_eigen(const Eigen::Vector3d& p) {
    return {p[0], p[1], p[2]};
}

/// Three columns times a vector, summed from left to right, too.
template <class Matrix>
[[nodiscard]] inline Eigen::Vector3d product(const Matrix& m, const Eigen::Vector3d& p) {
    return m.col(0) * p[0] + m.col(1) * p[1] + m.col(2) * p[2];
}

}  // namespace aabblab
