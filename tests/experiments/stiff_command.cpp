#include <regex>

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

TEST_CASE_METHOD(in_folder, "validate stiff compares methods, and keeps the rows of other studies") {
    const std::string out = folder / "out";
    const program_result result = run_well({"validate", "stiff", "stability", "--methods", "--quick", "--out", out});
    REQUIRE(holds(result.out, "stability"));
    const std::string csv = bytes_of_file(folder / "out" / "methods.csv");
    REQUIRE(csv.starts_with("study,method,rules,turned,change\nstability,moller,"));
    // A tree bounds the same triangles, however coarsely.
    REQUIRE(std::regex_search(csv, std::regex("\nstability,quantized:bits=4,[1-9][0-9]*,0,0\n")));
    REQUIRE(std::regex_search(csv, std::regex("\nstability,1 of 1000 lost,[1-9][0-9]*,[1-9]")));

    const program_result more =
        run_well({"validate", "stiff", "plate", "sliding", "--methods", "--quick", "--out", out});
    REQUIRE(holds(more.err, "left out: sliding compares methods by itself"));
    const std::string both = bytes_of_file(folder / "out" / "methods.csv");
    REQUIRE(both.starts_with(csv));
    REQUIRE(holds(both, "\nplate,moller,"));
    REQUIRE(holds(more.out, "stability"));
    for (const char* method : {"neighbour_list:margin=0,every=16", "quantized:bits=4", "1 of 1000 lost"})
        REQUIRE(holds(more.out, method));
}

TEST_CASE("The help of stiff lists its studies, and list shows integrators") {
    REQUIRE(holds(run_program({"validate", "stiff", "--help"}).out, "\nball_bounces  "));
    const std::string list = run_program({"list"}).out;
    for (const char* name : {"symplectic_euler", "velocity_verlet", "dormand_prince", "bdf"}) CHECK(holds(list, name));
}
