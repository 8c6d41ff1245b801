#include "support.hpp"

import aabb.validation;

using namespace aabb;

namespace {

/// As CMake lists them, separated by spaces.
std::vector<std::string> declared_names() {
    std::istringstream text(AABBLAB_ENGINE_NAMES);
    std::vector<std::string> names;
    for (std::string name; text >> name;) names.push_back(name);
    return names;
}

}  // namespace

TEST_CASE("engines are listed with what they can do") {
    std::vector<std::string> names;
    for (const engine_info& info : engines()) {
        INFO(info.name);
        names.push_back(info.name);
        REQUIRE(!info.summary.empty());
        REQUIRE((info.searches_boxes || info.collides_meshes));
        if (info.searches_boxes) REQUIRE(make_box_engine(info.name) != nullptr);
        if (info.collides_meshes) REQUIRE(make_mesh_engine(info.name) != nullptr);
        REQUIRE(rejection_of_engine(info.name).empty());
        REQUIRE(is_exact_engine(info.name) == info.exact);
    }
    REQUIRE(names == declared_names());
    for (const char* always : {"brute_force", "cgal", "cgal_tree", "boost_integers"})
        REQUIRE(std::ranges::find(names, always) != names.end());
}

TEST_CASE("every engine is either in the build or left out") {
    for (const char* name :
         {"fcl", "fcl_aabb", "libccd", "embree", "embree_refit", "embree_meshes", "embree_meshes_low",
          "embree_meshes_refit", "boost_rtree", "bullet_dbvt", "bullet_sap", "ode_hash", "ode_sap"}) {
        const auto built = std::ranges::count(engines(), name, &engine_info::name);
        const auto left_out = std::ranges::count(left_out_engines(), name, &left_out_engine::name);
        REQUIRE(built + left_out == 1);
    }
}

TEST_CASE("an engine that was left out is rejected for that reason") {
    const std::vector<engine_info> built = {{"one", "", true, true, true}};
    const std::vector<left_out_engine> left_out = {{"two", "Two's library"}};
    REQUIRE(rejection_of_engine("one", built, left_out).empty());
    REQUIRE(rejection_of_engine("two", built, left_out) ==
            "the engine 'two' is not in this build: Two's library was not found");
    REQUIRE(rejection_of_engine("twwo", built, left_out) == "unknown engine 'twwo'; did you mean 'two'?");
    for (const left_out_engine& engine : left_out_engines()) {
        CHECK_REFUSED(make_box_engine(engine.name), rejection_of_engine(engine.name));
        CHECK_REFUSED(make_mesh_engine(engine.name), rejection_of_engine(engine.name));
        CHECK_REFUSED(is_exact_engine(engine.name), rejection_of_engine(engine.name));
    }
}

TEST_CASE("an unknown engine is rejected with the nearest name") {
    CHECK_REFUSED(make_box_engine("cgl"), "unknown engine 'cgl'; did you mean 'cgal'?");
    CHECK_REFUSED(make_mesh_engine("libcd"), "unknown engine 'libcd'; did you mean 'libccd'?");
}

TEST_CASE("an engine is rejected for a stage that it does not have") {
    for (const engine_info& info : engines()) {
        if (!info.searches_boxes)
            CHECK_REFUSED(make_box_engine(info.name),
                          "the engine '" + info.name +
                              "' has no broad phase, so it cannot search boxes; it only collides meshes");
        if (!info.collides_meshes)
            CHECK_REFUSED(make_mesh_engine(info.name),
                          "the engine '" + info.name +
                              "' has no narrow phase, so it cannot collide meshes; it only searches boxes");
    }
}
