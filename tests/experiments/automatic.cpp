// `auto` in configs and commands, and what explain reports about a scene.

#include "program.hpp"

import aabblab.configs;
import aabblab.measures;
import aabblab.trials;
import aabblab.scenes;

using aabblab::experiment_size;

namespace {

aabblab::experiment parsed(const std::string& compose) {
    return aabblab::parse_experiment(
        "name = \"a\"\n" + compose + "\n[[scene]]\nkind = \"pile\"\nobjects = 60\nframes = 6\n", "a.toml",
        experiment_size::full);
}

std::string rejection_of(const std::string& compose) {
    return refusal_in<aabb::input_error>([&] { return parsed(compose); });
}

bool is_near(double a, double b) {
    return std::abs(a - b) < 1e-6 * (1 + std::abs(b));
}

}  // namespace

TEST_CASE("A config may leave every strategy to auto, or only the unnamed ones") {
    const aabblab::experiment automatic = parsed("compose = \"auto\"");
    CHECK(automatic.compositions.empty());
    REQUIRE(aabblab::candidates_for(automatic, automatic.scenes[0]).size() == 1);
    const aabblab::candidate tested = aabblab::candidates_for(automatic, automatic.scenes[0])[0];
    CHECK(aabblab::text_of(tested.name) == "auto");
    CHECK(tested.exact);
    const aabblab::experiment partial = parsed("[[compose]]\nauto = true\nsort = [\"radix\", \"std\"]\n[[compose]]\n");
    const auto candidates = aabblab::candidates_for(partial, partial.scenes[0]);
    REQUIRE(candidates.size() == 3);
    CHECK(aabblab::text_of(candidates[0].name) == "bucket + columns + simd");
    CHECK(aabblab::text_of(candidates[1].name) == "auto + radix");
    CHECK(aabblab::text_of(candidates[2].name) == "auto + std");
    const aabblab::experiment unprepared = parsed("[[compose]]\nauto = true\nprepare = \"none\"\n");
    CHECK(aabblab::text_of(aabblab::candidates_for(unprepared, unprepared.scenes[0])[0].name) == "auto + prepare none");
    CHECK(hash_of(automatic) != hash_of(partial));
    CHECK(hash_of(automatic) != hash_of(parsed("compose = \"auto\"\nengines = [\"cgal\"]")));
    CHECK(parsed("[[compose]]\nauto = false").automatic.empty());
}

TEST_CASE("Errors in the use of auto in a config are reported with their line") {
    CHECK(rejection_of("compose = \"best\"") == "a.toml:2: compose must be a table or \"auto\", not \"best\"");
    CHECK(
        rejection_of("compose = \"auto\"\n[[compose]]\nsort = \"std\"") ==
        "a.toml:3: compose is already a name, so it cannot be a table too; write [[compose]] with auto = true in place "
        "of compose = \"auto\"");
    CHECK(rejection_of("[[compose]]\nprepare = \"auto\"") ==
          "a.toml:3: auto is not a prepare strategy: omit prepare, and write auto = true beside the named strategies");
    CHECK(rejection_of("[[compose]]\nauto = 1") == "a.toml:3: auto is a number; expected true or false");
    CHECK(rejection_of("[[compose]]\nauto = true\n[[compose]]\nauto = true") == "a.toml:4: this auto is listed twice");
    CHECK(
        rejection_of("[[compose]]\nauto = true\nsort = \"shell\"\nsweep = \"incremental\"").starts_with("a.toml:2: "));
    CHECK(rejection_of("[[compose]]\nauto = true\nprepare = \"split_mesh\"").starts_with("a.toml:4: pile: "));
    CHECK(
        holds(rejection_of("[[external]]\nname = \"auto\"\ncommand = \"true\""), "there is an engine 'auto' already"));
    CHECK(rejection_of("[[compose]]\nautos = true").starts_with("a.toml:3: unknown key of [compose] 'autos'"));
}

