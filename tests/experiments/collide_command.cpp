#include <catch2/generators/catch_generators.hpp>

#include "program_json.hpp"

#include "csv_rows.hpp"
#include "mesh_bytes.hpp"

namespace {

/// A tetrahedron, and a pyramid on a square.
struct two_files : in_folder {
    std::string a = folder.write("a.off", tetrahedron);
    std::string b = folder.write(
        "b.off", "OFF\n5 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n4 0 1 2 3\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n");
};

}  // namespace

TEST_CASE_METHOD(two_files, "collide finds the same triangle pairs with every tree and build") {
    const std::vector<std::string> base = {"collide", a, b, "--json", "--pose-b", "0,-1,0,0.4, 1,0,0,0.2, 0,0,1,-0.1"};
    const auto reference = json_of(joined(base, {"--engine", "cgal"}));
    REQUIRE(reference["pairs"] > 0);
    const auto tree = GENERATE("canonical", "leafless", "shared_planes", "compressed", "compressed_literal",
                               "compressed:leaf_test=triangle_box", "quantized:bits=5");
    const auto build = GENERATE("median", "sah");
    const auto result = run_well(joined(base, {"--tree", tree, "--build", build, "--out", folder / "pairs.csv"}));
    REQUIRE(holds(result.err, "b.off: "));  // a polygon was triangulated
    const auto summary = nlohmann::json::parse(result.out);
    REQUIRE(summary["triangles"] == std::vector{4, 6});
    for (const char* member : {"pairs", "digest"}) REQUIRE(summary[member] == reference[member]);
    for (const char* time : {"build_ms", "query_ms"}) REQUIRE(summary[time] >= 0);
    REQUIRE(summary["bytes_per_triangle"] > 10);
    const std::string rows = bytes_of_file(folder / "pairs.csv");
    REQUIRE(rows.starts_with("a,b\n"));
    REQUIRE(static_cast<std::size_t>(std::ranges::count(rows, '\n')) == 1 + summary["pairs"].get<std::size_t>());

    std::size_t trees = summary["bytes"]["nodes"].get<std::size_t>() + summary["bytes"]["indices"].get<std::size_t>();
    REQUIRE(summary["bytes_per_triangle"] == static_cast<double>(trees) / 10);
    REQUIRE(summary["method"] == (build == std::string("sah") ? "sah + " : "") + std::string(tree) + " + exact");
    REQUIRE(summary["exact"] == true);
    REQUIRE(holds(run_program({"collide", a, b, "--triangle", "moller"}).out, "moller (inexact)"));
    REQUIRE(summary["bytes"]["triangles"] >= 120);
    REQUIRE(summary["bytes"]["vertices"] >= 108);

    const auto counted = json_of(joined(base, {"--tree", tree, "--count"}));
    REQUIRE(counted["pairs"] == summary["pairs"]);
    REQUIRE(counted["digest"].is_null());

    const program_result first = run_program(joined(base, {"--tree", tree, "--first", "--out", folder / "first.csv"}));
    REQUIRE(nlohmann::json::parse(first.out)["pairs"] == 1);
    REQUIRE(holds(rows, "\n" + bytes_of_file(folder / "first.csv").substr(4)));
}

TEST_CASE_METHOD(in_folder, "collide --self=all finds all neighbours around a vertex of many triangles") {
    constexpr int triangles = 200;
    // Every third triangle has its own vertex at the apex, and one triangle intersects some of the others.
    std::string vertices = "0 0 0\n";
    std::string faces;
    int next = 1;
    for (int i = 0; i < triangles; ++i) {
        int apex = 0;
        if (i % 3 == 0) {
            vertices += "-0 0 0\n";
            apex = next++;
        }
        vertices += std::to_string(i) + " 100 1\n" + std::to_string(i) + ".5 100 1\n";
        faces += "3 " + std::to_string(apex) + " " + std::to_string(next) + " " + std::to_string(next + 1) + "\n";
        next += 2;
    }
    vertices += "0 50 -9\n9 50 -9\n5 50 9\n";
    faces += "3 " + std::to_string(next) + " " + std::to_string(next + 1) + " " + std::to_string(next + 2) + "\n";
    const std::string mesh = folder.write("fan.off", "OFF\n" + std::to_string(next + 3) + " " +
                                                         std::to_string(triangles + 1) + " 0\n" + vertices + faces);
    const auto summary = [&](const std::vector<std::string>& more) {
        return json_of(joined({"collide", mesh, "--self=all", "--json"}, more));
    };
    const auto exact = summary({"--out", folder / "exact.csv", "--engine", "brute_force"});
    CHECK(exact["neighbours"] == triangles * (triangles - 1) / 2);
    CHECK(exact["pairs"] > 0);
    const auto by_tree = summary({"--out", folder / "found.csv"});
    // An inexact test stores neighbours, as it may miss some.
    const auto inexact = summary({"--out", folder / "inexact.csv", "--triangle", "moller"});
    for (const char* member : {"pairs", "neighbours", "digest"}) CHECK(by_tree[member] == exact[member]);
    CHECK(bytes_of_file(folder / "found.csv") == bytes_of_file(folder / "exact.csv"));
    CHECK(std::ranges::count(bytes_of_file(folder / "inexact.csv"), '\n') ==
          1 + inexact["pairs"].get<std::ptrdiff_t>() + inexact["neighbours"].get<std::ptrdiff_t>());
    CHECK(summary({"--count"})["neighbours"] == exact["neighbours"]);
}

