export module aabb.triangle.moller;

import aabb.geometry;
import aabb.local_detection;
import aabb.std;
import aabb.triangle.interval_test;

export namespace aabb {

/// Möller's `interval_test` in float. Inexact: the original's absolute epsilon takes near misses of small triangles for
/// hits, and without it rounding loses pairs that touch. When to use: as the classic baseline.
class moller_triangle {
public:
    static constexpr std::string_view name = "moller";
    static constexpr std::string_view summary = "Möller's interval test in float: inexact, the classic baseline";
    static constexpr bool exact = false;

    struct config {
        epsilon_choice epsilon = epsilon_choice::absolute;
        division_choice division = division_choice::yes;
    };
    static constexpr std::tuple parameters{epsilon_parameter(&config::epsilon), division_parameter(&config::division)};

    moller_triangle() = default;
    explicit moller_triangle(const config& c) : test_(c.epsilon, c.division) {}

    [[nodiscard]] inline bool intersects(const triangle3f& s, const triangle3f& t) const noexcept {
        return test_.intersects(s, t);
    }

private:
    interval_test<float> test_;
};

static_assert(TrianglePolicy<moller_triangle>);

}  // namespace aabb
