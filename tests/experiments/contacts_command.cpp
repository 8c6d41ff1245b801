#include <catch2/generators/catch_generators.hpp>

#include "csv_rows.hpp"
#include "program_json.hpp"

#include "mesh_bytes.hpp"

namespace {

/// Object 1 approaches object 0, stays and leaves; object 2 is far away.
constexpr const char* approach =
    "# a comment\n"
    "0 0  1 0 0 0  0 1 0 0  0 0 1 0\n"
    "0 2  1 0 0 90 0 1 0 0  0 0 1 0\n"
    "0 1  1 0 0 9  0 1 0 0  0 0 1 0\n"
    "\n"
    "1 1  1 0 0 +0.25 0 1 0 0.25  0 0 1 0  # here\n"
    "2 2  1 0 0 80 0 1 0 0  0 0 1 0\n"
    "3 1  0 -1 0 -9  1 0 0 0  0 0 1 0\n";

}  // namespace

TEST_CASE_METHOD(with_mesh_file, "contacts finds the same contacts in each frame with every composition") {
    const std::string motion = folder.write("m.txt", approach);
    const std::vector<std::string> base = {"contacts", motion, mesh, "--json", "--out", folder / "c.csv"};
    const auto reference = json_of(joined(base, {"--engine", "cgal"}));
    CHECK(reference["objects"] == 3);
    CHECK(reference["frames"] == 4);
    CHECK(reference["contacts"] > 0);
    CHECK(reference["contacts"].get<int>() % 2 == 0);  // frames 1 and 2 are equal
    CHECK(reference["object_pairs"] == 2);
    CHECK(reference["candidates"] == 2);
    CHECK(reference["ms"].size() == 4);
    const std::string rows = bytes_of_file(folder / "c.csv");
    CHECK(rows.starts_with("frame,object_a,object_b,triangle_a,triangle_b\n1,0,1,"));
    CHECK(holds(rows, "\n2,0,1,"));
    CHECK_FALSE(holds(rows, "\n3,"));
    const auto options = GENERATE(values<std::vector<std::string>>(
        {{},
         {"--tree", "compressed:leaf_test=triangle_box", "--sort", "shell", "--partition", "axial_cut"},
         {"--tree", "compressed", "--prepare", "split_mesh:size=0.1"},
         {"--tree", "shared_planes", "--build", "sah", "--sweep", "all_axes", "--prepare", "split_large:size=2"}}));
    const auto summary = json_of(joined(base, options));
    CHECK(summary["digest"] == reference["digest"]);
    CHECK(summary["exact"] == true);
    CHECK(bytes_of_file(folder / "c.csv") == rows);
    const std::string text = run_program({"contacts", motion, mesh}).out;
    CHECK(holds(text, "3 objects, 4 frames"));
    check_narrow(text.substr(text.find('\n')));  // without the name of the file
    CHECK(json_of({"contacts", motion, mesh, "--json", "--triangle", "moller"})["exact"] == false);
    CHECK(holds(run_program({"contacts", motion, mesh, "--engine", "fcl"}).out, "fcl (inexact)"));
}

TEST_CASE_METHOD(with_mesh_file, "contacts --geometry writes the same intersections as collide") {
    const std::string motion = folder.write("m.txt", approach);
    run_well({"contacts", motion, mesh, "--geometry", "--out", folder / "c.csv"});
    run_well(
        {"collide", mesh, mesh, "--geometry", "--out", folder / "p.csv", "--pose-b", "1,0,0,0.25,0,1,0,0.25,0,0,1,0"});
    std::string expected = bytes_of_file(folder / "p.csv").substr(4);
    CHECK(expected.starts_with("kind,corners,error_x,"));
    const std::size_t header = expected.find('\n') + 1;
    std::string rows = "frame,object_a,object_b,triangle_a,triangle_b," + expected.substr(0, header);
    for (const char* frame : {"1,0,1,", "2,0,1,"})
        for (const std::string& row : lines_of(expected.substr(header))) rows += frame + row + "\n";
    CHECK(bytes_of_file(folder / "c.csv") == rows);
}

