/// Rotation of rigid bodies: orientations are unit quaternions (x, y, z, w) from the mesh's axes to the world's, and
/// the angular momentum is about the centre of mass, in the world's axes. It changes by the torque alone, so that every
/// integrator keeps that of a free body. The interface names no Eigen types: the alignment of its quaternions depends
/// on compiler options.
export module aabblab.stepping:rotation;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// A row-major matrix.
using matrix3 = std::array<double, 9>;

/// The moments of inertia of a body.
struct rotor {
    aabb::vec3d moments;                        ///< about its principal axes, kg m²
    std::array<double, 4> axes = {0, 0, 0, 1};  ///< rotation from the principal axes to the mesh's, as a quaternion
};

/// The principal moments and axes of a tensor of inertia, kg m².
/// @throws aabb::input_error unless it is symmetric with positive moments, of which none exceeds the sum of the others
[[nodiscard]] rotor rotor_of(const matrix3& inertia);

/// Tensors of inertia of homogeneous bodies about their centre, kg m². A disc lies in the plane of x and y.
[[nodiscard]] matrix3 inertia_of_ball(double mass, double radius);
[[nodiscard]] matrix3 inertia_of_box(double mass, const aabb::vec3d& sides);
[[nodiscard]] matrix3 inertia_of_disc(double mass, double radius);

/// @throws aabb::input_error unless the matrix is a rotation, within 1e-6
[[nodiscard]] std::array<double, 4> quaternion_of(const matrix3& rotation);
[[nodiscard]] matrix3 matrix_of(std::span<const double, 4> orientation);

/// rad/s, in the world's axes
[[nodiscard]] aabb::vec3d angular_velocity_of(const rotor& r, std::span<const double, 4> orientation,
                                              std::span<const double, 3> angular_momentum);
/// kg m²/s, in the world's axes
[[nodiscard]] aabb::vec3d angular_momentum_of(const rotor& r, std::span<const double, 4> orientation,
                                              const aabb::vec3d& angular_velocity);

/// Turns a body for `time` seconds without a torque: exactly if two of its moments are equal, else by a symmetric
/// splitting of its energy, which is of second order, symplectic and reversible (Reich 1994; Touma and Wisdom 1994;
/// Dullweber, Leimkuhler and McLachlan 1997; Hairer, Lubich and Wanner 2006, VII.5).
void turn_freely(const rotor& r, std::span<double, 4> orientation, std::span<const double, 3> angular_momentum,
                 double time);

/// The rate (w/2) q at which an orientation changes, as a quaternion; q need not have length 1.
[[nodiscard]] std::array<double, 4> rate_of(std::span<const double, 4> q, const aabb::vec3d& angular_velocity);

/// The quaternion with length 1.
[[nodiscard]] std::array<double, 4> of_length_1(std::span<const double, 4> q);

}  // namespace aabblab
