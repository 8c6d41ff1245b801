export module aabb.geometry:vec3;

import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// Point or vector in 3-space; an aggregate, indexed by axis (0 = x, 1 = y, 2 = z).
template <class Real>
struct vec3 {
    Real at[3];

    constexpr Real& operator[](int axis) noexcept { return at[axis]; }
    constexpr const Real& operator[](int axis) const noexcept { return at[axis]; }
    friend bool operator==(const vec3&, const vec3&) = default;
};

using vec3f = vec3<float>;
using vec3d = vec3<double>;

template <class Real>
[[nodiscard]] constexpr vec3<Real> operator-(const vec3<Real>& p, const vec3<Real>& q) noexcept {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

template <class Real>
[[nodiscard]] constexpr vec3<Real> operator+(const vec3<Real>& p, const vec3<Real>& q) noexcept {
    return {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
}

/// Scalar product, summed left to right.
template <class Real>
[[nodiscard]] constexpr Real dot(const vec3<Real>& p, const vec3<Real>& q) noexcept {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

template <class Real>
[[nodiscard]] constexpr vec3<Real> cross(const vec3<Real>& p, const vec3<Real>& q) noexcept {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

[[nodiscard]] inline bool is_finite(const vec3f& p) noexcept {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

}  // namespace aabb
