#include "program_json.hpp"

#include "mesh_bytes.hpp"

// --within of pairs, collide and contacts, on examples whose distances are known.

namespace {

/// Unit cubes at gaps of 3, 4 and 5, in one frame; the last box is apart from all by 12 on x.
std::string four_cubes(const temporary_folder& folder, bool in_double) {
    const auto file = [&](auto zero) {
        using real = decltype(zero);
        std::string bytes(256, '\0');
        const auto append = [&](const auto& value) {
            bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        };
        for (const std::int32_t n : {4, 0, in_double ? 1 : 0, 0}) append(n);
        for (const float x : {0.F, 0.F, 0.F, 0.F, 30.F, 30.F, 30.F, 0.F}) append(x);
        for (const auto& at : {std::array{0., 0., 0.}, {4., 0., 0.}, {4., 5., 0.}, {17., 0., 0.}})
            for (const double edge : {0., 1.}) {
                for (const double x : at) append(static_cast<real>(x + edge));
                append(real(0));
            }
        return bytes;
    };
    return folder.write(in_double ? "doubles.aabbs" : "floats.aabbs", in_double ? file(0.0) : file(0.0F));
}

}  // namespace

TEST_CASE_METHOD(in_folder, "pairs --within finds boxes at most so far apart, with every method, in float and double") {
    for (const bool in_double : {false, true}) {
        const std::string scene = four_cubes(folder, in_double);
        const auto rows = [&](const std::vector<std::string>& options) {
            const auto summary = json_of(joined({"pairs", scene, "--json", "--out", folder / "p.csv"}, options));
            CHECK(summary["exact"] == true);
            CHECK(summary["within"].is_number());
            return bytes_of_file(folder / "p.csv").substr(std::string("frame,a,b\n").size());
        };
        for (const std::vector<std::string>& method :
             std::vector<std::vector<std::string>>{{},
                                                   {"--sort", "shell", "--partition", "axial_cut"},
                                                   {"--engine", "brute_force"},
                                                   {"--prepare", "neighbour_list"}}) {
            CAPTURE(in_double, method);
            const auto within = [&](const std::string& d, std::vector<std::string> more = {}) {
                more.insert(more.end(), {"--within", d});
                return rows(joined(method, more));
            };
            CHECK(within("2.9999999999").empty());
            CHECK(within("3") == "0,0,1\n");
            CHECK(within("4.9999999999999991") == "0,0,1\n0,1,2\n");
            CHECK(within("5") == "0,0,1\n0,0,2\n0,1,2\n");
            CHECK(within("4", {"--metric", "axis"}) == "0,0,1\n0,0,2\n0,1,2\n");
            CHECK(within("12") == "0,0,1\n0,0,2\n0,1,2\n0,1,3\n");
            CHECK(within("1e300") == "0,0,1\n0,0,2\n0,0,3\n0,1,2\n0,1,3\n0,2,3\n");
        }
    }
    const std::string scene = four_cubes(folder, false);
    CHECK(holds(run_well({"pairs", scene, "--within", "5"}).out, "3 pairs within 5, digest "));
    CHECK(
        holds(run_well({"pairs", scene, "--within", "5", "--metric", "axis"}).out, " within 5 on each axis, digest "));
    CHECK(json_of({"pairs", scene, "--within", "5", "--metric", "axis", "--json"})["metric"] == "axis");
    CHECK(json_of({"pairs", scene, "--within", "5", "--json"})["metric"] == "euclidean");
    CHECK(holds(run_well({"pairs", scene}).out, "0 overlapping pairs, digest "));
    CHECK(!json_of({"pairs", scene, "--json"}).contains("within"));
}