TEST_CASE_METHOD(with_mesh_file, "poses may be quaternions, and columns have names, commas and any order") {
    const auto digest = [&](const std::string& text) {
        const auto summary = json_of({"contacts", folder.write("m.txt", text), mesh, "--json"});
        CHECK(summary["contacts"] > 0);
        return summary["digest"];
    };
    // Object 1 is turned by a right angle about z, where a quaternion of whole numbers is exact.
    const auto matrices = digest(
        "0 0  1 0 0 0  0 1 0 0  0 0 1 0\n"
        "0 1  0 -1 0 0.25  1 0 0 0.125  0 0 1 0\n");
    CHECK(digest("0 0 0 0 0 0 0 0 1\n0 1 0.25 0.125 0 0 0 3 3\n") == matrices);
    CHECK(digest("object,frame,qw,qx,qy,qz,tx,ty,tz,mass\n0,0,2,0,0,0,0,0,0,7\n1,0,1,0,0,1,0.25,0.125,0,7\n") ==
          matrices);
    CHECK(digest("frame object r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz\n0 0 1 0 0 0 1 0 0 0 1 0 0 0\n"
                 "0 1 0 -1 0 1 0 0 0 0 1 0.25 0.125 0\n") == matrices);
}

TEST_CASE_METHOD(with_mesh_file, "a frame omitted from a motion file repeats the previous frame") {
    const std::string still = "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n0 1 1 0 0 0.2 0 1 0 0.1 0 0 1 0\n";
    const auto contacts = [&](const std::string& text) {
        return json_of({"contacts", folder.write("m.txt", text), mesh, "--json"});
    };
    const int once = contacts(still)["contacts"].get<int>();
    REQUIRE(once > 0);
    const auto summary = contacts(still + "3 1 1 0 0 9 0 1 0 0 0 0 1 0\n");
    CHECK(summary["frames"] == 4);
    CHECK(summary["contacts"] == 3 * once);
}

TEST_CASE_METHOD(in_folder, "contacts finds the contacts of a scene in its motion file") {
    const std::string motion = folder / "swarm.txt";
    const std::vector<std::string> shapes = {"icosphere:triangles=80", "torus_knot:triangles=300"};
    run_well({"scene", "mesh_swarm", "--n", "12", "--frames", "5", "--density", "3", "--mesh", shapes[0], "--mesh",
              shapes[1], "--motion", motion, "--normalise", "no"});
    const std::string config = folder.write("c.toml",
                                            "name = \"c\"\n[[scene]]\nkind = \"mesh_swarm\"\nobjects = 12\nframes = 5\n"
                                            "density = 3\nnormalise = \"no\"\n"
                                            "meshes = [\"icosphere:triangles=80\", \"torus_knot:triangles=300\"]\n");
    const std::string validated = run_program({"validate", config}).out;
    const auto summary = json_of({"contacts", motion, shapes[0], shapes[1], "--json"});
    CHECK(summary["contacts"] > 20);
    CHECK(holds(validated, "digest " + summary["digest"].get<std::string>()));
}

