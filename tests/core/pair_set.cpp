#include <rapidcheck.h>

#include "../testing.hpp"

import aabb;

using namespace aabb;

TEST_CASE("a pair set equals a std::set after any insertions and erasures") {
    REQUIRE(rc::check([] {
        pair_set set;
        std::set<index_pair> expected;
        // Few ids make pairs that are inserted twice, and pairs that are erased and inserted again.
        const auto ids = *rc::gen::element<std::uint32_t>(4, 40, 4'000'000'000U);
        for (int step = *rc::gen::inRange(0, 400); step > 0; --step) {
            const index_pair pair{*rc::gen::inRange<std::uint32_t>(0, ids), *rc::gen::inRange<std::uint32_t>(0, ids)};
            switch (*rc::gen::inRange(0, 8)) {
                case 0: {
                    const std::uint32_t divisor = *rc::gen::inRange<std::uint32_t>(1, 5);
                    const auto is_erased = [&](index_pair p) { return p.a % divisor == 0; };
                    set.erase_if(is_erased);
                    std::erase_if(expected, is_erased);
                    break;
                }
                case 1:
                case 2:
                    set.erase(pair);
                    expected.erase(pair);
                    break;
                default: set.insert(pair); expected.insert(pair);
            }
        }
        RC_ASSERT(sorted(set.pairs()) == std::vector<index_pair>(expected.begin(), expected.end()));
    }));
}
