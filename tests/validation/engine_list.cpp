#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <memory>
#include <string>
#include <vector>

#include "support.hpp"

import aabb.validation;

using namespace aabb;

TEST_CASE("the engines are listed with what they can do") {
    std::vector<std::string> names;
    for (const engine_info& info : engines()) {
        INFO(info.name);
        names.push_back(info.name);
        REQUIRE(!info.summary.empty());
        REQUIRE((info.searches_boxes || info.collides_meshes));
        if (info.searches_boxes) REQUIRE(make_box_engine(info.name) != nullptr);
        if (info.collides_meshes) REQUIRE(make_mesh_engine(info.name) != nullptr);
    }
    REQUIRE(names == std::vector<std::string>{"brute_force", "cgal", "fcl", "libccd"});
}

TEST_CASE("an engine nobody knows is refused with the nearest name") {
    REQUIRE(refusal_in([] { (void)make_box_engine("cgl"); }) == "unknown engine 'cgl'; did you mean 'cgal'?");
    REQUIRE(refusal_in([] { (void)make_mesh_engine("libcd"); }) == "unknown engine 'libcd'; did you mean 'libccd'?");
}

TEST_CASE("libccd has no broad phase") {
    REQUIRE(refusal_in([] { (void)make_box_engine("libccd"); }) ==
            "the engine 'libccd' has no broad phase, so it cannot search boxes; it only collides meshes");
}
