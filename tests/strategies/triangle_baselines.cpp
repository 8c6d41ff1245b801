#include "../compositions.hpp"
#include "../triangle_pairs.hpp"

import aabb.strategies;
import aabb.triangle.interval_test;
import aabb.triangle.precision;

using namespace aabb;

namespace {

triangle3f any_triangle(triangle_pairs::generator& random) {
    triangle3f t{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) t[i][k] = static_cast<float>(triangle_pairs::integer(random, -9999, 9999)) / 3000;
    return t;
}

const triangle3f face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

/// Pairs of every pattern and placement, and of coordinates of every size.
template <class Real, class Check>
void for_all_pairs(int count, Check check) {
    triangle_pairs::generator random(7);
    const auto check_pair = [&](const triangle_pairs::pair& pair) {
        check(triangle_pairs::as<triangle3<Real>>(pair[0]), triangle_pairs::as<triangle3<Real>>(pair[1]));
    };
    for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
        for (std::size_t placement = 0; placement < triangle_pairs::placements.size(); ++placement)
            for (int i = 0; i < count; ++i)
                check_pair(triangle_pairs::placed<Real>(random, triangle_pairs::patterned(random, pattern), placement));
    for (int i = 0; i < 20 * count; ++i) check_pair(triangle_pairs::spread<Real>(random));
}

template <class Real>
void check_intervals() {
    const interval_arithmetic_triangle with_fallback;
    const interval_arithmetic_triangle without_fallback({.fallback = fallback_choice::intersects});
    int wrong = 0;
    int false_negatives = 0;
    int false_positives = 0;
    for_all_pairs<Real>(400, [&](const triangle3<Real>& s, const triangle3<Real>& t) {
        const bool truth = exact_triangle::intersects(s, t);
        wrong += with_fallback.intersects(s, t) != truth;
        const bool result = without_fallback.intersects(s, t);
        false_negatives += truth && !result;
        false_positives += result && !truth;
    });
    CHECK(wrong == 0);
    CHECK(false_negatives == 0);
    CHECK(false_positives > 0);
}

}  // namespace

TEST_CASE("every triangle test decides generic pairs, in either order") {
    triangle_pairs::generator random(5);
    for (const strategy_choice& choice : all_choices(strategy_kind::triangle)) {
        INFO(to_text(choice));
        const auto test = make_triangle_test(choice);
        int hits = 0;
        for (int i = 0; i < 3000; ++i) {
            const triangle3f s = any_triangle(random);
            const triangle3f t = any_triangle(random);
            const bool truth = exact_triangle::intersects(s, t);
            hits += truth;
            REQUIRE(test->intersects(s, t) == truth);
            REQUIRE(test->intersects(t, s) == truth);
        }
        CHECK(hits > 300);
    }
}

