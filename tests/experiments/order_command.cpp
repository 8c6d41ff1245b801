#include "program_json.hpp"

#include "mesh_bytes.hpp"

TEST_CASE("order writes a mesh whose tree need not say which triangle stands where") {
    const temporary_folder folder;
    const std::string mesh = "torus_knot:triangles=2000";
    const std::string written = folder / "ordered.off";
    REQUIRE(run_well({"order", mesh, "--out", written}).out == "wrote " + written + ": 2,000 triangles\n");

    // Every triangle is somewhere.
    run_well({"order", mesh, "--out", written, "--numbers", folder / "numbers.csv"});
    const std::string rows = bytes_of_file(folder / "numbers.csv");
    REQUIRE(rows.starts_with("triangle,was\n0,"));
    std::set<std::string> were;
    for (const std::string& row : lines_of(rows.substr(rows.find('\n') + 1))) {
        REQUIRE(row.starts_with(std::to_string(were.size()) + ","));
        were.insert(row.substr(row.find(',') + 1));
    }
    REQUIRE(were.size() == 2000);
    REQUIRE(were.contains("0"));
    REQUIRE(were.contains("1999"));

    const auto collided = [](const std::string& of, const std::string& build) {
        return json_of({"collide", of, "--self", "--json", "--build", build, "--tree", "implicit:vertices=fetched"});
    };
    const auto before = collided(mesh, "sah");
    const auto after = collided(written, "file_order");
    REQUIRE(after["pairs"] == before["pairs"]);
    REQUIRE(after["neighbours"] == before["neighbours"]);
    REQUIRE(after["bytes_per_triangle"] < 1.3);
    REQUIRE(after["bytes"]["indices"] == 0);
    REQUIRE(before["bytes"]["indices"] > 0);
    // By name, without a file.
    REQUIRE(collided(mesh + ",order=sah", "file_order")["digest"] == after["digest"]);
}
