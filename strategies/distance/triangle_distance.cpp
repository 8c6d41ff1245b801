module aabb.distance.triangle_distance;

import aabb.triangle.intersection;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// A common point of triangles that intersect.
measured_distance meeting(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    const triangle_intersection common = intersection_of(poses, s, t);
    const vec3d& at = common.corners.front();
    // Corners of triangles at poses are rounded by 2 u of a coordinate.
    double error = 0;
    for (int k = 0; k < 3; ++k) error += common.error[k] + 0x1p-51 * std::abs(at[k]);
    return {.p = at, .q = at, .point_error = error};
}

}  // namespace

/// The exact distance squared has a relative error of 2^-51, its root half of that and another u: 2^-50 covers both.
measured_distance measured(const pose_pair& poses, const triangle3d& s, const triangle3d& t, double most) {
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    const rounded_triangles rounded(poses, s, t);
    if (!rounded.in_range()) {
        if (triangles_meet(poses, s, t)) return meeting(poses, s, t);
        throw input_error("the distance of triangles in less than 1e-60 or in more than 1e60 is not measured");
    }
    const near_points nearest = rounded.nearest_points();
    measured_distance result{
        .lower = std::max({0.0, rounded.lower_bound(nearest.p - nearest.q), rounded.lower_bound(nearest.normal)}),
        .upper = rounded.upper_bound(nearest)};
    if (result.lower >= most) return {.lower = result.lower, .upper = std::numeric_limits<double>::infinity()};
    result.value = std::sqrt(nearest.squared);
    if (result.lower == 0 || result.upper - result.lower > 4 * rounded.tolerance()) {
        if (triangles_meet(poses, s, t)) return meeting(poses, s, t);
        const auto [mantissa, exponent] = disjoint_triangles(poses, s, t).squared_distance();
        const bool is_even = exponent % 2 == 0;
        // Below the normal numbers, a value is off by up to the least double; that of triangles apart is not 0.
        constexpr double least = std::numeric_limits<double>::denorm_min();
        const double root = std::sqrt(is_even ? mantissa : 2 * mantissa);
        result.value = std::max(least, std::ldexp(root, (is_even ? exponent : exponent - 1) / 2));
        result.lower = std::max(0.0, result.value * (1 - 0x1p-50) - least);
        result.upper = result.value * (1 + 0x1p-50) + least;
    }
    const vec3d& translation = poses.a.translation;
    const vec3d origin = rounded.origin() + translation;
    result.p = origin + nearest.p;
    result.q = origin + nearest.q;
    double magnitude = 0;
    for (int k = 0; k < 3; ++k)
        magnitude +=
            std::abs(rounded.origin()[k]) + std::abs(translation[k]) + std::abs(nearest.p[k]) + std::abs(nearest.q[k]);
    // Where edges are nearly parallel, the points may be off along them: then their distance shows it.
    const vec3d between = nearest.p - nearest.q;
    result.point_error =
        rounded.tolerance() + 4 * unit * magnitude + std::abs(std::sqrt(dot(between, between)) - result.value);
    return result;
}

}  // namespace aabb