TEST_CASE_METHOD(in_folder, "collide --self=all reports neighbours separately") {
    // Two intersecting tetrahedra, and a triangle that shares a corner with the first by position only.
    const std::string mesh =
        folder.write("two.off",
                     "OFF\n11 9 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                     "0.2 0.2 -0.5\n1.2 0.2 -0.5\n0.2 1.2 -0.5\n0.2 0.2 0.5\n"
                     "0 0 0\n-1 0 0\n0 -1 0\n"
                     "3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n3 4 5 6\n3 4 5 7\n3 4 6 7\n3 5 6 7\n3 8 9 10\n");
    const std::vector<std::string> base = {"collide", mesh, "--self=all", "--json", "--out", folder / "self.csv"};
    const auto reference = json_of(joined(base, {"--engine", "brute_force"}));
    const std::string rows = bytes_of_file(folder / "self.csv");
    REQUIRE(rows.starts_with("a,b,shared_vertices\n0,1,2\n"));
    REQUIRE(holds(rows, "\n0,8,1\n"));
    REQUIRE(reference["neighbours"] == 6 + 6 + 3);
    REQUIRE(reference["pairs"] > 0);
    REQUIRE(reference["triangles"] == std::vector{9});
    const auto tree = GENERATE("canonical", "leafless:leaf_test=triangle_aabb", "compressed", "compressed_literal",
                               "quantized", "implicit");
    const auto summary = json_of(joined(base, {"--tree", tree}));
    for (const char* member : {"pairs", "neighbours", "digest"}) REQUIRE(summary[member] == reference[member]);
    REQUIRE(bytes_of_file(folder / "self.csv") == rows);
    const auto counted = json_of({"collide", mesh, "--self=all", "--count", "--json"});
    for (const char* member : {"pairs", "neighbours"}) REQUIRE(counted[member] == summary[member]);
    REQUIRE(counted["digest"].is_null());
    // Without neighbours only the other pairs are written, and neighbours are still counted.
    const auto excluded =
        json_of({"collide", mesh, "--self=no-adjacent", "--json", "--tree", tree, "--out", folder / "rest.csv"});
    for (const char* member : {"pairs", "neighbours"}) REQUIRE(excluded[member] == summary[member]);
    REQUIRE(excluded["digest"] != summary["digest"]);
    std::string expected = "a,b\n";
    for (const std::string& row : lines_of(rows))
        if (row.ends_with(",0")) expected += row.substr(0, row.size() - 2) + "\n";
    REQUIRE(bytes_of_file(folder / "rest.csv") == expected);
    REQUIRE(holds(run_program({"collide", mesh, "--self=all"}).out, "15 more pairs that share a vertex"));
    // Earlier names.
    REQUIRE(json_of({"collide", mesh, "--self=together", "--json"})["neighbours"] == summary["neighbours"]);
    REQUIRE(json_of({"collide", mesh, "--self=apart", "--json"})["digest"] == excluded["digest"]);
    // Two tetrahedra intersect; the neighbours have no more in common than what they share.
    const auto beyond = json_of({"collide", mesh, "--self", "--json", "--tree", tree});
    REQUIRE(beyond["pairs"] == summary["pairs"]);
    REQUIRE(beyond["pairs"] > 1);
    REQUIRE(!beyond.contains("neighbours"));
    REQUIRE(json_of({"collide", mesh, "--self", "--first", "--json", "--tree", tree})["pairs"] == 1);
}

