module;
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include "../exact_decision.hpp"

module aabb.engines;

import :engine;

namespace aabb {

namespace {

struct epick_test {
    static constexpr std::string_view name = "epick";
    static constexpr std::string_view summary =
        "CGAL's kernel with exact predicates and inexact constructions: exact, signs filtered by intervals";

    template <class Real>
    [[nodiscard]] static bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) {
        return exactly_intersect(s, t);
    }
};

struct epeck_test {
    static constexpr std::string_view name = "epeck";
    static constexpr std::string_view summary =
        "CGAL's kernel with exact predicates and exact constructions: exact, numbers stay intervals until exact ones "
        "are needed";

    template <class Real>
    [[nodiscard]] static bool intersects(const triangle3<Real>& s, const triangle3<Real>& t) {
        return triangles_intersect<CGAL::Exact_predicates_exact_constructions_kernel>(s, t);
    }

    [[nodiscard]] static triangle_intersection intersection(const triangle3d& s, const triangle3d& t) {
        return exact_intersection(s, t).rounded();
    }
};

}  // namespace

std::vector<library_test> cgal_tests() {
    return {library_test_of<epick_test>(), library_test_of<epeck_test>()};
}

}  // namespace aabb
