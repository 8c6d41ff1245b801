#include <sched.h>

#include "../testing.hpp"

import aabblab.processor;

namespace {

int processors() {
    cpu_set_t allowed;
    REQUIRE(sched_getaffinity(0, sizeof allowed, &allowed) == 0);
    return CPU_COUNT(&allowed);
}

}  // namespace

TEST_CASE("A thread stays on one processor, but not while it is let off") {
    const int before = processors();
    {
        const aabblab::idlest_processor pinned;
        CHECK(processors() == 1);
        pinned.without([&] {
            CHECK(processors() == before);
            int of_another = 0;
            std::jthread([&] { of_another = processors(); }).join();
            CHECK(of_another == before);
        });
        CHECK(processors() == 1);
    }
    CHECK(processors() == before);
}
