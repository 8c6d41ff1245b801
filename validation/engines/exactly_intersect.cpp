module;
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "exact_decision.hpp"

module aabb.engines;

namespace aabb {

// Its predicates are exact for all finite doubles, and the test needs no constructions.
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

bool exactly_intersect(const triangle3f& s, const triangle3f& t) {
    return triangles_intersect<kernel>(s, t);
}

bool exactly_intersect(const triangle3d& s, const triangle3d& t) {
    return triangles_intersect<kernel>(s, t);
}

}  // namespace aabb
