module;
#include <Eigen/Core>

/// Operations on Eigen's vectors other than addition and scaling. They sum from left to right, whereas the order of
/// Eigen's own reductions depends on the processor. Write the vector before its scale factor: if several modules
/// include Eigen, clang 19 does not emit friends of its templates, and linking fails.
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

/// Converts exactly.
template <class Real>
[[nodiscard]] inline Eigen::Vector3d in_eigen(const aabb::vec3<Real>& p) {
    return {p[0], p[1], p[2]};
}

[[nodiscard]] inline aabb::vec3d from_eigen(const Eigen::Vector3d& p) {
    return {p[0], p[1], p[2]};
}

/// A matrix of three columns times a vector, also summed from left to right.
template <class Matrix>
[[nodiscard]] inline Eigen::Vector3d product(const Matrix& m, const Eigen::Vector3d& p) {
    return m.col(0) * p[0] + m.col(1) * p[1] + m.col(2) * p[2];
}

}  // namespace aabblab
