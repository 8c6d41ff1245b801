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

TEST_CASE("A thread stays pinned to one processor, except for work that is run unpinned") {
    const int before = processors();
    {
        const aabblab::idlest_processor pinned;
        CHECK(processors() == 1);
        pinned.without([&] {
            CHECK(processors() == before);
            int of_other_thread = 0;
            std::jthread([&] { of_other_thread = processors(); }).join();
            CHECK(of_other_thread == before);
        });
        CHECK(processors() == 1);
    }
    CHECK(processors() == before);
}