TEST_CASE_METHOD(in_folder, "auto finds the exact pairs in a run and is a row of every table") {
    const std::filesystem::path config = folder.write(
        "a.toml",
        "name = \"a\"\n[[compose]]\nauto = true\n[[compose]]\nsort = \"std\"\n[[scene]]\nkind = [\"pile\", "
        "\"population\"]\nobjects = 60\nframes = 6\n[[scene]]\nkind = \"brownian\"\nobjects = 60\nframes = 1\n"
        "[measure]\nrepeats = 1\n");
    const program_result run = run_well({"run", config.string(), "--out", folder / "r"});
    CHECK(holds(run.out, "3 scenes with the baseline std + none + one_axis"));
    CHECK(holds(run.out, "regret"));
    // A row per scene, and one in the summary.
    CHECK(count_of("\n1  auto ", run.out) + count_of("\n2  auto ", run.out) == 4);
}

TEST_CASE("measure_boxes gives overlaps per axis, size ratio and expected pairs") {
    // All overlap on x and z, two pairs on y; of the six pairs on x and z, a fifth is expected to overlap on y.
    const std::vector<aabb::box> boxes{cube(0, 0, 0), cube(0, 0.5F, 0), cube(0, 8, 0), cube(0, 9, 0)};
    const aabblab::box_measures m = aabblab::measure_boxes(boxes);
    CHECK(is_near(m.typical_extent, 1));
    CHECK(is_near(m.size_ratio.value(), 1));
    CHECK(is_near(m.overlaps[0], 3));
    CHECK(is_near(m.overlaps[1], 1));
    CHECK(is_near(m.overlaps[2], 3));
    CHECK(is_near(m.expected_pairs, 6 * 0.2));
    std::vector<aabb::box> one_long = boxes;
    one_long[3].max[2] = 5;
    CHECK(is_near(aabblab::measure_boxes(one_long).size_ratio.value(), 5));
    CHECK(aabblab::measure_boxes({}).expected_pairs == 0);
    // Edges longer than the largest float.
    constexpr float largest = std::numeric_limits<float>::max();
    const std::vector<aabb::box> huge(3, {{-largest, -largest, 0}, {largest, largest, 0}});
    CHECK(aabblab::measure_boxes(huge).size_ratio == 1);
    const aabb::box point{{1, 1, 1}, {1, 1, 1}};
    CHECK_FALSE(aabblab::measure_boxes(std::vector{point, point, boxes[0]}).size_ratio.has_value());
}

TEST_CASE("The table of measures groups digits and shows unknown values as a dash") {
    aabblab::scene_measures m;
    m.objects = 1200;
    m.triangles = 12'345;
    std::string text;
    for (const auto& row : aabblab::measures_table(m).rows) text += row[0] + " " + row[1] + "\n";
    for (const char* line :
         {"objects 1,200\n", "triangles 12,345 in the meshes\n", "size ratio -, the longest of all edges"})
        CHECK(holds(text, line));
}

TEST_CASE("An axis is flat if all present objects overlap on it") {
    const auto m = aabblab::measure_scene({"population", {{"objects", "60"}, {"frames", "6"}}, {}, 1, {}});
    CHECK_BETWEEN(0, m.present, m.objects);
    aabblab::scene_measures flat = m;
    flat.boxes.overlaps[2] = static_cast<double>(flat.present - 1);
    const auto shows_flat_axis = [](const aabblab::scene_measures& measures) {
        return std::ranges::any_of(aabblab::measures_table(measures).rows,
                                   [](const auto& row) { return row[0] == "flat axis"; });
    };
    CHECK(shows_flat_axis(flat));
    CHECK_FALSE(shows_flat_axis(m));
}

