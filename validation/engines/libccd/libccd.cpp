module;
#include <ccd/ccd.h>

#include <memory>

module aabb.engines;

import aabb.geometry;
import :engine;
import :pairwise;

namespace aabb {

namespace {

struct ccd_triangle {
    ccd_vec3_t corners[3];

    explicit ccd_triangle(const triangle3f& t) : corners{} {
        for (int i = 0; i < 3; ++i) ccdVec3Set(&corners[i], t[i][0], t[i][1], t[i][2]);
    }

    /// The corner furthest in a direction.
    static void support(const void* triangle, const ccd_vec3_t* direction, ccd_vec3_t* furthest) {
        const auto& corners = static_cast<const ccd_triangle*>(triangle)->corners;
        const ccd_vec3_t* best = &corners[0];
        for (const ccd_vec3_t& corner : corners)
            if (ccdVec3Dot(&corner, direction) > ccdVec3Dot(best, direction)) best = &corner;
        ccdVec3Copy(furthest, best);
    }
};

bool gjk_intersect(const triangle3f& s, const triangle3f& t) {
    const ccd_triangle first(s);
    const ccd_triangle second(t);
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = &ccd_triangle::support;
    ccd.support2 = &ccd_triangle::support;
    // Without a limit it cycles on flat differences of triangles; a decision takes about ten.
    ccd.max_iterations = 1000;
    return ccdGJKIntersect(&first, &second, &ccd) != 0;
}

}  // namespace

engine libccd_engine() {
    return {.name = "libccd",
            .summary =
                "libccd's GJK in double on triangles whose boxes overlap; its tolerances are absolute, so small scales "
                "go wrong",
            .exact = false,
            .meshes = [] { return make_pairwise_engine(candidates_by_cgal, gjk_intersect); }};
}

}  // namespace aabb
