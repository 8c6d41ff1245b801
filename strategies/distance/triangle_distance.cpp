module aabb.distance.triangle_distance;

import aabb.triangle.intersection;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// A common point of triangles that intersect.
measured_distance meeting(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    const triangle_intersection common = intersection_of(poses, s, t);
    const vec3d& at = common.corners.front();
    // Corners of triangles at poses are rounded by 2 u of a coordinate, or by the least double.
    double error = 0x1p-1070;
    for (int k = 0; k < 3; ++k) error += common.error[k] + 0x1p-51 * std::abs(at[k]);
    return {.p = at, .q = at, .point_error = error};
}

/// The sum of the magnitudes of the coordinates, in which their rounding errors are bounded.
double magnitude(const vec3d& p) noexcept {
    return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
}

/// The nearest points of disjoint triangles by rounded arithmetic, between bounds of their distance.
measured_distance by_rounding(const rounded_triangles& rounded, const near_points<double>& nearest,
                              const vec3d& translation, double lower, double upper) noexcept {
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    const vec3d origin = rounded.origin() + translation;
    const double size =
        magnitude(rounded.origin()) + magnitude(translation) + magnitude(nearest.p) + magnitude(nearest.q);
    return {.lower = lower,
            .upper = upper,
            .value = std::sqrt(nearest.squared),
            .p = origin + nearest.p,
            .q = origin + nearest.q,
            .point_error = rounded.tolerance() + 4 * unit * size};
}

/// The nearest points of disjoint triangles by integers. The distance squared has a relative error of 2^-51, its root
/// half of that and another u: 2^-50 covers both. Below the normal numbers, a value is off by up to the least double;
/// that of disjoint triangles is not 0.
measured_distance by_integers(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept {
    const auto [squared, p, q] = disjoint_triangles(poses, s, t).nearest();
    constexpr double least = std::numeric_limits<double>::denorm_min();
    const bool is_even = squared.exponent % 2 == 0;
    const double root = std::sqrt(is_even ? squared.mantissa : 2 * squared.mantissa);
    const double value = std::max(least, std::ldexp(root, (is_even ? squared.exponent : squared.exponent - 1) / 2));
    const double lower = std::max(0.0, value * (1 - 0x1p-50) - least), upper = value * (1 + 0x1p-50) + least;
    return {.lower = lower,
            .upper = upper,
            .value = value,
            .p = p,
            .q = q,
            .point_error = 0x1p-50 * (magnitude(p) + magnitude(q)) + 0x1p-1070 + (upper - lower)};
}

}  // namespace

measured_distance measured(const pose_pair& poses, const triangle3d& s, const triangle3d& t, double most) {
    const rounded_triangles rounded(poses, s, t);
    if (rounded.in_range()) {
        const near_points<double> nearest = rounded.nearest_points();
        const double lower =
            std::max({0.0, rounded.lower_bound(nearest.p - nearest.q), rounded.lower_bound(nearest.normal)});
        const double upper = rounded.upper_bound(nearest);
        if (lower >= most) return {.lower = lower, .upper = std::numeric_limits<double>::infinity()};
        if (lower > 0 && upper - lower <= 4 * rounded.tolerance())
            return by_rounding(rounded, nearest, poses.a.translation, lower, upper);
    }
    return triangles_meet(poses, s, t) ? meeting(poses, s, t) : by_integers(poses, s, t);
}

}  // namespace aabb
