module;
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include "../engines/exact_decision.hpp"

module aabb.truth;

namespace aabb {

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using rational = kernel::FT;
using exact_triangle = triangle3<rational>;

template <class Real>
triangle3<Real> converted_to(const auto& t) {
    triangle3<Real> result;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) result[i][k] = Real(double{t[i][k]});
    return result;
}

template <class Real>
vec3<Real> normal_of(const triangle3<Real>& t) {
    return cross(t[1] - t[0], t[2] - t[0]);
}

template <class Real>
bool is_zero(const vec3<Real>& v) {
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool has_no_area(const triangle3d& t) {
    return is_zero(normal_of(converted_to<rational>(t)));
}

bool are_coplanar(const exact_triangle& s, const exact_triangle& t) {
    const vec3<rational> normal = normal_of(s);
    for (int i = 0; i < 3; ++i)
        if (dot(normal, t[i] - s[0]) != 0) return false;
    return true;
}

/// Normals of the facets of the triangles' Minkowski difference: the directions of least penetration of triangles that
/// are not coplanar are among these. Zero vectors (parallel edges) are left out.
template <class Real>
std::vector<vec3<Real>> facet_axes(const triangle3<Real>& s, const triangle3<Real>& t) {
    std::vector<vec3<Real>> axes = {normal_of(s), normal_of(t)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes.push_back(cross(s[(i + 1) % 3] - s[i], t[(j + 1) % 3] - t[j]));
    std::erase_if(axes, is_zero<Real>);
    return axes;
}

/// The distance of the projections on an axis, times the axis' length; negative if they overlap.
template <class Real>
Real gap_along(const triangle3<Real>& s, const triangle3<Real>& t, const vec3<Real>& axis) {
    const Real projections_s[3] = {dot(axis, s[0]), dot(axis, s[1]), dot(axis, s[2])};
    const Real projections_t[3] = {dot(axis, t[0]), dot(axis, t[1]), dot(axis, t[2])};
    const Real t_above = *std::ranges::min_element(projections_t) - *std::ranges::max_element(projections_s);
    const Real s_above = *std::ranges::min_element(projections_s) - *std::ranges::max_element(projections_t);
    return std::max(t_above, s_above);
}

/// Whether intersecting triangles that are not coplanar touch without crossing.
bool only_touch(const exact_triangle& s, const exact_triangle& t) {
    return std::ranges::any_of(facet_axes(s, t), [&](const auto& axis) { return gap_along(s, t, axis) == 0; });
}

/// The distance, or negative penetration depth: the greatest gap over all directions that closest features can have,
/// which are normal to a facet or to two edges, join two corners, or lead from a corner straight to an edge.
double signed_distance(const triangle3d& s, const triangle3d& t) {
    std::vector<vec3d> axes = facet_axes(s, t);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const vec3d between_corners = t[j] - s[i];
            axes.push_back(between_corners);
            for (const triangle3d* u : {&s, &t})
                for (int k = 0; k < 3; ++k) {
                    const vec3d edge = (*u)[(k + 1) % 3] - (*u)[k];
                    axes.push_back(cross(edge, cross(between_corners, edge)));
                }
        }
    double greatest = -std::numeric_limits<double>::infinity();
    for (const vec3d& axis : axes)
        if (const double length = std::sqrt(dot(axis, axis)); length > 0)
            greatest = std::max(greatest, gap_along(s, t, axis) / length);
    return greatest;
}

/// Whether a displacement of a millionth of the pair's extent can change the result, so that rounding may as well.
bool are_near(const triangle3f& s, const triangle3f& t) {
    const box bounds = merged(bounds_of(s), bounds_of(t));
    const int axis = longest_axis(bounds);
    const double extent = double{bounds.max[axis]} - double{bounds.min[axis]};
    // Relative to a corner, which avoids cancellation far from the origin.
    triangle3d local_s = converted_to<double>(s), local_t = converted_to<double>(t);
    const vec3d origin = local_s[0];
    for (int i = 0; i < 3; ++i) {
        local_s[i] = local_s[i] - origin;
        local_t[i] = local_t[i] - origin;
    }
    return std::abs(signed_distance(local_s, local_t)) <= 1e-6 * extent;
}

/// The class of a wrong result: the first that applies.
/// @param s,t as they are given
/// @param s_in_float,image_of_t as floats in the frame of the first mesh
/// @param engine_result whether the engine reports the pair
difference_class class_of_difference(const triangle3d& s, const triangle3d& t, const pose_pair& poses,
                                     const triangle3f& s_in_float, const triangle3f& image_of_t, bool engine_result) {
    if (has_no_area(s) || has_no_area(t)) return difference_class::degenerate;
    if (triangles_intersect<kernel>(converted_to<rational>(s_in_float), converted_to<rational>(image_of_t)) ==
        engine_result)
        return difference_class::pose_rounding;
    const exact_triangle exact_s = exactly_transformed<exact_triangle>(s, poses.a),
                         exact_t = exactly_transformed<exact_triangle>(t, poses.b);
    if (are_coplanar(exact_s, exact_t)) return difference_class::coplanar;
    if (!engine_result && only_touch(exact_s, exact_t)) return difference_class::touching;
    if (are_near(s_in_float, image_of_t)) return difference_class::near;
    return difference_class::other;
}

}  // namespace

differences& differences::operator+=(const differences& other) {
    for (std::size_t c = 0; c < false_negatives.size(); ++c) {
        false_negatives[c] += other.false_negatives[c];
        false_positives[c] += other.false_positives[c];
    }
    return *this;
}

/// Classifies each pair that is in only one of the two lists.
differences compare_triangle_pairs(std::span<const index_pair> exact, std::span<const index_pair> reported,
                                   const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b) {
    const relative_pose to_a(pose_a, pose_b, bounds_of(b), a.frame, b.frame);
    differences counts;
    const auto count = [&](index_pair pair, bool engine_result) {
        auto& classes = engine_result ? counts.false_positives : counts.false_negatives;
        ++classes[static_cast<std::size_t>(class_of_difference(a.given_triangle(pair.a), b.given_triangle(pair.b),
                                                               {pose_a, pose_b}, a.triangle(pair.a),
                                                               to_a(b.triangle(pair.b)), engine_result))];
    };
    std::vector<index_pair> false_negatives, false_positives;
    std::ranges::set_difference(exact, reported, std::back_inserter(false_negatives));
    std::ranges::set_difference(reported, exact, std::back_inserter(false_positives));
    for (const index_pair pair : false_negatives) count(pair, /*engine_result=*/false);
    for (const index_pair pair : false_positives) count(pair, /*engine_result=*/true);
    return counts;
}

}  // namespace aabb
