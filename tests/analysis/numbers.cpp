#include <catch2/catch_test_macros.hpp>

import aabblab.numbers;

using aabblab::counted;
using aabblab::fifteen_digits;
using aabblab::three_digits;
using aabblab::whole_nanoseconds;

TEST_CASE("Three significant digits are kept after a carry") {
    CHECK(three_digits(0) == "0");
    CHECK(three_digits(0.0182) == "0.0182");
    CHECK(three_digits(0.99951) == "1.00");
    CHECK(three_digits(9.996) == "10.0");
    CHECK(three_digits(99.96) == "100");
    CHECK(three_digits(-9.996) == "-10.0");
    CHECK(three_digits(1234.5) == "1234");
}

TEST_CASE("Rounding errors of arithmetic are not written") {
    CHECK(fifteen_digits(0.1 + 0.2) == "0.3");
    CHECK(fifteen_digits(0.25) == "0.25");
    CHECK(fifteen_digits(1e9) == "1000000000");
    CHECK(fifteen_digits(-2) == "-2");
    CHECK(whole_nanoseconds(0.003 + 0.011624) == 0.014624);
    CHECK(whole_nanoseconds(0.0000014) == 0.000001);
    CHECK(whole_nanoseconds(0) == 0);
}

TEST_CASE("Counts other than 1 are in the plural") {
    CHECK(counted(0, "frame") == "0 frames");
    CHECK(counted(1, "frame") == "1 frame");
    CHECK(counted(12345, "object") == "12,345 objects");
}