TEST_CASE_METHOD(with_mesh_file,
                 "collide --within finds triangles at most so far apart, with every tree, at every pose") {
    // The mesh moved by 3 and 4, and by more.
    const std::string poses = folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 90 0 1 0 0 0 0 1 0\n");
    const auto near = json_of({"collide", mesh, mesh, "--within", "0", "--json"});
    const auto meeting = json_of({"collide", mesh, mesh, "--json"});
    CHECK(near["pairs"] == meeting["pairs"]);
    CHECK(near["digest"] == meeting["digest"]);
    CHECK(near["within"] == 0);
    const auto all = json_of({"collide", mesh, mesh, "--within", "1000", "--poses", poses, "--json"});
    const auto triangles = all["triangles"][0].get<std::size_t>();
    CHECK(all["pairs"] == std::vector{triangles * triangles, triangles * triangles});
    for (const char* tree : {"canonical", "compressed", "quantized:bits=5", "implicit"}) {
        CAPTURE(tree);
        const auto by_tree =
            json_of({"collide", mesh, mesh, "--within", "0.25", "--pose-b", "1,0,0,1.25,0,1,0,0,0,0,1,0", "--tree",
                     tree, "--json", "--out", folder / "p.csv"});
        CHECK(by_tree["pairs"] > 0);
        CHECK(by_tree["kinds"]["none"] == by_tree["pairs"]);
        CHECK(by_tree["method"] == std::string(tree) + " + distance");
        CHECK(by_tree["exact"] == true);
        const std::string rows = bytes_of_file(folder / "p.csv");
        CHECK(rows.starts_with("a,b\n"));
        const auto counted = json_of({"collide", mesh, mesh, "--within", "0.25", "--pose-b",
                                      "1,0,0,1.25,0,1,0,0,0,0,1,0", "--tree", tree, "--count", "--json"});
        CHECK(counted["pairs"] == by_tree["pairs"]);
    }
    const std::vector<std::string> apart{"collide", mesh, mesh, "--pose-b", "1,0,0,1.25,0,1,0,0,0,0,1,0", "--within"};
    CHECK(holds(run_well(joined(apart, {"0.25", "--first"})).out, " are within 0.25\n"));
    CHECK(
        holds(run_well(joined(apart, {"0.24999999999999997"})).out, "0 pairs of triangles within 0.24999999999999997"));
    CHECK(run_program(joined(apart, {"0.25", "--exit-code"})).status == 1);
    CHECK(run_program(joined(apart, {"0.2", "--exit-code"})).status == 0);
}

TEST_CASE_METHOD(with_mesh_file, "contacts --within finds triangles at most so far apart, in every frame") {
    const std::string motion = folder.write("m.txt",
                                            "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n"
                                            "0 1 1 0 0 9 0 1 0 0 0 0 1 0\n"
                                            "1 1 1 0 0 1.25 0 1 0 0 0 0 1 0\n"
                                            "2 1 1 0 0 1.5 0 1 0 0 0 0 1 0\n");
    const std::vector<std::string> base{"contacts", motion,   mesh,    "--within",
                                        "0.25",     "--json", "--out", folder / "c.csv"};
    const auto reference = json_of(base);
    CHECK(reference["contacts"] > 0);
    CHECK(reference["object_pairs"] == 1);
    CHECK(reference["within"] == 0.25);
    const std::string rows = bytes_of_file(folder / "c.csv");
    CHECK(rows.starts_with("frame,object_a,object_b,triangle_a,triangle_b\n1,0,1,"));
    CHECK_FALSE(holds(rows, "\n2,"));
    const auto collided =
        json_of({"collide", mesh, mesh, "--within", "0.25", "--pose-b", "1,0,0,1.25,0,1,0,0,0,0,1,0", "--json"});
    CHECK(collided["pairs"] == reference["contacts"]);
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {"--tree", "compressed", "--prepare", "split_mesh:size=0.1"},
             {"--sort", "shell", "--partition", "axial_cut", "--prepare", "split_large:size=2"},
             {"--prepare", "neighbour_list", "--build", "sah"}}) {
        CAPTURE(options);
        CHECK(json_of(joined(base, options))["digest"] == reference["digest"]);
        CHECK(bytes_of_file(folder / "c.csv") == rows);
    }
    CHECK(holds(run_well({"contacts", motion, mesh, "--within", "0.25"}).out, "of triangles within 0.25 in 1 pair of"));
}