TEST_CASE("measure_motion gives displacement, relative displacement, rest and inversions") {
    const std::vector<aabb::box> before{cube(0, 0, 0), cube(2, 0, 0), cube(4, 0, 0), cube(6, 0, 0)};
    std::vector<aabb::box> shifted;
    for (const aabb::box& b : before) shifted.push_back(cube(b.min[0] + 3, 4, 0));
    const aabblab::motion_measures uniform = aabblab::measure_motion(before, shifted, 0);
    CHECK(is_near(uniform.displacement, 5));
    CHECK(is_near(uniform.relative_displacement, 0));
    CHECK(is_near(uniform.at_rest, 0));
    CHECK(is_near(uniform.inversions, 0));
    std::vector<aabb::box> overtaking = before;
    overtaking[0] = cube(5, 0, 0);
    const aabblab::motion_measures passing = aabblab::measure_motion(before, overtaking, 0);
    CHECK(is_near(passing.displacement, 1.25));
    CHECK(is_near(passing.relative_displacement, 2.5));
    CHECK(is_near(passing.at_rest, 0.75));
    CHECK(is_near(passing.inversions, 0.5));
}

TEST_CASE_METHOD(in_folder, "explain reports what it measured and selected for a recording, and what that saves") {
    const std::string file = folder / "p.aabbs";
    run_well({"scene", "pile", "--n", "200", "--frames", "80", "--out", file});
    const program_result reported = run_well({"explain", file});
    for (const char* part :
         {"objects       200\n", "frames        81; sizes and pairs from frame 0, motion from 0 to 3\n",
          "at rest       0 % of the objects\n", "counters of all work  ", "prepare    neighbour_list  4 frames or more",
          "    plans for the next frames\n", "one column of all boxes, sorted and swept",
          " pairs of boxes, with a skin of ", "as selected", "split_large", "axial_cut",
          "build, tree, triangle do not apply to this scene"})
        CHECK(holds(reported.out, part));
    CHECK_FALSE(holds(reported.out, "canonical"));
    // No other sweep can be combined with columns.
    for (const char* part :
         {"\nsweep: no other strategy can be composed with the rest.\n", "\nratio: ms/frame relative",
          "\nms/frame: the mean time per frame", "\nbuild ms: the time to create"})
        CHECK(holds(reported.out, part));
    check_narrow(reported.out);
    CHECK(holds(run_program({"explain", file, file}).err, "a recording is a scene of its own"));
}

TEST_CASE_METHOD(in_folder, "explain reports what each omitted part saves and which strategy has it, if any") {
    const std::string file = folder / "p.aabbs";
    const auto table_of = [&](const char* scene, const char* objects) {
        run_well({"scene", scene, "--n", objects, "--frames", "6", "--out", file});
        std::string reported = run_program({"explain", file}).out;
        std::string in_one_line = reported;
        std::ranges::replace(in_one_line, '\n', ' ');
        CHECK(holds(in_one_line, "5 rounds of 7 frames "));
        return reported.substr(reported.find("\nleft out  "));
    };
    const auto line_of = [](const std::string& table, const std::string& what) {
        const std::size_t at = table.find("\n" + what + " ");
        return at == std::string::npos ? "" : table.substr(at + 1, table.find('\n', at + 1) - at - 1);
    };
    const std::string table = table_of("free_fall", "8");
    INFO(table);
    for (const char* what :
         {"partition", "sort", "sorted intervals on x", "sorted intervals on y", "sorted intervals on z"}) {
        CHECK(line_of(table, what).size() > 30);
        CHECK_FALSE(line_of(table, what).ends_with("-"));
    }
    // With so few boxes only an explicit neighbour_list keeps a Verlet list, and no box is large.
    CHECK(holds(line_of(table, "Verlet list"), "neighbour_list:margin=0.1 "));
    CHECK(line_of(table, "division of large objects").ends_with(" -"));
    CHECK(holds(line_of(table, "work counters"), "counters of all work "));
    CHECK(line_of(table, "work counters").ends_with(" 0"));
    CHECK(line_of(table, "narrow phase").ends_with(" -"));
    CHECK_FALSE(holds(table, "  none "));
    CHECK(holds(line_of(table_of("one_huge", "100"), "division of large objects"), "split_large "));
}