TEST_CASE_METHOD(in_folder, "collide --self finds triangles that share more than corners and edges") {
    // A bow-tie through a common corner, a fold and a double face intersect; a tent and two halves of a square do not.
    const std::string square = "OFF\n4 2 0\n0 0 0\n4 0 0\n2 3 0\n";
    const std::vector<std::pair<std::string, std::string>> files{
        {"bow_tie", "OFF\n5 2 0\n0 0 0\n6 0 0\n6 3 0\n4 1 -2\n4 1 2\n3 0 1 2\n3 0 3 4\n"},
        {"fold", square + "2 1 0\n3 0 1 2\n3 1 0 3\n"},
        {"double", "OFF\n3 2 0\n0 0 0\n4 0 0\n2 3 0\n3 0 1 2\n3 0 1 2\n"},
        {"tent", "OFF\n4 2 0\n0 0 0\n4 0 0\n2 3 1\n2 -3 1\n3 0 1 2\n3 1 0 3\n"},
        {"flat", square + "2 -3 0\n3 0 1 2\n3 1 0 3\n"}};
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string mesh = folder.write(files[i].first + ".off", files[i].second);
        const bool intersects = i < 3;
        CAPTURE(mesh);
        const auto summary = json_of({"collide", mesh, "--self", "--json", "--out", folder / "pairs.csv"});
        CHECK(summary["pairs"] == (intersects ? 1 : 0));
        CHECK(summary["degenerate"] == 0);
        CHECK(lines_of(bytes_of_file(folder / "pairs.csv")).size() == (intersects ? 2 : 1));
        CHECK(run_program({"collide", mesh, "--self", "--exit-code"}).status == (intersects ? 1 : 0));
        const std::string any = run_program({"collide", mesh, "--self", "--first"}).out;
        CHECK(holds(any, intersects ? "triangles 0 and 1 intersect\n" : "0 intersecting pairs of triangles"));
        CHECK(json_of({"collide", mesh, "--self", "--count", "--json"})["pairs"] == summary["pairs"]);
    }
    // The second triangle is a segment that passes through the first.
    const std::string spike =
        folder.write("spike.off", "OFF\n5 2 0\n0 0 0\n4 0 0\n2 3 0\n2 1 1\n2 1 -1\n3 0 1 2\n3 3 4 4\n");
    const std::string text = run_program({"collide", spike, "--self"}).out;
    CHECK(holds(text, "1 intersecting pair of triangles"));
    CHECK(holds(text, "\n1 triangle without area\n"));
}

