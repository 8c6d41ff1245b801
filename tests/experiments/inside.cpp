#include "program_json.hpp"

// `collide` says how two meshes lie where it finds no intersecting triangles.

namespace {

/// OFF of cubes from `low` to `high` on every axis.
/// @param in_triangles whether each face is two triangles, else a square
std::string cubes(const std::vector<std::pair<double, double>>& ranges, std::size_t faces = 6,
                  bool in_triangles = false) {
    std::string vertices, polygons;
    for (std::size_t c = 0; c < ranges.size(); ++c) {
        const std::array ends{ranges[c].first, ranges[c].second};
        for (unsigned i = 0; i < 8; ++i)
            vertices += std::to_string(ends[i & 1U]) + " " + std::to_string(ends[i >> 1U & 1U]) + " " +
                        std::to_string(ends[i >> 2U & 1U]) + "\n";
        constexpr std::array<std::array<std::size_t, 4>, 6> sides{
            {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
        const auto add = [&](const std::vector<std::size_t>& corners) {
            polygons += std::to_string(corners.size());
            for (const std::size_t corner : corners) polygons += " " + std::to_string(8 * c + corner);
            polygons += "\n";
        };
        for (std::size_t side = 0; side < faces; ++side) {
            const auto& [p, q, r, s] = sides[side];
            if (!in_triangles) {
                add({p, q, r, s});
                continue;
            }
            add({p, q, r});
            add({p, r, s});
        }
    }
    return "OFF\n" + std::to_string(8 * ranges.size()) + " " +
           std::to_string((in_triangles ? 2 : 1) * faces * ranges.size()) + " 0\n" + vertices + polygons;
}

struct nested_cubes : in_folder {
    std::string small = folder.write("small.off", cubes({{-1, 1}}));
    std::string large = folder.write("large.off", cubes({{-4, 4}}));
    std::string open = folder.write("open.off", cubes({{-4, 4}}, 5));
};

}  // namespace

TEST_CASE_METHOD(nested_cubes, "collide says which mesh lies inside the other") {
    const auto relation = [&](const std::vector<std::string>& arguments) {
        return json_of(joined({"collide", "--json"}, arguments));
    };
    const auto inside = relation({small, large});
    CHECK(inside["pairs"] == 0);
    CHECK(inside["relation"] == "a_inside_b");
    CHECK(inside["inside"] == nlohmann::json::parse(R"([[0,0,"a_inside_b"]])"));
    CHECK(inside["surfaces"] == nlohmann::json::parse(R"([
        {"components":1,"open":[],"open_edges":0,"unoriented":[],"inward":[],"self_intersecting":null},
        {"components":1,"open":[],"open_edges":0,"unoriented":[],"inward":[],"self_intersecting":null}])"));
    CHECK(inside["relation_ms"] > 0);
    CHECK(relation({large, small})["relation"] == "b_inside_a");
    CHECK(relation({small, large, "--count"})["relation"] == "a_inside_b");
    CHECK(relation({small, large, "--first"})["relation"] == "a_inside_b");
    CHECK(relation({small, large, "--engine", "brute_force"})["relation"] == "a_inside_b");
    CHECK(holds(run_well({"collide", small, large}).out, "\nA lies inside B\n"));
    CHECK(holds(run_well({"collide", large, small}).out, "\nB lies inside A\n"));
    // Boxes that share no point decide at once.
    const std::vector<std::string> beside{small, large, "--pose-a", "1,0,0,9, 0,1,0,0, 0,0,1,0"};
    const auto disjoint = relation(beside);
    CHECK(disjoint["relation"] == "disjoint");
    CHECK(disjoint["inside"].empty());
    CHECK(!disjoint.contains("surfaces"));
    CHECK(holds(run_well(joined({"collide"}, beside)).out, "\nA and B are disjoint: neither lies inside the other\n"));
    // Nothing is said where triangles intersect or only touch, by an inexact method, or about one mesh.
    for (const char* shift : {"4", "3"}) {
        const std::string pose = "1,0,0," + std::string(shift) + ", 0,1,0,0, 0,0,1,0";
        CHECK(relation({small, large, "--pose-a", pose})["relation"].is_null());
        CHECK(relation({small, large, "--pose-a", pose, "--touching=no"})["relation"].is_null());
        CHECK(!holds(run_well({"collide", small, large, "--pose-a", pose}).out, "inside"));
    }
    CHECK(relation({small, large, "--triangle", "moller"})["relation"].is_null());
    CHECK(!relation({small, "--self"}).contains("relation"));
}

TEST_CASE_METHOD(nested_cubes, "collide --relation says how components lie that share points") {
    const auto meeting = [&](const std::string& a, const std::string& shift) {
        return json_of(
            {"collide", a, large, "--relation", "--pose-a", "1,0,0," + shift + ",0,1,0,0,0,0,1,0", "--json"});
    };
    CHECK(meeting(small, "4")["meeting"] == nlohmann::json::parse(R"([[0,0,"crossing"]])"));
    CHECK(meeting(small, "5")["meeting"] == nlohmann::json::parse(R"([[0,0,"touching"]])"));
    CHECK(meeting(small, "3")["meeting"] == nlohmann::json::parse(R"([[0,0,"a_inside_b"]])"));
    CHECK(meeting(small, "3")["relation"].is_null());
    CHECK(meeting(small, "3")["inside"].empty());
    CHECK(meeting(large, "0")["meeting"] == nlohmann::json::parse(R"([[0,0,"equal"]])"));
    CHECK(meeting(open, "2")["meeting"] == nlohmann::json::parse(R"([[0,0,"undecided"]])"));
    CHECK(meeting(small, "0")["meeting"].empty());
    CHECK(meeting(small, "0")["relation"] == "a_inside_b");
    // One component touches, another lies inside, a third crosses, a fourth is disjoint.
    const std::string four = folder.write("four.off", cubes({{4, 5}, {0, 1}, {-5, -3}, {7, 8}}));
    const auto several = meeting(four, "0");
    CHECK(several["meeting"] == nlohmann::json::parse(R"([[0,0,"touching"],[2,0,"crossing"]])"));
    CHECK(several["inside"] == nlohmann::json::parse(R"([[1,0,"a_inside_b"]])"));
    const std::string text = run_well({"collide", four, large, "--relation"}).out;
    CHECK(holds(text,
                "\n1 pair of components: crossing\n1 pair of components: that of A inside that of B\n1 pair of "
                "components: touching\n"));
    CHECK(holds(run_well({"collide", large, four, "--relation"}).out,
                "\n1 pair of components: that of B inside that of A\n"));
    const std::string poses = folder.write("poses.txt", "1 0 0 0  0 1 0 0  0 0 1 0\n1 0 0 3  0 1 0 0  0 0 1 0\n");
    CHECK(json_of({"collide", large, small, "--poses", poses, "--relation", "--json"})["meeting"] ==
          nlohmann::json::parse(R"([[],[[0,0,"b_inside_a"]]])"));
    check_refused({"collide", small},
                  {{{"--self", "--relation"}, "--relation is about two meshes, so omit --self"},
                   {{large, "--relation", "--count"}, "--relation needs all pairs, so omit --first and --count"},
                   {{large, "--relation", "--first"}, "--relation needs all pairs, so omit --first and --count"},
                   {{large, "--relation", "--within", "1"}, "omit --self, --geometry, --relation and --touching"},
                   {{large, "--relation", "--distance"}, "--distance measures two meshes"}});
    const std::string triangles = folder.write("triangles.off", cubes({{-1, 1}}, 6, /*in_triangles=*/true));
    check_refused({"collide", triangles, triangles, "--relation"},
                  {{{"--triangle", "moller"}, "--relation needs every intersecting pair, but"}});
}

TEST_CASE_METHOD(nested_cubes,
                 "collide --relation names components that intersect themselves, and decides the others") {
    // The first cube, with a vertex drawn out through a face, and a second one touch `large` from outside.
    std::string two = cubes({{4, 5}, {-5, -4}}, 6, /*in_triangles=*/true);
    const std::string corner = "5.000000 5.000000 5.000000\n";
    REQUIRE(count_of(corner, two) == 1);
    two = folder.write("two.off", replaced(two, corner, "3 4.6 4.7\n"));
    const auto summary = json_of({"collide", two, large, "--relation", "--json"});
    CHECK(summary["surfaces"][0]["self_intersecting"] == nlohmann::json::parse("[0]"));
    CHECK(summary["surfaces"][1]["self_intersecting"] == nlohmann::json::parse("[]"));
    CHECK(summary["meeting"] == nlohmann::json::parse(R"([[0,0,"undecided"],[1,0,"touching"]])"));
    const std::string text = run_well({"collide", two, large, "--relation"}).out;
    CHECK(holds(text,
                "\n1 pair of components: touching\n1 pair of components: undecided whether touching or crossing\n"));
    CHECK(holds(text, "\ncomponent 0 of A intersects itself\n"));
    // Where triangles pass through each other, nothing depends on it.
    const auto crossing =
        json_of({"collide", two, large, "--relation", "--pose-a", "1,0,0,-0.5,0,1,0,-0.5,0,0,1,-0.5", "--json"});
    CHECK(crossing["meeting"][0] == nlohmann::json::parse(R"([0,0,"crossing"])"));
}

TEST_CASE_METHOD(nested_cubes, "collide says which surfaces are not closed, not oriented, or face inward") {
    const auto lines = [&](const std::string& a, const std::string& b) {
        const std::string text = run_well({"collide", a, b}).out;
        check_narrow(text.substr(text.find('\n')));  // without the names of the files
        return text;
    };
    CHECK(holds(lines(small, open),
                "\nwhether one lies inside the other cannot be decided: not closed\n"
                "B is not closed: 4 edges belong to an odd number of triangles\n"));
    const auto summary = json_of({"collide", small, open, "--json"});
    CHECK(summary["relation"] == "not_closed");
    CHECK(summary["surfaces"][1]["open_edges"] == 4);
    CHECK(
        holds(lines(open, folder.write("huge.off", cubes({{-9, 9}}))), "\nA lies inside B\nA is not closed: 4 edges"));
    const std::string mirrored = folder.write("mirrored.off", cubes({{4, -4}}));
    CHECK(holds(lines(small, mirrored), "\nA lies inside B\nB faces inward\n"));
    // A hollow: a component that faces inward is none to worry about, but it is named.
    const std::string hollow = folder.write("hollow.off", cubes({{-4, 4}, {2, -2}}));
    CHECK(holds(lines(small, hollow),
                "\nA and B are disjoint, but A has components in a cavity of B\ncomponent 1 of B faces inward\n"));
    const auto in_hollow = json_of({"collide", small, hollow, "--json"});
    CHECK(in_hollow["relation"] == "disjoint");
    CHECK(in_hollow["surfaces"][1]["inward"] == nlohmann::json::parse("[1]"));
    CHECK(in_hollow["inside"] == nlohmann::json::parse(R"([[0,0,"a_inside_b"],[0,1,"a_inside_b"]])"));
    // Both cubes face outward, so that it is not known whether a cavity is meant; nor is it where two overlap.
    const std::string nested = folder.write("nested.off", cubes({{-4, 4}, {-2, 2}}));
    const std::string overlapping = folder.write("overlapping.off", cubes({{-9, 9}, {-8, 10}}));
    for (const std::string& unclear : {nested, overlapping}) {
        CHECK(json_of({"collide", small, unclear, "--json"})["relation"] == "undecided");
        CHECK(holds(lines(small, unclear),
                    "\nwhether one lies inside the other is undecided: components that enclose it"));
    }
    CHECK(json_of({"collide", nested, folder / "huge.off", "--json"})["relation"] == "a_inside_b");
    // The first triangle turned over.
    const std::string turned = folder.write("turned.off", replaced(cubes({{-4, 4}}), "4 0 2 3 1\n", "4 1 3 2 0\n"));
    CHECK(holds(lines(small, turned),
                "\nA lies inside B\nB is not oriented: triangles at an edge face different ways\n"));
    CHECK(json_of({"collide", small, turned, "--json"})["surfaces"][1]["unoriented"] == nlohmann::json::parse("[0]"));
    std::vector<std::pair<double, double>> many;
    for (int i = 0; i < 6; ++i) many.push_back({0.1 * i + 0.05, 0.1 * i});
    CHECK(holds(lines(folder.write("many.off", cubes(many)), large), "\n6 of 6 components of A face inward\n"));
    many.pop_back();
    CHECK(holds(lines(folder.write("many.off", cubes(many)), large), "\ncomponents 0, 1, 2, 3, 4 of A face inward\n"));
    const std::string several = folder.write("several.off", cubes({{-1, 1}, {5, 6}}));
    CHECK(holds(lines(several, large), "\npartly inside: components of one lie inside the other, but not all\n"));
    CHECK(json_of({"collide", several, large, "--json"})["relation"] == "partly_inside");
}

TEST_CASE_METHOD(nested_cubes, "collide --poses says how the meshes lie at each pose") {
    const std::string poses = folder.write("poses.txt",
                                           "1 0 0 0  0 1 0 0  0 0 1 0\n1 0 0 3  0 1 0 0  0 0 1 0\n"
                                           "1 0 0 9  0 1 0 0  0 0 1 0\n0.1 0 0 0  0 0.1 0 0  0 0 0.1 0\n"
                                           "1 0 0 2  0 1 0 2  0 0 1 -2\n");
    const auto summary = json_of({"collide", large, small, "--poses", poses, "--json"});
    CHECK(summary["relation"] == nlohmann::json::parse(R"(["b_inside_a",null,"disjoint","b_inside_a","b_inside_a"])"));
    CHECK(summary["inside"][1].is_null());
    CHECK(summary["inside"][2].empty());
    CHECK(summary["surfaces"].size() == 2);
    const std::string text = run_well({"collide", large, small, "--poses", poses}).out;
    CHECK(holds(text, "\n1 pose: A and B are disjoint: neither lies inside the other\n3 poses: B lies inside A\n"));
    CHECK(json_of({"collide", large, small, "--poses", poses, "--json", "--repeat", "3"})["relation"].size() == 5);
}
