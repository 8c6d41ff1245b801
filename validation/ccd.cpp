module;
#include <ccd/ccd.h>

module aabb.validation;

import aabb;
import :parts;

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

}  // namespace

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

}  // namespace aabb