TEST_CASE_METHOD(with_mesh_file, "contacts --intervals says when objects are in contact, where, and how near before") {
    // Object 1 comes from 3 to 0.5, leaves, touches at 1 and leaves; the legs of a tetrahedron are 1 long.
    std::string motion = "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n0 2 1 0 0 0 0 1 0 90 0 0 1 0\n";
    int frame = 0;
    for (const char* x : {"3", "1.5", "0.5", "0.75", "2", "1.25", "1", "3"})
        motion += std::to_string(frame++) + " 1 1 0 0 " + x + " 0 1 0 0 0 0 1 0\n";
    const std::string file = folder.write("m.txt", motion);
    const auto rows_with = [&](const std::vector<std::string>& options) {
        run_well(joined({"contacts", file, mesh, "--intervals", folder / "i.csv"}, options));
        return csv_rows(folder / "i.csv");
    };
    using row = std::map<std::string, std::string>;
    const auto number = [](const row& of, const std::string& column) { return std::stod(of.at(column)); };
    const auto check_nearest = [&](const row& of, const std::string& at, double distance) {
        CHECK(of.at("nearest_frame") == at);
        CHECK(std::abs(number(of, "distance") - distance) <= number(of, "error"));
        CHECK(number(of, "error") < 1e-12);
    };
    const auto objects_of = [](const row& of) { return of.at("object_a") + of.at("object_b"); };
    for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
             {}, {"--tree", "compressed", "--sort", "shell", "--partition", "none"}, {"--engine", "cgal"}}) {
        CAPTURE(method);
        const std::vector<row> rows = rows_with(method);
        REQUIRE(rows.size() == 5);
        for (std::size_t i = 0; i < 3; ++i) CHECK(objects_of(rows[i]) == "01");
        check_nearest(rows[0], "1", 0.5);
        CHECK(rows[0].at("first_frame") == "2");
        CHECK(rows[0].at("last_frame") == "3");
        CHECK(number(rows[0], "x") >= 0.5 - number(rows[0], "point_error"));
        check_nearest(rows[1], "5", 0.25);
        CHECK(rows[1].at("first_frame") == "6");
        CHECK(rows[1].at("last_frame") == "6");
        CHECK(std::abs(number(rows[1], "x") - 1) <= number(rows[1], "point_error"));
        CHECK(std::abs(number(rows[1], "y")) <= number(rows[1], "point_error"));
        CHECK(number(rows[1], "point_error") < 1e-13);
        check_nearest(rows[2], "7", 2);
        CHECK(rows[2].at("first_frame").empty());
        CHECK(rows[2].at("point_error").empty());
        // Object 2 is never in contact: 90 along y, where legs of 1 end.
        CHECK(objects_of(rows[3]) == "02");
        check_nearest(rows[3], "0", 89);
        CHECK(rows[3].at("first_frame").empty());
        CHECK(objects_of(rows[4]) == "12");
        CHECK(rows[4].at("nearest_frame") == "2");
    }
    // What only touches is apart.
    const std::vector<row> crossing = rows_with({"--touching", "no"});
    REQUIRE(crossing.size() == 4);
    check_nearest(crossing[1], "6", 0);
    // Within a distance, earlier and later.
    const std::vector<row> near = rows_with({"--within", "0.5"});
    REQUIRE(near.size() == 5);
    check_nearest(near[0], "0", 2);
    CHECK(near[0].at("first_frame") == "1");
    CHECK(near[0].at("last_frame") == "3");
    CHECK(std::abs(number(near[0], "x") - 1) <= number(near[0], "point_error"));
    CHECK(near[1].at("first_frame") == "5");
    // Contact from the first frame on, and to the last.
    const std::string always = folder.write("s.txt", "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n0 1 1 0 0 0.5 0 1 0 0 0 0 1 0\n");
    run_well({"contacts", always, mesh, "--intervals", folder / "i.json"});
    const auto json = nlohmann::json::parse(bytes_of_file(folder / "i.json"));
    REQUIRE(json["rows"].size() == 1);
    CHECK(json["rows"][0].size() == json["columns"].size());
    CHECK(json["rows"][0][2].is_null());
    CHECK(json["rows"][0][5] == 0);
    // A filter leaves pairs out.
    const std::string except = folder.write("e.csv", "a,b\n0,1\n");
    CHECK(rows_with({"--except", except}).size() == 2);
    CHECK(holds(run_program({"contacts", file, mesh, "--intervals", folder / "i.npy"}).err, "integers only"));
    CHECK(run_program({"contacts", file, mesh, "--intervals", file}).status == 2);
    CHECK(run_program({"contacts", file, mesh, "--intervals", folder / "i.csv", "--out", folder / "i.csv"}).status ==
          2);
}
