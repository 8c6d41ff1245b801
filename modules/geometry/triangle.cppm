export module aabb.geometry:triangle;

import :vec3;

export namespace aabb {

/// A triangle by its three corners; may have zero area.
template <class Real>
struct triangle3 {
    vec3<Real> corner[3];

    constexpr const vec3<Real>& operator[](int i) const noexcept { return corner[i]; }
    constexpr vec3<Real>& operator[](int i) noexcept { return corner[i]; }
    friend bool operator==(const triangle3&, const triangle3&) = default;
};

using triangle3f = triangle3<float>;
using triangle3d = triangle3<double>;

/// What a triangle test decides on.
template <class Real>
struct triangle_pair {
    triangle3<Real> a;
    triangle3<Real> b;
};

/// Without rounding.
[[nodiscard]] constexpr triangle3d in_double(const triangle3d& t) noexcept {
    return t;
}
[[nodiscard]] constexpr triangle3d in_double(const triangle3f& t) noexcept {
    return {{{t[0][0], t[0][1], t[0][2]}, {t[1][0], t[1][1], t[1][2]}, {t[2][0], t[2][1], t[2][2]}}};
}

/// Rounded to nearest, where there is anything to round.
[[nodiscard]] constexpr triangle3f in_float(const triangle3f& t) noexcept {
    return t;
}
[[nodiscard]] constexpr triangle3f in_float(const triangle3d& t) noexcept {
    const auto rounded = [](const vec3d& p) {
        return vec3f{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    };
    return {{rounded(t[0]), rounded(t[1]), rounded(t[2])}};
}

}  // namespace aabb