TEST_CASE_METHOD(with_mesh_file, "collide --distance measures how far apart meshes are, and where, at every pose") {
    const std::string poses = folder.write("poses.txt",
                                           "1 0 0 1.25 0 1 0 0 0 0 1 0\n1 0 0 0.5 0 1 0 0 0 0 1 0\n"
                                           "1 0 0 4 0 1 0 -5 0 0 1 0\n");
    for (const char* tree : {"canonical", "compressed", "quantized:bits=5", "implicit"}) {
        CAPTURE(tree);
        const auto result = json_of({"collide", mesh, mesh, "--distance", "--poses", poses, "--tree", tree, "--json"});
        CHECK(result["triangles"] == std::vector{4, 4});
        const auto distances = result["distance"].get<std::vector<double>>();
        const auto errors = result["error"].get<std::vector<double>>();
        REQUIRE(distances.size() == 3);
        CHECK(std::abs(distances[0] - 0.25) <= errors[0]);
        CHECK(distances[1] == 0);
        CHECK(errors[1] == 0);
        CHECK(std::abs(distances[2] - 5) <= errors[2]);  // of (1, 0, 0) and (4, -4, 0)
        for (const double error : errors) CHECK(error < 1e-13);
        const auto points = result["points"][2].get<std::vector<std::vector<double>>>();
        CHECK(std::abs(points[0][0] - 1) < 1e-13);
        CHECK(std::abs(points[1][1] + 4) < 1e-13);
        CHECK(result["point_error"].size() == 3);
        CHECK(result["method"] == std::string(tree) + " + distance");
    }
    const auto single = json_of({"collide", mesh, mesh, "--distance", "--pose-b", "1,0,0,3,0,1,0,0,0,0,1,0", "--json"});
    CHECK(std::abs(single["distance"].get<double>() - 2) <= single["error"].get<double>());
    const std::string text = run_well({"collide", mesh, mesh, "--distance", "--poses", poses}).out;
    CHECK(holds(text, "pose 0: distance 0.25"));
    CHECK(holds(text, "pose 1: distance 0, error at most 0\n"));
    CHECK(holds(text, " meet at ("));
    for (const char* option : {"--first", "--count", "--self", "--geometry", "--exit-code"})
        CHECK(holds(run_program({"collide", mesh, mesh, "--distance", option}).err, "--"));
    CHECK(holds(run_program({"collide", mesh, mesh, "--distance", "--first"}).err, "--distance measures two meshes"));
    CHECK(holds(run_program({"collide", mesh, mesh, "--distance", "--engine", "fcl"}).err, "omit --engine"));
}

TEST_CASE_METHOD(with_mesh_file, "What has no meaning for distances is rejected with --within") {
    const auto refusal = [](std::vector<std::string> arguments) {
        const program_result result = run_program(std::move(arguments));
        CHECK(result.status == 2);
        return result.err;
    };
    const std::string scene = four_cubes(folder, false);
    for (const char* d : {"-1", "nan", "inf", "far"})
        CHECK(holds(refusal({"pairs", scene, "--within", d}),
                    "--within is a distance: a finite number that is not negative, not '" + std::string(d) + "'"));
    CHECK(holds(refusal({"pairs", scene, "--metric", "axis"}), "--metric is the distance of --within D; give both"));
    CHECK(holds(refusal({"pairs", scene, "--within", "1", "--metric", "max"}),
                "--metric is euclidean or axis, not 'max'"));
    CHECK(holds(refusal({"collide", mesh, "--self", "--within", "1"}),
                "omit --self, --geometry, --relation and --touching"));
    CHECK(holds(refusal({"collide", mesh, mesh, "--engine", "cgal", "--within", "1"}), "omit --engine"));
    CHECK(holds(refusal({"collide", mesh, mesh, "--triangle", "moller", "--within", "1"}), "omit --triangle"));
    for (const char* asks : {"--within=1", "--distance"})
        CHECK(holds(refusal({"collide", mesh, mesh, "--tree", "leafless:leaf_test=triangle_box", asks}),
                    "omit leaf_test"));
    CHECK(holds(refusal({"contacts", mesh, mesh, "--touching", "no", "--within", "1"}),
                "omit --geometry and --touching"));
}
