export module aabb.triangle.moller_double;

import aabb.geometry;
import aabb.local_detection;
import aabb.std;
import aabb.triangle.interval_test;

export namespace aabb {

/// Möller's `interval_test` in double. Still inexact. When to use: to tell what of `moller`'s error is its precision.
class moller_double_triangle {
public:
    static constexpr std::string_view name = "moller_double";
    static constexpr std::string_view summary = "Möller's interval test in double: inexact";
    static constexpr bool exact = false;

    struct config {
        epsilon_choice epsilon = epsilon_choice::absolute;
        division_choice division = division_choice::yes;
    };
    static constexpr std::tuple parameters{epsilon_parameter(&config::epsilon), division_parameter(&config::division)};

    moller_double_triangle() = default;
    explicit moller_double_triangle(const config& c) : test_(c.epsilon, c.division) {}

    [[nodiscard]] inline bool intersects(const triangle3f& s, const triangle3f& t) const noexcept {
        return test_.intersects(in_double(s), in_double(t));
    }
    [[nodiscard]] inline bool intersects(const triangle3d& s, const triangle3d& t) const noexcept {
        return test_.intersects(s, t);
    }

private:
    interval_test<double> test_;
};

static_assert(DoubleTrianglePolicy<moller_double_triangle>);

}  // namespace aabb
