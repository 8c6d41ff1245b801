#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <string>
#include <vector>

#include "temporary_folder.hpp"

import aabb;
import aabblab.pair_output;

TEST_CASE("A pair that a stage reports twice is a defect") {
    std::vector<aabb::index_pair> pairs = {{2, 3}, {0, 7}, {0, 1}};
    aabblab::sort_each_once(pairs, "a stage");
    REQUIRE(pairs == std::vector<aabb::index_pair>{{0, 1}, {0, 7}, {2, 3}});
    pairs.push_back({0, 7});
    REQUIRE_THROWS_MATCHES(aabblab::sort_each_once(pairs, "a stage, frame 3"), aabblab::defect,
                           Catch::Matchers::Message("a stage, frame 3: the pair 0,7 was reported more than once"));
}

TEST_CASE("A table of pairs is there only once it is committed") {
    const temporary_folder folder;
    const std::vector<aabb::index_pair> pairs = {{0, 1}, {0, 4294967295}};
    {
        aabblab::pair_table left(folder / "left.csv", aabblab::pair_table::columns::a_b);
        left.add(0, pairs);
    }
    REQUIRE(folder.files() == 0);
    aabblab::pair_table table(folder / "pairs.csv", aabblab::pair_table::columns::frame_a_b);
    table.add(0, pairs);
    table.add(2, pairs);
    table.commit();
    REQUIRE(bytes_of_file(folder / "pairs.csv") == "frame,a,b\n0,0,1\n0,0,4294967295\n2,0,1\n2,0,4294967295\n");
}
