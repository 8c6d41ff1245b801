#include <rapidcheck.h>

#include "../testing.hpp"

import aabb.wide_tree.level_steps;

using namespace aabb;

TEST_CASE("of two nodes the higher one is opened first, down to the leaves") {
    level_steps steps;
    for (std::size_t a = 0; a < 12; ++a)
        for (std::size_t b = 0; b < 12; ++b) {
            CAPTURE(a, b);
            steps.begin({a, b});
            REQUIRE(steps.size() == std::max(a, b) + 1);
            for (std::size_t step = 0; step < steps.size(); ++step) {
                const std::size_t height = std::max(a, b) - step;
                REQUIRE(steps[step] == level_steps::heights{std::min(a, height), std::min(b, height)});
                if (step + 1 == steps.size()) continue;
                REQUIRE(steps.opens_a(step) == (a >= height));
                REQUIRE(steps.opens_b(step) == (b >= height));
            }
        }
}

TEST_CASE("pairs of children become one pair if a node is not opened") {
    REQUIRE(rc::check([](std::uint64_t overlaps) {
        for (const level_steps::heights roots : {level_steps::heights{2, 2}, {2, 1}, {1, 2}}) {
            level_steps steps;
            steps.begin(roots);
            std::uint64_t expected = 0;
            for (unsigned place = 0; place < 64; ++place)
                if ((overlaps >> place & 1U) != 0)
                    expected |= std::uint64_t{1}
                                << ((steps.opens_a(0) ? place & 7U : 0) | (steps.opens_b(0) ? place & 56U : 0));
            RC_ASSERT(steps.pairs_to_open(0, overlaps) == expected);
        }
    }));
}
