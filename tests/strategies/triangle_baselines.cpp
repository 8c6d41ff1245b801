#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <memory>
#include <string>

#include "../compositions.hpp"
#include "../triangle_pairs.hpp"

import aabb;
import aabb.registry;
import aabb.triangle.exact;
import aabb.triangle.devillers_guigue;
import aabb.triangle.interval_test;
import aabb.triangle.moller;
import aabb.triangle.moller_double;

using namespace aabb;

namespace {

triangle3f any_triangle(triangle_pairs::generator& random) {
    triangle3f t{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) t[i][k] = static_cast<float>(triangle_pairs::integer(random, -9999, 9999)) / 3000;
    return t;
}

triangle3d in_double(const triangle_pairs::triangle& t) {
    triangle3d made{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) made[i][k] = t[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    return made;
}

const triangle3f face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

}  // namespace

TEST_CASE("every triangle test decides generic pairs, whichever way round they are given") {
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

TEST_CASE("every triangle test decides clear coplanar pairs") {
    for (const strategy_choice& choice : all_choices(strategy_kind::triangle)) {
        INFO(to_text(choice));
        const auto test = make_triangle_test(choice);
        CHECK(test->intersects(face, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}));
        CHECK(test->intersects({{{1, 1, 0}, {1, 2, 0}, {2, 1, 0}}}, face));
        CHECK(test->intersects(face, {{{3, 3, 0}, {1, 1, 0}, {4, 4, 0}}}));
        CHECK_FALSE(test->intersects(face, {{{2, 3, 0}, {3, 2, 0}, {4, 4, 0}}}));
        CHECK_FALSE(test->intersects({{{2, 3, 0}, {4, 4, 0}, {3, 2, 0}}}, face));
    }
}

TEST_CASE("the epsilon of Möller's test is absolute, absent, or of the pair's own size") {
    // Two triangles a hundredth of a unit in size, one hovering a tenth of that over the other.
    const triangle3f low{{{0, 0, 0}, {0.01F, 0, 0}, {0, 0.01F, 0}}};
    const triangle3f high{{{0, 0, 0.001F}, {0.01F, 0, 0.001F}, {0, 0.01F, 0.001F}}};
    const auto says = [&](const char* test, const char* epsilon) {
        return make_triangle_test({test, {{"epsilon", epsilon}}})->intersects(low, high);
    };
    for (const char* test : {"moller", "moller_double"}) {
        INFO(test);
        CHECK(says(test, "absolute"));
        CHECK_FALSE(says(test, "none"));
        CHECK_FALSE(says(test, "scaled"));
    }
    // A corner that floats put a little off the plane it lies in.
    const triangle3f slanted{{{0.1F, 0.2F, 0.3F}, {7.3F, 1.9F, 5.1F}, {3.7F, 9.1F, 2.3F}}};
    vec3f on{};
    for (int k = 0; k < 3; ++k) on[k] = (slanted[0][k] + slanted[1][k] + slanted[2][k]) / 3;
    int tried = 0;
    int lost = 0;
    int lost_scaled = 0;
    for (int i = 0; i < 4000; ++i) {
        const float a = 1 + static_cast<float>(i % 200) / 7;
        vec3f tip = on;
        const int step = i / 200 - 10;
        tip[2] += static_cast<float>(step) * 0x1p-22F;
        const float down = i % 2 == 0 ? 9 : -9;
        const triangle3f other{{tip, {tip[0] + a, tip[1] - 2, tip[2] - down}, {tip[0] + 3, tip[1] - a, tip[2] - down}}};
        if (!exact_triangle::intersects(slanted, other)) continue;
        ++tried;
        lost += !moller_triangle(moller_triangle::config{epsilon_choice::none}).intersects(slanted, other);
        lost_scaled += !moller_triangle(moller_triangle::config{epsilon_choice::scaled}).intersects(slanted, other);
    }
    CHECK(tried > 100);
    CHECK(lost > 0);
    CHECK(lost_scaled == 0);
}

TEST_CASE("tests in double take doubles as they are") {
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

TEST_CASE("plain double errs where exact does not") {
    triangle_pairs::generator random(11);
    int wrong = 0;
    for (int i = 0; i < 3000; ++i) {
        // A corner in the plane of a face, at tenths that double cannot hold.
        const auto [s, t] = triangle_pairs::placed<double>(random, triangle_pairs::patterned(random, 3), 1);
        wrong += devillers_guigue_triangle::intersects(in_double(s), in_double(t)) !=
                 exact_triangle::intersects(in_double(s), in_double(t));
    }
    CHECK(wrong > 0);
    CHECK(wrong < 1500);
}
