export module aabb.geometry:points;

import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// A point or vector in three dimensions; an aggregate, indexed by axis (0 = x, 1 = y, 2 = z).
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

/// The dot product, summed left to right.
template <class Real>
[[nodiscard]] constexpr Real dot(const vec3<Real>& p, const vec3<Real>& q) noexcept {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

template <class Real>
[[nodiscard]] constexpr vec3<Real> cross(const vec3<Real>& p, const vec3<Real>& q) noexcept {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

template <class Real>
[[nodiscard]] inline bool is_finite(const vec3<Real>& p) noexcept {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// A triangle by its three corners, which may be degenerate.
template <class Real>
struct triangle3 {
    vec3<Real> corner[3];

    constexpr const vec3<Real>& operator[](int i) const noexcept { return corner[i]; }
    constexpr vec3<Real>& operator[](int i) noexcept { return corner[i]; }
    friend bool operator==(const triangle3&, const triangle3&) = default;
};

using triangle3f = triangle3<float>;
using triangle3d = triangle3<double>;

/// Rotates a triangle until corner 0 is its apex: alone on its side of a plane, or alone on the plane with both other
/// corners on one side.
/// @param t corners, or their indices
/// @param heights signed distances of the corners from the plane, on any scale
/// @returns whether the apex lies below the plane (the others above it), so that the other triangle must be flipped
template <class Triangle, class Height>
inline bool rotate_to_apex(Triangle& t, const std::array<Height, 3>& heights) noexcept {
    const auto is_apex = [&](int i, Height up) {
        const Height own = up * heights[static_cast<std::size_t>(i)];
        const Height p = up * heights[static_cast<std::size_t>((i + 1) % 3)];
        const Height q = up * heights[static_cast<std::size_t>((i + 2) % 3)];
        return (own > 0 && p <= 0 && q <= 0) || (own == 0 && p < 0 && q < 0);
    };
    for (int i = 0; i < 3; ++i)
        for (const Height up : {Height{1}, Height{-1}})
            if (is_apex(i, up)) {
                t = {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
                return up < 0;
            }
    return false;
}

/// The input of a triangle test.
template <class Real>
struct triangle_pair {
    triangle3<Real> a;
    triangle3<Real> b;
};

/// Converts to double without rounding.
[[nodiscard]] constexpr vec3d in_double(const vec3f& p) noexcept {
    return {p[0], p[1], p[2]};
}
[[nodiscard]] constexpr triangle3d in_double(const triangle3d& t) noexcept {
    return t;
}
[[nodiscard]] constexpr triangle3d in_double(const triangle3f& t) noexcept {
    return {in_double(t[0]), in_double(t[1]), in_double(t[2])};
}

/// Converts to float, rounded to nearest.
[[nodiscard]] constexpr triangle3f in_float(const triangle3f& t) noexcept {
    return t;
}
[[nodiscard]] constexpr triangle3f in_float(const triangle3d& t) noexcept {
    const auto rounded = [](const vec3d& p) {
        return vec3f{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    };
    return {{rounded(t[0]), rounded(t[1]), rounded(t[2])}};
}

/// A vector of three numbers; the fourth lane is a copy of the third and ignored.
template <class Real>
using lanes = Real __attribute__((vector_size(4 * sizeof(Real))));

template <class Real>
[[nodiscard]] inline lanes<Real> coordinates(const vec3<Real>& p) noexcept {
    return lanes<Real>{p[0], p[1], p[2], p[2]};
}

/// One coordinate of all three corners.
template <class Real>
[[nodiscard]] inline lanes<Real> corners_along(const triangle3<Real>& t, int axis) noexcept {
    return lanes<Real>{t[0][axis], t[1][axis], t[2][axis], t[2][axis]};
}

/// Bit i is set if a comparison holds in lane i.
template <class Mask>
[[nodiscard]] inline unsigned bits(const Mask& mask) noexcept {
    using flags = bool __attribute__((ext_vector_type(4)));
    return __builtin_bit_cast(std::uint8_t, __builtin_convertvector(mask, flags)) & 7U;
}

}  // namespace aabb
