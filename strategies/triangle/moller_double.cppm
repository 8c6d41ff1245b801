export module aabb.triangle.moller_double;

import aabb.std;
import aabb.triangle.interval_test;

export namespace aabb {

/// Möller's `interval_test` in double. Still inexact. When to use: to see how many errors of `moller` are due to float.
struct moller_double_triangle : interval_test<double> {
    using interval_test::interval_test;

    static constexpr std::string_view name = "moller_double";
    static constexpr std::string_view summary = "Möller's interval test in double: inexact";

    using interval_test::intersects;
    [[nodiscard]] inline bool intersects(const triangle3f& s, const triangle3f& t) const noexcept {
        return intersects(in_double(s), in_double(t));
    }
};

static_assert(DoubleTrianglePolicy<moller_double_triangle>);

}  // namespace aabb
