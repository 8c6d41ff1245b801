#include <catch2/generators/catch_generators.hpp>

#include "program_json.hpp"

#include "csv_rows.hpp"

namespace {

std::string recording_in(const temporary_folder& folder, const std::string& objects = "60") {
    const std::string file = folder / "scene.aabbs";
    const program_result written =
        run_well({"scene", "brownian", "--objects", objects, "--frames", "3", "--seed", "7", "--out", file});
    REQUIRE(written.err.empty());
    REQUIRE(holds(written.out, objects + " objects, 4 frames"));
    return file;
}

}  // namespace

TEST_CASE_METHOD(in_folder, "pairs reports the pairs of brute force with every composition") {
    const std::string scene = recording_in(folder);
    const std::string out = folder / "pairs.csv";
    const auto reference = json_of({"pairs", scene, "--json", "--engine", "brute_force"});
    const auto options = GENERATE(values<std::vector<std::string>>(
        {{}, {"--sort", "insertion", "--partition", "uniform_grid:cell_size=2", "--sweep", "all_axes"}}));
    const auto summary = json_of(joined({"pairs", scene, "--json", "--out", out}, options));
    REQUIRE(summary["objects"] == 60);
    REQUIRE(summary["frames"] == 4);
    REQUIRE(summary["ms"].size() == 4);
    for (const auto& ms : summary["ms"]) REQUIRE(std::round(ms.get<double>() * 1e6) / 1e6 == ms.get<double>());
    for (const char* member : {"pairs", "digest"}) REQUIRE(summary[member] == reference[member]);
    REQUIRE(summary["exact"] == true);

    const std::string rows = bytes_of_file(out);
    REQUIRE(rows.starts_with("frame,a,b\n"));
    const auto records = numbers_of(rows);
    for (const auto& record : records) REQUIRE((record.size() == 3 && record[1] < record[2]));
    REQUIRE(records.size() == summary["pairs"]);
    REQUIRE(std::ranges::is_sorted(records));
}

TEST_CASE_METHOD(in_folder, "pairs --swept finds what meets between two frames, in float and in double") {
    for (const char* x : {"7", "7.1"}) {  // 7.1 is no float
        CAPTURE(x);
        // Box 0 jumps over box 1 between frames 0 and 1, and then rests.
        const std::string scene =
            folder.write("boxes.csv", std::string("0,0,0,0,0,1,1,1\n0,1,4,0,0,5,1,1\n1,0,") + x +
                                          ",0,0,8,1,1\n1,1,4,0,0,5,1,1\n2,0," + x + ",0,0,8,1,1\n2,1,4,0,0,5,1,1\n");
        CHECK(json_of({"pairs", scene, "--json"})["pairs"] == 0);
        run_well({"pairs", scene, "--swept", "--out", folder / "pairs.csv"});
        CHECK(bytes_of_file(folder / "pairs.csv") == "frame,a,b\n1,0,1\n");
    }
}

TEST_CASE_METHOD(in_folder, "pairs prints the scene and the composition") {
    const program_result result = run_well({"pairs", recording_in(folder, "2"), "--sort", "insertion"});
    REQUIRE(holds(result.out, "2 objects, 4 frames"));
    REQUIRE(holds(result.out, "insertion + none + simd"));
    run_well({"pairs", recording_in(folder, "0")});
}

TEST_CASE_METHOD(in_folder, "too many copies of objects are rejected before they are allocated") {
    const std::string scene = folder / "dense.aabbs";
    run_well({"scene", "brownian", "--n", "300", "--density", "3", "--frames", "0", "--out", scene});
    const std::string config = folder.write(
        "dense.toml",
        "name = \"dense\"\n[[scene]]\nkind = \"brownian\"\nobjects = 300\ndensity = 3\nframes = 1\n[compose]\n"
        "sort = \"std\"\npartition = { name = \"axial_cut\", axes = 3, segments = 65535, limit = \"off\" }\n"
        "sweep = \"one_axis\"\n");
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"pairs", scene, "--partition", "axial_cut:axes=3,segments=65535,limit=off"},
          std::vector<std::string>{"run", config, "--out", folder / "results"}})
        CHECK(holds(run_refused(arguments).err, "copies of 300 objects, but at most 16796416"));
}

TEST_CASE_METHOD(in_folder, "pairs never overwrites the recording that it reads") {
    const std::string scene = recording_in(folder);
    const std::string bytes = bytes_of_file(scene);
    std::filesystem::create_symlink(scene, folder / "link.csv");
    for (const std::string& out : {scene, (folder / "." / "scene.aabbs").string(), (folder / "link.csv").string()}) {
        run_refused({"pairs", scene, "--out", out});
        REQUIRE(bytes_of_file(scene) == bytes);
    }
}

TEST_CASE_METHOD(in_folder, "pairs leaves no output file if a later frame has an invalid box") {
    std::string bytes = bytes_of_file(recording_in(folder));
    bytes.replace(bytes.size() - 32, 4, std::string("\x00\x00\xc0\x7f", 4));  // NaN
    run_refused({"pairs", folder.write("bad.aabbs", bytes), "--out", folder / "pairs.csv"});
    REQUIRE(folder.files() == 2);
}
