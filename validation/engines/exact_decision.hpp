#pragma once
#include <CGAL/Point_3.h>
#include <CGAL/Segment_3.h>
#include <CGAL/Triangle_3.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <variant>

namespace aabb {

/// What three points span. CGAL's tests of triangles and segments exclude degenerate ones.
template <class Kernel>
using hull = std::variant<typename Kernel::Point_3, typename Kernel::Segment_3, typename Kernel::Triangle_3>;

template <class Kernel>
[[nodiscard]] hull<Kernel> hull_of(const typename Kernel::Point_3 (&p)[3]) {
    if (!CGAL::collinear(p[0], p[1], p[2])) return typename Kernel::Triangle_3(p[0], p[1], p[2]);
    // On a line, the lexicographic order of points is their order along it.
    const auto [first, last] = std::minmax_element(std::begin(p), std::end(p));
    if (*first == *last) return *first;
    return typename Kernel::Segment_3(*first, *last);
}

/// Do the hulls share a point? Exact in CGAL's kernels with exact predicates.
template <class Kernel>
[[nodiscard]] bool hulls_intersect(const typename Kernel::Point_3 (&p)[3], const typename Kernel::Point_3 (&q)[3]) {
    return std::visit([](const auto& s, const auto& t) { return bool{CGAL::do_intersect(s, t)}; }, hull_of<Kernel>(p),
                      hull_of<Kernel>(q));
}

}  // namespace aabb
