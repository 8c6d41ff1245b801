#pragma once
#include <CGAL/Point_3.h>
#include <CGAL/Segment_3.h>
#include <CGAL/Triangle_3.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <iterator>
#include <type_traits>

namespace aabb {

/// Calls `visit` with the triangle, segment or point that three points span: CGAL's tests exclude degenerate ones.
template <class Kernel>
[[nodiscard]] auto with_hull(const typename Kernel::Point_3 (&p)[3], const auto& visit) {
    if (!CGAL::collinear(p[0], p[1], p[2])) return visit(typename Kernel::Triangle_3(p[0], p[1], p[2]));
    // On a line, the lexicographic order of points is their order along it.
    const auto [first, last] = std::minmax_element(std::begin(p), std::end(p));
    if (*first == *last) return visit(*first);
    return visit(typename Kernel::Segment_3(*first, *last));
}

/// Do the hulls share a point? Exact with CGAL's kernels with exact predicates.
template <class Kernel>
[[nodiscard]] bool hulls_intersect(const typename Kernel::Point_3 (&p)[3], const typename Kernel::Point_3 (&q)[3]) {
    return with_hull<Kernel>(p, [&](const auto& s) {
        return with_hull<Kernel>(q, [&](const auto& t) { return bool{CGAL::do_intersect(s, t)}; });
    });
}

/// Do two triangles share a point? Zero-area ones count as segments or points.
template <class Kernel>
[[nodiscard]] bool triangles_intersect(const auto& s, const auto& t) {
    const auto point = [](const auto& p) { return typename Kernel::Point_3(p[0], p[1], p[2]); };
    return hulls_intersect<Kernel>({point(s[0]), point(s[1]), point(s[2])}, {point(t[0]), point(t[1]), point(t[2])});
}

/// The triangle of a mesh at a pose in world coordinates R v + t, as a Triangle of exact numbers.
template <class Triangle>
[[nodiscard]] Triangle exactly_transformed(const auto& t, const auto& at) {
    Triangle world;
    using number = std::remove_cvref_t<decltype(world[0][0])>;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            world[i][k] = number(at.translation[k]);
            for (int j = 0; j < 3; ++j)
                world[i][k] += number(at.rotation[static_cast<std::size_t>(3 * k + j)]) * number(double{t[i][j]});
        }
    return world;
}

}  // namespace aabb