TEST_CASE_METHOD(two_files, "collide --geometry writes each intersection in world coordinates") {
    const auto rows_of = [&](const std::vector<std::string>& options) {
        run_well(joined({"collide", a, b, "--geometry", "--out", folder / "pairs.csv"}, options));
        return fields_of(bytes_of_file(folder / "pairs.csv"));
    };
    const auto base = rows_of({"--pose-b", "1,0,0,0.4, 0,1,0,0.2, 0,0,1,-0.1"});
    REQUIRE(base.size() > 3);
    CHECK(base[0] == std::vector<std::string>{"a",  "b",  "kind", "corners", "error_x", "error_y", "error_z",
                                              "x1", "y1", "z1",   "x2",      "y2",      "z2",      "x3",
                                              "y3", "z3", "x4",   "y4",      "z4",      "x5",      "y5",
                                              "z5", "x6", "y6",   "z6"});
    // Both meshes are rotated by 90 degrees about z and translated: y comes from x, and x from -y.
    REQUIRE(json_of({"collide", a, b, "--json", "--pose-a", "1,0,0,100, 0,1,0,200, 0,0,1,300", "--pose-b",
                     "1,0,0,100, 0,1,0,200, 0,0,1,300"})["digest"] == json_of({"collide", a, b, "--json"})["digest"]);
    const auto moved =
        rows_of({"--pose-a", "0,-1,0,100, 1,0,0,200, 0,0,1,300", "--pose-b", "0,-1,0,99.8, 1,0,0,200.4, 0,0,1,299.9"});
    REQUIRE(moved.size() == base.size());
    for (std::size_t i = 1; i < base.size(); ++i) {
        INFO("row " << i);
        REQUIRE(base[i].size() == base[0].size());
        for (std::size_t k = 0; k < 4; ++k) CHECK(moved[i][k] == base[i][k]);
        const std::size_t corners = std::stoul(base[i][3]);
        const auto number = [&](const auto& rows, std::size_t cell) { return std::stod(rows[i][cell]); };
        for (std::size_t c = 0; c < 6; ++c) {
            const std::size_t x = 7 + 3 * c;
            CHECK(base[i][x].empty() == (c >= corners));
            if (c >= corners) continue;
            // The translations differ in the last place, which rounding to float mostly hides.
            CHECK(std::abs(number(moved, x) - (100 - number(base, x + 1))) < 1e-6);
            CHECK(std::abs(number(moved, x + 1) - (200 + number(base, x))) < 1e-6);
            CHECK(std::abs(number(moved, x + 2) - (300 + number(base, x + 2))) < 1e-6);
        }
        // A few rounding errors of coordinates near 100.
        for (std::size_t k = 4; k < 7; ++k) CHECK_BETWEEN(1e-14, number(moved, k), 1e-12);
    }
    const program_result first = run_program({"collide", a, b, "--first", "--geometry"});
    CHECK(holds(first.out, " intersect: "));
    const auto json = json_of({"collide", a, b, "--first", "--geometry", "--json"});
    CHECK(holds(first.out, " intersect: " + json["geometry"]["kind"].get<std::string>() + " " +
                               std::to_string(json["geometry"]["corners"].size()) + " "));
    CHECK(json["geometry"]["error"].size() == 3);
    CHECK(holds(first.out, "triangles " + json["first"][0].dump() + " and " + json["first"][1].dump() + " intersect"));
    // With --poses, each intersecting pose has a line.
    const std::string poses = folder.write("poses.txt", "1,0,0,-9,0,1,0,0,0,0,1,0\n1,0,0,0,0,1,0,0,0,0,1,0\n");
    const std::vector<std::string> posed{"collide", a, b, "--first", "--geometry", "--poses", poses};
    const std::string lines = run_program(posed).out;
    const std::string line = first.out.substr(first.out.find('\n') + 1);
    CHECK(holds(lines, "\npose 1: " + line.substr(0, line.find('\n') + 1)));
    CHECK_FALSE(holds(lines, "pose 0: "));
    const auto by_pose = json_of(joined(posed, {"--json"}))["geometry"];
    REQUIRE(by_pose.size() == 2);
    CHECK(by_pose[0].is_null());
    CHECK(by_pose[1] == json["geometry"]);
    const std::string away = "1,0,0,-9,0,1,0,0,0,0,1,0";
    CHECK(holds(run_program({"collide", a, b, "--first", "--geometry", "--pose-a", away}).out, "0 intersecting"));
}

TEST_CASE_METHOD(two_files, "neighbours in a mesh intersect in their shared edge or vertex") {
    for (const auto& [mesh, edges, points] : {std::tuple(a, 6, 0), std::tuple(b, 9, 6)}) {
        run_well({"collide", mesh, "--self=all", "--geometry", "--out", folder / "self.csv"});
        int segment = 0, point = 0;
        for (const auto& row : fields_of(bytes_of_file(folder / "self.csv"))) {
            segment += static_cast<int>(row[2] == "2" && row[3] == "segment" && row[4] == "2" && row[5] == "0");
            point += static_cast<int>(row[2] == "1" && row[3] == "point" && row[4] == "1" && row[5] == "0");
        }
        CHECK(segment == edges);
        CHECK(point == points);
    }
}

