module;
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <boost/variant.hpp>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "exact_decision.hpp"

module aabb.exact_intersection;

namespace aabb {

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using point_3 = kernel::Point_3;
using segment_3 = kernel::Segment_3;
using triangle_3 = kernel::Triangle_3;
using exact_hull = std::variant<point_3, segment_3, triangle_3>;
using exact_number = kernel::FT::ET;
using exact_point = std::array<exact_number, 3>;

exact_hull exact_hull_of(const triangle3d& t, const pose& at) {
    const auto world = exactly_transformed<triangle3<kernel::FT>>(t, at);
    const auto point = [](const auto& p) { return point_3(p[0], p[1], p[2]); };
    return with_hull<kernel>({point(world[0]), point(world[1]), point(world[2])},
                             [](const auto& h) { return exact_hull(h); });
}

/// The corners of a shape that CGAL returns.
struct corners_in_shape {
    using result_type = std::vector<point_3>;
    result_type operator()(const point_3& p) const { return {p}; }
    result_type operator()(const segment_3& s) const { return {s.source(), s.target()}; }
    result_type operator()(const triangle_3& t) const { return {t[0], t[1], t[2]}; }
    result_type operator()(const result_type& polygon) const { return polygon; }
};

/// CGAL 6 returns variants of the standard library, CGAL 5 those of Boost.
template <class Variant>
std::vector<point_3> corners_in(const Variant& shape) {
    if constexpr (requires { shape.which(); })
        return boost::apply_visitor(corners_in_shape{}, shape);
    else
        return std::visit(corners_in_shape{}, shape);
}

/// The corners of the intersection of two hulls.
struct common_corners {
    using corners = std::vector<point_3>;
    corners operator()(const point_3& s, const point_3& t) const { return s == t ? corners{s} : corners{}; }
    corners operator()(const point_3& s, const auto& t) const { return t.has_on(s) ? corners{s} : corners{}; }
    corners operator()(const auto& s, const point_3& t) const { return (*this)(t, s); }
    /// Intersects two triangles or segments by CGAL, each corner only once; the overloads above are for points.
    corners operator()(const auto& s, const auto& t) const {
        const auto shape = CGAL::intersection(s, t);
        if (!shape) return {};
        corners distinct;
        for (const point_3& p : corners_in(*shape))
            if (std::ranges::find(distinct, p) == distinct.end()) distinct.push_back(p);
        return distinct;
    }
};

/// Whether p, a point of the hull, lies on no edge of it.
bool is_interior(const exact_hull& h, const point_3& p) {
    const auto* const t = std::get_if<triangle_3>(&h);
    if (t == nullptr) return false;
    for (int i = 0; i < 3; ++i)
        if (segment_3(t->vertex(i), t->vertex(i + 1)).has_on(p)) return false;
    return true;
}

/// The kind of the intersection of g and h by its corners. With more than two, triangles overlap in their common plane.
/// A segment is transversal if its middle, and so all but its ends, is inside both triangles, on no edge.
intersection_kind kind_of(const std::vector<point_3>& corners, const exact_hull& g, const exact_hull& h) {
    if (corners.empty()) return intersection_kind::none;
    if (corners.size() == 1) return intersection_kind::point;
    if (corners.size() > 2) return intersection_kind::overlap;
    const point_3 middle = CGAL::midpoint(corners[0], corners[1]);
    return is_interior(g, middle) && is_interior(h, middle) ? intersection_kind::transversal
                                                            : intersection_kind::segment;
}

/// Adds the distances on the axes of a computed corner from the exact one, in exact numbers.
/// @param errors of all corners so far: whether all are within their bounds, the greatest ratio of an error to its
/// bound (`of_bound`), and the greatest error with its bound
void add_errors(corner_errors& errors, const vec3d& computed, const exact_point& corner, const vec3d& bounds) {
    for (int k = 0; k < 3; ++k) {
        const exact_number error = CGAL::abs(exact_number(computed[k]) - corner[static_cast<std::size_t>(k)]);
        if (CGAL::is_zero(error)) continue;
        const exact_number bound(bounds[k]);
        errors.within &= error <= bound;
        errors.of_bound = std::max(
            errors.of_bound, bounds[k] == 0 ? std::numeric_limits<double>::infinity() : CGAL::to_double(error / bound));
        if (CGAL::to_double(error) <= errors.greatest) continue;
        errors.greatest = CGAL::to_double(error);
        errors.bound = bounds[k];
    }
}

/// A way to match computed with exact corners, and their greatest distance on an axis, halved.
struct alignment {
    double distance = 0;
    std::array<std::size_t, 6> order{};  // indices of exact corners by computed corner
};

/// All alignments of a polygon's corners, nearest first: computed ones may begin anywhere and run in either direction.
std::vector<alignment> alignments_of(const triangle_intersection& computed, const std::vector<exact_point>& exact) {
    const std::size_t size = exact.size();
    std::array<vec3d, 6> approximate{};
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t k = 0; k < 3; ++k) approximate[i][static_cast<int>(k)] = CGAL::to_double(exact[i][k]);
    std::vector<alignment> alignments;
    for (std::size_t first = 0; first < size; ++first)
        for (const std::size_t step : {std::size_t{1}, size - 1}) {
            alignment& a = alignments.emplace_back();
            for (std::size_t i = 0; i < size; ++i) {
                a.order[i] = (first + i * step) % size;
                for (int k = 0; k < 3; ++k)  // halves, since a difference of greatest doubles would overflow
                    a.distance =
                        std::max(a.distance, std::abs(computed.corners[i][k] / 2 - approximate[a.order[i]][k] / 2));
            }
        }
    std::ranges::sort(alignments, {}, &alignment::distance);
    return alignments;
}

}  // namespace

