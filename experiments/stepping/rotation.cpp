module;
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

module aabblab.stepping;

import aabb.geometry;
import aabblab.vectors;

namespace aabblab {

namespace {

using Eigen::Vector3d;
// No alignment is asked, since these come and go as arrays of numbers.
using quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

quaternion quaternion_at(std::span<const double, 4> q) {
    return {q[3], q[0], q[1], q[2]};
}
std::array<double, 4> numbers_of(const quaternion& q) {
    return {q.x(), q.y(), q.z(), q.w()};
}

/// The quaternion q p, written out: the rounding of Eigen's product depends on the processor.
quaternion product_of(const quaternion& q, const quaternion& p) {
    return {q.w() * p.w() - q.x() * p.x() - q.y() * p.y() - q.z() * p.z(),
            q.w() * p.x() + q.x() * p.w() + q.y() * p.z() - q.z() * p.y(),
            q.w() * p.y() - q.x() * p.z() + q.y() * p.w() + q.z() * p.x(),
            q.w() * p.z() + q.x() * p.y() - q.y() * p.x() + q.z() * p.w()};
}

quaternion normalised(const quaternion& q) {
    const double length = std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
    return {q.w() / length, q.x() / length, q.y() / length, q.z() / length};
}

/// The rotation by this vector: the exponential map.
quaternion exponential(const Vector3d& rotation) {
    const double half = length_of(rotation) / 2;
    // sin(h)/h to the last digit where h⁴/120 is below it.
    const double sine_over_angle = (half < 1e-4 ? 1 - half * half / 6 : std::sin(half) / half) / 2;
    return {std::cos(half), rotation[0] * sine_over_angle, rotation[1] * sine_over_angle,
            rotation[2] * sine_over_angle};
}

/// The rotation from the principal axes to the world's, as a matrix: its columns are the principal axes.
Eigen::Matrix3d principal_axes(const rotor& r, std::span<const double, 4> orientation) {
    return product_of(quaternion_at(orientation), quaternion_at(r.axes)).toRotationMatrix();
}

matrix3 diagonal(double x, double y, double z) {
    return {x, 0, 0, 0, y, 0, 0, 0, z};
}

}  // namespace

/// The tensor's eigenvalues and eigenvectors; a diagonal tensor keeps the axes of the mesh.
rotor rotor_of(const matrix3& inertia) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> tensor(inertia.data());
    const double size = tensor.cwiseAbs().maxCoeff();
    if (!std::isfinite(size) || (tensor - tensor.transpose()).cwiseAbs().maxCoeff() > 1e-9 * size)
        throw aabb::input_error("a tensor of inertia must be finite and symmetric");
    rotor r{{inertia[0], inertia[4], inertia[8]}};
    if (tensor != Eigen::Matrix3d(tensor.diagonal().asDiagonal())) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
        Eigen::Matrix3d axes = solver.eigenvectors();
        if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
        r = {from_eigen(solver.eigenvalues()), numbers_of(quaternion(axes))};
    }
    const auto [least, middle, greatest] = [&] {
        std::array<double, 3> sorted = {r.moments[0], r.moments[1], r.moments[2]};
        std::ranges::sort(sorted);
        return sorted;
    }();
    // A body whose mass lies on a line through its centre has no moment about it, and none that turns it.
    if (!(least > 0) || greatest > (least + middle) * (1 + 1e-9))
        throw aabb::input_error("moments of inertia must be positive, and none may exceed the sum of the others");
    return r;
}

matrix3 inertia_of_ball(double mass, double radius) {
    const double moment = 0.4 * mass * radius * radius;
    return diagonal(moment, moment, moment);
}

matrix3 inertia_of_box(double mass, const aabb::vec3d& sides) {
    const double x = sides[0] * sides[0], y = sides[1] * sides[1], z = sides[2] * sides[2];
    return diagonal(mass * (y + z) / 12, mass * (x + z) / 12, mass * (x + y) / 12);
}

matrix3 inertia_of_disc(double mass, double radius) {
    const double across = mass * radius * radius / 4;
    return diagonal(across, across, 2 * across);
}

/// The quaternion of length 1 with a positive or zero real part, up to rounding.
std::array<double, 4> quaternion_of(const matrix3& rotation) {
    if (!aabb::is_rigid({rotation, {0, 0, 0}}))
        throw aabb::input_error("a body that turns needs a rotation, not another matrix");
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> matrix(rotation.data());
    return numbers_of(normalised(quaternion(Eigen::Matrix3d(matrix))));
}

matrix3 matrix_of(std::span<const double, 4> orientation) {
    matrix3 rows;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data()) =
        quaternion_at(orientation).toRotationMatrix();
    return rows;
}

/// Σ e (e·L)/I over the principal axes e.
aabb::vec3d angular_velocity_of(const rotor& r, std::span<const double, 4> orientation,
                                std::span<const double, 3> angular_momentum) {
    const Eigen::Matrix3d axes = principal_axes(r, orientation);
    const Vector3d momentum(angular_momentum[0], angular_momentum[1], angular_momentum[2]);
    Vector3d velocity = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) velocity += axes.col(i) * (dot(axes.col(i), momentum) / r.moments[i]);
    return from_eigen(velocity);
}

/// Σ e (e·ω) I over the principal axes e.
aabb::vec3d angular_momentum_of(const rotor& r, std::span<const double, 4> orientation,
                                const aabb::vec3d& angular_velocity) {
    const Eigen::Matrix3d axes = principal_axes(r, orientation);
    Vector3d momentum = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) momentum += axes.col(i) * (dot(axes.col(i), in_eigen(angular_velocity)) * r.moments[i]);
    return from_eigen(momentum);
}

/// With the middle moment b, the energy is |L|²/2b plus (1/a - 1/b) (L·e)²/2 for each other moment a with axis e. The
/// first part turns the body about L by |L|/b, and commutes with the others, each of which turns it about e by
/// (1/a - 1/b) L·e. The two others do not commute: one acts before and after the other, for half of the time.
void turn_freely(const rotor& r, std::span<double, 4> orientation, std::span<const double, 3> angular_momentum,
                 double time) {
    std::array<int, 3> order = {0, 1, 2};
    std::ranges::sort(order, {}, [&](int axis) { return r.moments[axis]; });
    const Vector3d momentum(angular_momentum[0], angular_momentum[1], angular_momentum[2]);
    const double middle = r.moments[order[1]];
    quaternion principal = product_of(quaternion_at(orientation), quaternion_at(r.axes));
    const auto turn_about = [&](int axis, double duration) {
        const double rate = 1 / r.moments[axis] - 1 / middle;
        if (rate == 0) return;
        const Vector3d e = principal.toRotationMatrix().col(axis);
        principal = product_of(principal, exponential(Vector3d::Unit(axis) * (duration * rate * dot(e, momentum))));
    };
    turn_about(order[0], time / 2);
    turn_about(order[2], time);
    turn_about(order[0], time / 2);
    principal = product_of(exponential(momentum * (time / middle)), principal);
    const quaternion turned = normalised(product_of(principal, quaternion_at(r.axes).conjugate()));
    std::ranges::copy(numbers_of(turned), orientation.begin());
}

std::array<double, 4> rate_of(std::span<const double, 4> q, const aabb::vec3d& angular_velocity) {
    const quaternion half(0, angular_velocity[0] / 2, angular_velocity[1] / 2, angular_velocity[2] / 2);
    return numbers_of(product_of(half, quaternion_at(q)));
}

std::array<double, 4> of_length_1(std::span<const double, 4> q) {
    return numbers_of(normalised(quaternion_at(q)));
}

}  // namespace aabblab