TEST_CASE("every triangle test decides clear pairs") {
    const std::vector<std::pair<triangle3f, bool>> others{{{{{1, 1, -1}, {1, 1, 1}, {5, 5, 1}}}, true},
                                                          {{{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}, false},
                                                          {{{{1, 0, 0}, {2, 0, 0}, {1, -1, 1}}}, true},
                                                          // Coplanar pairs.
                                                          {{{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, true},
                                                          {{{{1, 1, 0}, {1, 2, 0}, {2, 1, 0}}}, true},
                                                          {{{{2, 3, 0}, {3, 2, 0}, {4, 4, 0}}}, false},
                                                          {{{{2, 3, 0}, {4, 4, 0}, {3, 2, 0}}}, false}};
    for (const strategy_choice& choice : all_choices(strategy_kind::triangle)) {
        const auto test = make_triangle_test(choice);
        for (std::size_t i = 0; i < others.size(); ++i) {
            INFO(to_text(choice) << ", triangle " << i);
            CHECK(test->intersects(face, others[i].first) == others[i].second);
            CHECK(test->intersects(others[i].first, face) == others[i].second);
        }
        INFO(to_text(choice));
        CHECK(test->intersects(face, {{{3, 3, 0}, {1, 1, 0}, {4, 4, 0}}}));
        // Intervals alone leave it undecided.
        if (choice.settings != std::vector<setting>{{"fallback", "intersects"}})
            CHECK_FALSE(test->intersects(face, {{{3, 3, -1}, {3, 3, 1}, {5, 5, 1}}}));
    }
}

TEST_CASE("the epsilon of Möller's test is absolute, absent or scaled to the pair") {
    // Two triangles a hundredth of a unit in size, one a tenth of that above the other.
    const triangle3f low{{{0, 0, 0}, {0.01F, 0, 0}, {0, 0.01F, 0}}};
    const triangle3f high{{{0, 0, 0.001F}, {0.01F, 0, 0.001F}, {0, 0.01F, 0.001F}}};
    const auto intersects = [&](const char* test, const char* epsilon) {
        return make_triangle_test({test, {{"epsilon", epsilon}}})->intersects(low, high);
    };
    for (const char* test : {"moller", "moller_double"}) {
        INFO(test);
        CHECK(intersects(test, "absolute"));
        CHECK_FALSE(intersects(test, "none"));
        CHECK_FALSE(intersects(test, "scaled"));
    }
    // A corner that rounding moves a little off the plane in which it lies.
    const triangle3f slanted{{{0.1F, 0.2F, 0.3F}, {7.3F, 1.9F, 5.1F}, {3.7F, 9.1F, 2.3F}}};
    vec3f centroid{};
    for (int k = 0; k < 3; ++k) centroid[k] = (slanted[0][k] + slanted[1][k] + slanted[2][k]) / 3;
    int tested = 0;
    int missed = 0;
    int missed_scaled = 0;
    for (int i = 0; i < 4000; ++i) {
        const float a = 1 + static_cast<float>(i % 200) / 7;
        vec3f tip = centroid;
        const int step = i / 200 - 10;
        tip[2] += static_cast<float>(step) * 0x1p-22F;
        const float down = i % 2 == 0 ? 9 : -9;
        const triangle3f other{{tip, {tip[0] + a, tip[1] - 2, tip[2] - down}, {tip[0] + 3, tip[1] - a, tip[2] - down}}};
        if (!exact_triangle::intersects(slanted, other)) continue;
        ++tested;
        missed += !moller_triangle(moller_triangle::config{.epsilon = epsilon_choice::none}).intersects(slanted, other);
        missed_scaled +=
            !moller_triangle(moller_triangle::config{.epsilon = epsilon_choice::scaled}).intersects(slanted, other);
    }
    CHECK(tested > 100);
    CHECK(missed > 0);
    CHECK(missed_scaled == 0);
}

TEST_CASE("tests in double do not round doubles") {
    const triangle3d base{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const triangle3d above{{{0.25, 0.25, 1e-12}, {0.5, 0.25, 1}, {0.25, 0.5, 1}}};
    const triangle3d below{{{0.25, 0.25, -1e-12}, {0.5, 0.25, 1}, {0.25, 0.5, 1}}};
    for (const char* name : {"devillers_guigue", "exact"}) {
        INFO(name);
        CHECK_FALSE(make_triangle_test({name, {}})->intersects(base, above));
        CHECK(make_triangle_test({name, {}})->intersects(base, below));
    }
    const auto bare = make_triangle_test({"moller_double", {{"epsilon", "none"}}});
    CHECK_FALSE(bare->intersects(base, above));
    CHECK(bare->intersects(base, below));
    CHECK(make_triangle_test({"moller_double", {}})->intersects(base, above));
}

TEST_CASE("a test in plain double has errors where the exact test has none") {
    triangle_pairs::generator random(11);
    int wrong = 0;
    for (int i = 0; i < 3000; ++i) {
        // A corner in the plane of a face, at tenths that double cannot hold.
        const auto pair = triangle_pairs::placed<double>(random, triangle_pairs::patterned(random, 3), 1);
        const auto s = triangle_pairs::as<triangle3d>(pair[0]);
        const auto t = triangle_pairs::as<triangle3d>(pair[1]);
        wrong += devillers_guigue_triangle{}.intersects(s, t) != exact_triangle::intersects(s, t);
    }
    CHECK_BETWEEN(0, wrong, 1500);
}

TEST_CASE("intervals decide exactly with their fallback, and miss no pair without it") {
    check_intervals<float>();
    check_intervals<double>();
}

TEST_CASE("inexact tests err on touching pairs, less often in double") {
    const devillers_guigue_triangle guigue_float({.precision = precision_choice::float32});
    const separating_axes_triangle axes_float;
    const separating_axes_triangle axes_double({.precision = precision_choice::float64});
    int guigue_errors = 0;
    int axes_errors = 0;
    int axes_double_errors = 0;
    triangle_pairs::generator random(3);
    for (int i = 0; i < 3000; ++i) {
        // A corner in the plane of a face, rotated so that floats only come near the plane.
        const auto [a, b] = triangle_pairs::placed<float>(random, triangle_pairs::patterned(random, 3), 5);
        const triangle3f s = triangle_pairs::as<triangle3f>(a);
        const triangle3f t = triangle_pairs::as<triangle3f>(b);
        const bool truth = exact_triangle::intersects(s, t);
        guigue_errors += guigue_float.intersects(s, t) != truth;
        axes_errors += axes_float.intersects(s, t) != truth;
        axes_double_errors += axes_double.intersects(s, t) != truth;
    }
    CHECK(guigue_errors > 0);
    CHECK(axes_errors > 0);
    CHECK(axes_double_errors < axes_errors);
}

TEST_CASE("Möller's test without division leaves the range of float sooner") {
    const moller_triangle divided({.epsilon = epsilon_choice::none});
    const moller_triangle undivided({.epsilon = epsilon_choice::none, .division = division_choice::no});
    // Disjoint along the line of the two planes.
    const triangle3f s{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const triangle3f t{{{0.5F, 2, -1}, {0.5F, 2, 1}, {0.5F, 3, 0}}};
    const auto scaled = [](triangle3f triangle, float factor) {
        for (vec3f& corner : triangle.corner)
            for (float& x : corner.at) x *= factor;
        return triangle;
    };
    CHECK_FALSE(divided.intersects(s, t));
    CHECK_FALSE(undivided.intersects(s, t));
    CHECK_FALSE(divided.intersects(scaled(s, 1e-5F), scaled(t, 1e-5F)));
    CHECK(undivided.intersects(scaled(s, 1e-5F), scaled(t, 1e-5F)));
}

// The baseline must err as the original does.

TEST_CASE("Möller's epsilon is absolute and applies to distances times the normal's length") {
    // The normal is (0, 0, 1), so the distance is the height itself; both triangles seem to lie in one plane.
    const triangle3f unit{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const auto hovering = [](float height) {
        return triangle3f{{{0.25F, 0.25F, height}, {0.5F, 0.25F, height}, {0.25F, 0.5F, height}}};
    };
    CHECK(moller_triangle{}.intersects(unit, hovering(9e-7F)));
    // The float next to 1e-6 lies below it.
    CHECK(moller_triangle{}.intersects(unit, hovering(1e-6F)));
    CHECK_FALSE(moller_triangle{}.intersects(unit, hovering(1.1e-6F)));
}

TEST_CASE("Möller's test errs if products underflow or overflow, and at a triangle without a normal") {
    const triangle3f segment{{{0, 0, -1}, {0, 0, 1}, {0, 0, 1}}};
    const struct {
        const char* what;
        triangle3f s, t;
        bool result;
    } cases[] = {{"a corner inside is missed: its products underflow",
                  {{{0, 0, 0}, {4e-12F, 0, 0}, {0, 4e-12F, 0}}},
                  {{{1e-12F, 1e-12F, 0}, {2e-12F, 1e-12F, 0}, {1e-12F, 2e-12F, 0}}},
                  false},
                 {"a false positive: its products overflow",
                  {{{-1e38F, -1e38F, 1e37F}, {1e38F, -1e38F, 2e37F}, {0, 1e38F, 3e37F}}},
                  {{{9e37F, 9e37F, -1e38F}, {9e37F, 9e37F, 1e38F}, {8e37F, 9e37F, 1e38F}}},
                  true},
                 {"projected along y, but crossing along x", segment, {{{1, -1, 0}, {2, 1, 0}, {1, 1, 0}}}, false},
                 {"projected along y, and crossing along y", segment, {{{-1, 1, 0}, {1, 1, 0}, {1, 2, 0}}}, true}};
    for (const auto& [what, s, t, result] : cases) {
        INFO(what);
        CHECK(moller_triangle{}.intersects(s, t) == result);
    }
}
