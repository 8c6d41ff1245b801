module;
#include <ccd/ccd.h>

module aabb.engines;

import :engine;
import :pairwise;

namespace aabb {

namespace {

struct ccd_triangle {
    ccd_vec3_t corners[3];
    mutable unsigned long calls_left;

    template <class Real>
    ccd_triangle(const triangle3<Real>& t, unsigned long calls) : corners{}, calls_left(calls) {
        for (int i = 0; i < 3; ++i) ccdVec3Set(&corners[i], t[i][0], t[i][1], t[i][2]);
    }

    /// The support function: the furthest corner in a direction.
    static void support(const void* triangle, const ccd_vec3_t* direction, ccd_vec3_t* furthest) {
        const auto& corners = static_cast<const ccd_triangle*>(triangle)->corners;
        const ccd_vec3_t* best = &corners[0];
        for (const ccd_vec3_t& corner : corners)
            if (ccdVec3Dot(&corner, direction) > ccdVec3Dot(best, direction)) best = &corner;
        ccdVec3Copy(furthest, best);
    }

    /// The support function with a limit on calls, after which it returns a point so far behind that no intersection is
    /// found. Otherwise MPR would search for its first portal forever if the triangles are coplanar.
    static void limited_support(const void* triangle, const ccd_vec3_t* direction, ccd_vec3_t* furthest) {
        support(triangle, direction, furthest);
        unsigned long& left = static_cast<const ccd_triangle*>(triangle)->calls_left;
        if (left > 0) {
            --left;
            return;
        }
        ccdVec3Copy(furthest, direction);
        ccdVec3Scale(furthest, -1e150);
    }

    static void centre(const void* triangle, ccd_vec3_t* middle) {
        const auto& corners = static_cast<const ccd_triangle*>(triangle)->corners;
        ccdVec3Copy(middle, &corners[0]);
        ccdVec3Add(middle, &corners[1]);
        ccdVec3Add(middle, &corners[2]);
        ccdVec3Scale(middle, 1.0 / 3);
    }
};

/// The default limit: both algorithms may cycle on flat Minkowski differences; a test takes about ten iterations.
constexpr std::uint32_t default_iterations = 1000;

/// A test of two triangles by one of libccd's algorithms.
class ccd_test {
public:
    static constexpr bool exact = false;

    template <class Real>
    [[nodiscard]] bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) const {
        const ccd_triangle first(s, ccd_.max_iterations);
        const ccd_triangle second(t, ccd_.max_iterations);
        return algorithm_(&first, &second, &ccd_) != 0;
    }

protected:
    /// @param algorithm GJK or MPR; it knows a triangle by its support function and, for MPR, its centre
    /// @param iterations after which the triangles count as disjoint
    ccd_test(decltype(&ccdGJKIntersect) algorithm, std::uint32_t iterations) : algorithm_(algorithm) {
        CCD_INIT(&ccd_);
        ccd_.support1 = &ccd_triangle::support;
        ccd_.support2 = &ccd_triangle::support;
        ccd_.center1 = &ccd_triangle::centre;
        ccd_.center2 = &ccd_triangle::centre;
        ccd_.max_iterations = iterations;
    }

    ccd_t ccd_;

private:
    decltype(&ccdGJKIntersect) algorithm_;
};

class gjk_test : public ccd_test {
public:
    static constexpr std::string_view name = "gjk";
    static constexpr std::string_view summary =
        "libccd's GJK in double: inexact, since its tolerance is absolute: it is wrong at small scales";

    struct config {
        std::uint32_t iterations = default_iterations;
    };
    static constexpr std::tuple parameters{integer_parameter{"iterations", &config::iterations, 1U, 1000000U,
                                                             "after which the triangles count as disjoint"}};

    explicit gjk_test(const config& c) : ccd_test(ccdGJKIntersect, c.iterations) {}
};

class mpr_test : public ccd_test {
public:
    static constexpr std::string_view name = "mpr";
    static constexpr std::string_view summary =
        "libccd's Minkowski portal refinement in double: inexact, its tolerance is absolute too";

    struct config {
        double tolerance = 1e-4;  ///< libccd's default
        std::uint32_t iterations = default_iterations;
    };
    static constexpr std::tuple parameters{
        number_parameter{"tolerance", &config::tolerance, 0.0, 1e6, "by which a portal must still move to be refined"},
        integer_parameter{"iterations", &config::iterations, 1U, 1000000U,
                          "after which the triangles count as disjoint"}};

    explicit mpr_test(const config& c) : ccd_test(ccdMPRIntersect, c.iterations) {
        ccd_.mpr_tolerance = c.tolerance;
        ccd_.support1 = &ccd_triangle::limited_support;
    }
};

bool gjk_intersect(const posed_triangles& pair) {
    static const gjk_test test({});
    return test.intersects(pair.s_in_float, pair.image_of_t);
}

}  // namespace

engine libccd_engine() {
    return {.name = "libccd",
            .summary =
                "libccd's GJK in double on triangles whose boxes overlap; its tolerances are absolute, so it is "
                "wrong at small scales",
            .exact = false,
            .meshes = [] { return make_pairwise_engine(candidates_by_cgal, gjk_intersect); },
            .triangles = {library_test_of<gjk_test>(), library_test_of<mpr_test>()}};
}

}  // namespace aabb