TEST_CASE_METHOD(in_folder, "explain accepts meshes, and a motion file with its meshes") {
    const std::string motion = folder / "m.txt";
    run_well({"scene", "mesh_swarm", "--n", "4", "--frames", "4", "--normalise", "no", "--mesh",
              "icosphere:triangles=80", "--motion", motion});
    CHECK(holds(run_well({"explain", motion, "icosphere:triangles=80"}).out, "triangles     80 in the meshes\n"));
    // The selected composition has a long name.
    run_well({"scene", "mesh_swarm", "--n", "2", "--frames", "5", "--normalise", "no", "--mesh",
              "torus_knot:triangles=20000", "--motion", motion});
    const program_result large = run_well({"explain", motion, "torus_knot:triangles=20000"});
    CHECK(holds(large.out, "implicit:vertices=fetched,front=kept"));
    check_narrow(large.out);
    const program_result pair = run_well({"explain", "icosphere:triangles=80", "torus_knot:triangles=96"});
    for (const char* part : {"canonical", "sah", "interval_arithmetic"}) CHECK(holds(pair.out, part));
    CHECK_FALSE(holds(pair.out, "moller"));
    CHECK(holds(run_refused({"explain", "icosphere", "icosphere", "icosphere"}).err,
                "more than two meshes need a motion file"));
}

TEST_CASE_METHOD(in_folder, "explain reports what it could not measure in the given time") {
    // Every pair of boxes overlaps.
    const std::string file = folder / "p.aabbs";
    run_well({"scene", "brownian", "--n", "4000", "--frames", "4", "--density", "1e6", "--out", file});
    const program_result reported = run_well({"explain", file, "--seconds", "0.01"});
    for (const char* part : {"objects   4,000\n", "the rest  stopped after ",
                             "prepare    neighbour_list  4 frames or more", "stopped after "})
        CHECK(holds(reported.out, part));
    CHECK(holds(run_program({"explain", file, "--seconds", "0"}).err, "is how long to run: a number above 0"));
}

TEST_CASE_METHOD(in_folder, "explain rejects a wrong name before it measures anything") {
    const std::string text = folder.write("m.txt", "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n");
    const std::string cut = folder.write("cut.aabbs", "no recording");
    check_refused({"explain"}, {{{"nope.off"}, "unknown mesh 'nope.off'"},
                                {{"icospher"}, "did you mean 'icosphere'?"},
                                {{text}, "if it is a motion file, its meshes follow it"},
                                {{cut}, cut}});
}

TEST_CASE_METHOD(in_folder, "explain prints no empty section") {
    const std::string config = folder.write("a.toml",
                                            "name = \"a\"\nengines = [\"cgal\"]\n[[scene]]\nkind = \"mesh_pair\"\n"
                                            "meshes = [\"icosphere:triangles=80\"]\nframes = 2\n");
    const program_result reported = run_well({"explain", config});
    CHECK(holds(reported.out, "\n  cgal\n"));
    CHECK(holds(reported.out, "left out\n      partition: so few boxes "));
    CHECK_FALSE(holds(reported.out, "left out\n\n"));
}

TEST_CASE_METHOD(in_folder, "pairs and collide report what auto selected") {
    const std::string file = folder / "p.aabbs";
    run_well({"scene", "pile", "--n", "50", "--frames", "6", "--out", file});
    CHECK(holds(run_program({"pairs", file}).out, "neighbour_list + bucket + columns + simd: "));
    CHECK(holds(run_program({"pairs", file, "--prepare", "none"}).out, "\nbucket + columns + simd: "));
    // The default sort cannot be combined with it.
    CHECK(holds(run_program({"pairs", file, "--sweep", "incremental"}).out, "insertion + none + incremental: "));
    CHECK(holds(run_program({"pairs", file, "--sort", "auto"}).err, "--sort auto: omit the option"));
    const std::vector<std::string> meshes{"icosphere:triangles=80", "torus_knot:triangles=96"};
    CHECK(holds(run_program({"collide", meshes[0], meshes[1]}).out, "\nimplicit:vertices=fetched + exact: "));
    CHECK(holds(run_program({"collide", meshes[0], meshes[1], "--repeat", "100"}).out, "\nsah + implicit + exact: "));
}
