#include <catch2/catch_test_macros.hpp>

#include "program.hpp"
#include "temporary_folder.hpp"

import aabb.std;
import aabblab.files;

TEST_CASE("validate stiff plays the studies that are named, and keeps each in its file") {
    const temporary_folder folder;
    const std::string out = (folder / "out").string();
    const program_result played = run_program({"validate", "stiff", "plate", "--quick", "--out", out});
    REQUIRE(played.status == 0);
    REQUIRE(played.out.find("a step of 2 reaches, plain") != std::string::npos);
    REQUIRE(played.out.find("Everything is as expected.") != std::string::npos);
    const std::string csv = aabblab::bytes_of_file(folder / "out" / "plate.csv");
    REQUIRE(csv.starts_with("subject,quantity,measured,expected,verdict\n"));
    REQUIRE(csv.find(",0.5,") != std::string::npos);
    REQUIRE(std::filesystem::exists(folder / "out" / "figures" / "tunnelled.svg"));
    // Another study leaves it alone.
    REQUIRE(run_program({"validate", "stiff", "overdamped", "--quick", "--out", out}).status == 0);
    REQUIRE(aabblab::bytes_of_file(folder / "out" / "plate.csv") == csv);
}

TEST_CASE("The help of stiff names its studies, and list shows integrators") {
    REQUIRE(run_program({"validate", "stiff", "--help"}).out.find("ball_bounces, stability") != std::string::npos);
    const std::string list = run_program({"list"}).out;
    for (const char* const name : {"symplectic_euler", "velocity_verlet", "dormand_prince", "bdf"})
        REQUIRE(list.find(name) != std::string::npos);
}