TEST_CASE_METHOD(in_folder, "collide and contacts use the singular for a count of one") {
    const std::string mesh = folder.write("one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string motion = folder.write("m.txt", "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n0 1 1 0 0 0 0 1 0 0 0 0 1 0\n");
    const std::string collided = run_program({"collide", mesh, mesh}).out;
    CHECK(holds(collided, "one.off (1 triangle) against "));
    CHECK(holds(collided, "\n1 intersecting pair of triangles, "));
    CHECK(holds(run_program({"contacts", motion, mesh}).out,
                "\n1 contact of triangles in 1 contact of objects (1 pair of boxes),"));
}

TEST_CASE_METHOD(two_files, "collide gives the same results for many poses in one call as in separate calls") {
    const std::vector<std::string> poses{"1,0,0,0.4,0,1,0,0.2,0,0,1,-0.1", "1 0 0 9 0 1 0 0 0 0 1 0",
                                         "0,-1,0,0.4, 1,0,0,0.2, 0,0,1,-0.1"};
    const std::string file =
        folder.write("poses.txt", "# of b\n" + poses[0] + "\n\n" + poses[1] + " # far away\r\n" + poses[2]);
    const auto tested = GENERATE(std::vector<std::string>{}, std::vector<std::string>{"--tree", "canonical"},
                                 std::vector<std::string>{"--engine", "cgal"});
    const auto batch = [&](const std::vector<std::string>& options) {
        return json_of(joined(joined({"collide", a, b, "--json", "--poses", file}, tested), options));
    };
    std::string rows = "pose,a,b\n";
    std::vector<std::size_t> counts;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const std::string out = folder / "one.csv";
        const auto single = json_of(joined({"collide", a, b, "--json", "--pose-b", poses[i], "--out", out}, tested));
        counts.push_back(single["pairs"]);
        for (const std::string& line : lines_of(bytes_of_file(out)))
            if (line != "a,b") rows += std::to_string(i) + "," + line + "\n";
    }
    REQUIRE(counts[0] > 0);
    REQUIRE(counts[1] == 0);
    REQUIRE(counts[2] > 0);
    const auto result = batch({"--out", folder / "all.csv"});
    CHECK(result["pairs"] == counts);
    CHECK(result["query_ms"].size() == 3);
    CHECK(bytes_of_file(folder / "all.csv") == rows);
    // Repeats find the same pairs, which are written once.
    const auto again = batch({"--repeat", "4", "--out", folder / "again.csv"});
    CHECK(again["pairs"] == counts);
    CHECK(again["digest"] == result["digest"]);
    CHECK(again["query_ms"].size() == 12);
    CHECK(bytes_of_file(folder / "again.csv") == rows);
    CHECK(batch({"--count"})["pairs"] == counts);
    // Any pair of the pose may come first; the text reports it too.
    const auto first = batch({"--first"});
    CHECK(first["pairs"] == std::vector{1, 0, 1});
    REQUIRE(first["first"].size() == 3);
    CHECK(first["first"][1].is_null());
    const std::string reported = run_program(joined({"collide", a, b, "--poses", file, "--first"}, tested)).out;
    CHECK_FALSE(holds(reported, "\npose 1: "));
    for (const std::size_t pose : {0, 2}) {
        const std::string s = first["first"][pose][0].dump();
        const std::string t = first["first"][pose][1].dump();
        CHECK(holds("\n" + rows, "\n" + std::to_string(pose) + "," + s + "," + t + "\n"));
        CHECK(holds(reported, "\npose " + std::to_string(pose) + ": triangles " + s + " and " + t + " intersect\n"));
    }
}

TEST_CASE_METHOD(with_mesh_file, "collide --repeat repeats the search and reports each time") {
    const auto check_repeats = [&](const std::vector<std::string>& options) {
        const auto once = json_of(joined({"collide", mesh, "--json"}, options));
        const auto five_times = json_of(joined({"collide", mesh, "--json", "--repeat", "5"}, options));
        CHECK(once["query_ms"].is_number());
        CHECK(five_times["query_ms"].size() == 5);
        for (const char* member : {"pairs", "digest"}) CHECK(five_times[member] == once[member]);
    };
    check_repeats({mesh});
    check_repeats({"--self"});
    CHECK_FALSE(holds(run_program({"collide", "--help"}).out, "{together}"));
    CHECK(holds(run_program({"collide", mesh, mesh, "--repeat", "5"}).out, " ms (median of 5)"));
}

TEST_CASE_METHOD(with_mesh_file, "collide --exit-code exits with status 1 if anything intersects") {
    const std::string elsewhere = "1,0,0,100,0,1,0,0,0,0,1,0";
    const auto status_of = [&](const std::vector<std::string>& options) {
        return run_program(joined({"collide", mesh}, options)).status;
    };
    CHECK(status_of({mesh}) == 0);
    CHECK(status_of({mesh, "--exit-code"}) == 1);
    CHECK(status_of({mesh, "--exit-code", "--count"}) == 1);
    CHECK(status_of({mesh, "--exit-code", "--first", "--json"}) == 1);
    CHECK(status_of({mesh, "--exit-code", "--pose-b", elsewhere}) == 0);
    CHECK(status_of({mesh, "--exit-code", "--poses", folder.write("apart.txt", elsewhere + "\n")}) == 0);
    CHECK(status_of({mesh, "--exit-code", "--poses",
                     folder.write("both.txt", elsewhere + "\n1 0 0 0 0 1 0 0 0 0 1 0\n" + elsewhere + "\n")}) == 1);
    // Neighbours do not count.
    CHECK(status_of({"--self", "--exit-code"}) == 0);
    CHECK(status_of({folder / "absent.off", "--exit-code"}) == 2);
}
