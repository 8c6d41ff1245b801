module;
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "exact_decision.hpp"

module aabb.engines;

namespace aabb {

namespace {

// Its predicates are exact for every finite double, and the decision needs no constructions.
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <class Real>
bool decide(const triangle3<Real>& s, const triangle3<Real>& t) {
    const auto point = [](const vec3<Real>& p) { return kernel::Point_3(p[0], p[1], p[2]); };
    return hulls_intersect<kernel>({point(s[0]), point(s[1]), point(s[2])}, {point(t[0]), point(t[1]), point(t[2])});
}

}  // namespace

bool exactly_intersect(const triangle3f& s, const triangle3f& t) {
    return decide(s, t);
}

bool exactly_intersect(const triangle3d& s, const triangle3d& t) {
    return decide(s, t);
}

}  // namespace aabb
