export module aabb.triangle.moller;

import aabb.std;
import aabb.triangle.interval_test;

export namespace aabb {

/// Möller's `interval_test` in float. Inexact: the original's absolute epsilon causes false positives for small
/// triangles, and without it rounding causes false negatives for touching pairs. When to use: as the classic baseline.
struct moller_triangle : interval_test<float> {
    using interval_test::interval_test;

    static constexpr std::string_view name = "moller";
    static constexpr std::string_view summary = "Möller's interval test in float: inexact, the classic baseline";
};

static_assert(TrianglePolicy<moller_triangle> && !DoubleTrianglePolicy<moller_triangle>);

}  // namespace aabb
