#include "../testing.hpp"

import aabblab.progress;

using namespace std::chrono_literals;

TEST_CASE("Progress reports the work done and estimates the remaining time") {
    using aabblab::progress_text;
    REQUIRE(progress_text("frames searched", 30, 120, 4s) == "frames searched: 30 of 120, about 12 s left");
    REQUIRE(progress_text("rows", 0, 120, 4s) == "rows: 0 of 120");
    REQUIRE(progress_text("rows", 1, 101, 3s) == "rows: 1 of 101, about 5 min left");
    REQUIRE(progress_text("rows", 1, 101, 150s) == "rows: 1 of 101, about 4 h 10 min left");
    REQUIRE(progress_text("bytes", 7, 0, 4s) == "bytes: 7");
}
