#include "program.hpp"

TEST_CASE_METHOD(in_folder, "validate stiff runs the studies that are named and writes a file for each") {
    const std::string out = folder / "out";
    const program_result result = run_well({"validate", "stiff", "plate", "--quick", "--out", out});
    REQUIRE(holds(result.out, "a step of 2 extents, plain"));
    REQUIRE(holds(result.out, "Everything is as expected."));
    const std::string csv = bytes_of_file(folder / "out" / "plate.csv");
    REQUIRE(csv.starts_with("subject,quantity,measured,expected,verdict\n"));
    REQUIRE(holds(csv, ",0.5,"));
    REQUIRE(std::filesystem::exists(folder / "out" / "figures" / "tunnelled.svg"));
    // Another study does not change it.
    run_well({"validate", "stiff", "overdamped", "--quick", "--out", out});
    REQUIRE(bytes_of_file(folder / "out" / "plate.csv") == csv);
}

TEST_CASE("The help of stiff lists its studies, and list shows integrators") {
    REQUIRE(holds(run_program({"validate", "stiff", "--help"}).out, "\nball_bounces  "));
    const std::string list = run_program({"list"}).out;
    for (const char* name : {"symplectic_euler", "velocity_verlet", "dormand_prince", "bdf"}) CHECK(holds(list, name));
}
