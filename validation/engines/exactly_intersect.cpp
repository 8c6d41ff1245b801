module;
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "exact_decision.hpp"

module aabb.engines;

import :pairwise;

namespace aabb {

namespace {

// Its predicates are exact for all finite doubles, and the test needs no constructions.
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using rational_kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using rational_triangle = triangle3<rational_kernel::FT>;

}  // namespace

bool exactly_intersect(const triangle3d& s, const triangle3d& t) {
    return triangles_intersect<kernel>(s, t);
}

bool exactly_intersect(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    // An affine map of full rank keeps what intersects.
    if (poses.a == poses.b) return exactly_intersect(s, t);
    return triangles_intersect<rational_kernel>(exactly_transformed<rational_triangle>(s, poses.a),
                                                exactly_transformed<rational_triangle>(t, poses.b));
}

bool intersect_exactly(const posed_triangles& pair) {
    return exactly_intersect(pair.poses, pair.s, pair.t);
}

}  // namespace aabb