struct exact_intersection::construction {
    intersection_kind kind;
    std::vector<exact_point> corners;
};

/// Computes corners and kind. CGAL would evaluate coordinates only on demand, so `CGAL::exact` does it here.
exact_intersection::exact_intersection(const pose_pair& poses, const triangle3d& s, const triangle3d& t)
    : construction_(std::make_unique<construction>()) {
    const exact_hull g = exact_hull_of(s, poses.a), h = exact_hull_of(t, poses.b);
    const std::vector<point_3> corners = std::visit(common_corners{}, g, h);
    construction_->kind = kind_of(corners, g, h);
    for (const point_3& p : corners) {
        const auto& exact = CGAL::exact(p);
        construction_->corners.push_back({exact.x(), exact.y(), exact.z()});
    }
}

exact_intersection::~exact_intersection() = default;

intersection_kind exact_intersection::kind() const {
    return construction_->kind;
}

/// The intersection in double: each coordinate is the middle of CGAL's interval of doubles that contains the exact
/// one. The width of the interval bounds the error, which is stated per axis for all corners.
triangle_intersection exact_intersection::rounded() const {
    triangle_intersection common;
    common.kind = construction_->kind;
    for (const exact_point& corner : construction_->corners) {
        vec3d& point = common.corners[common.size++];
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = CGAL::to_interval(corner[static_cast<std::size_t>(k)]);
            point[k] = low / 2 + high / 2;
            // Halves of the smallest denormals are rounded, which may lead out of the interval.
            if (point[k] < low || point[k] > high) point[k] = low;
            common.error[k] = std::max(common.error[k], high - low);
        }
    }
    return common;
}

/// The errors of computed corners, under the nearest alignment with the exact corners that is within the stated errors;
/// if there is none, under the alignment with the least ratio to the stated errors.
corner_errors exact_intersection::errors_of(const triangle_intersection& computed) const {
    corner_errors best;
    const std::size_t size = construction_->corners.size();
    best.same = computed.kind == construction_->kind && computed.size == size;
    best.within = best.same && size == 0;
    if (!best.same || size == 0) return best;
    best.of_bound = std::numeric_limits<double>::infinity();
    for (const alignment& a : alignments_of(computed, construction_->corners)) {
        corner_errors errors{.same = true, .within = true};
        for (std::size_t i = 0; i < size; ++i)
            add_errors(errors, computed.corners[i], construction_->corners[a.order[i]], computed.error);
        if (errors.within || errors.of_bound < best.of_bound) best = errors;
        if (best.within) break;
    }
    return best;
}

}  // namespace aabb
