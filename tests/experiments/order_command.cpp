#include "program_json.hpp"

#include "mesh_bytes.hpp"

TEST_CASE_METHOD(in_folder, "order writes a mesh whose tree needs no triangle indices") {
    const std::string mesh = "torus_knot:triangles=2000";
    const std::string written = folder / "ordered.off";
    REQUIRE(run_well({"order", mesh, "--out", written}).out == "wrote " + written + ": 2,000 triangles\n");

    // The numbers are a permutation of the triangles.
    run_well({"order", mesh, "--out", written, "--numbers", folder / "numbers.csv"});
    const std::string rows = bytes_of_file(folder / "numbers.csv");
    REQUIRE(rows.starts_with("triangle,was\n0,"));
    std::set<std::string> old_numbers;
    for (const std::string& row : lines_of(rows.substr(rows.find('\n') + 1))) {
        REQUIRE(row.starts_with(std::to_string(old_numbers.size()) + ","));
        old_numbers.insert(row.substr(row.find(',') + 1));
    }
    REQUIRE(old_numbers.size() == 2000);
    REQUIRE(old_numbers.contains("0"));
    REQUIRE(old_numbers.contains("1999"));

    const auto self_collision = [](const std::string& name, const std::string& build) {
        return json_of(
            {"collide", name, "--self=all", "--json", "--build", build, "--tree", "implicit:vertices=fetched"});
    };
    const auto before = self_collision(mesh, "sah");
    const auto after = self_collision(written, "file_order");
    REQUIRE(after["pairs"] == before["pairs"]);
    REQUIRE(after["neighbours"] == before["neighbours"]);
    REQUIRE(after["bytes_per_triangle"] < 1.3);
    REQUIRE(after["bytes"]["indices"] == 0);
    REQUIRE(before["bytes"]["indices"] > 0);
    // The name of the mesh alone orders it in the same way.
    REQUIRE(self_collision(mesh + ",order=sah", "file_order")["digest"] == after["digest"]);
}
