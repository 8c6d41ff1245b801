#include "csv_rows.hpp"

import aabb.extreme;
import aabblab.extreme;
import aabblab.tables;

namespace {

/// Two intersecting triangles, declared disjoint.
const std::string lie =
    "[[case]]\nname = \"lie\"\nsource = \"s\"\nabout = \"a\"\nclass = \"crossing\"\n"
    "first = [[0, 0, 0], [2, 0, 0], [0, 2, 0]]\nsecond = [[0.5, 0.5, -1], [0.5, 0.5, 1], [3, 3, 0]]\n"
    "intersect = false\n";

}  // namespace

TEST_CASE_METHOD(in_folder, "Wrong results are marked in the tables and listed by candidate") {
    std::vector<aabb::extreme_scene> scenes = aabb::extreme_scenes(aabb::extreme_size::small);
    std::erase_if(scenes, [](const aabb::extreme_scene& scene) {
        return scene.name != "two_objects" && scene.name != "many_against_one" && scene.name != "beyond_float";
    });
    REQUIRE(scenes.size() == 3);
    const auto rows_of = [&] { return aabblab::run_extreme_scenes(scenes, aabb::extreme_size::quick); };
    CHECK(aabblab::failures_in(rows_of()).empty());
    for (aabb::extreme_scene& scene : scenes) {
        if (scene.name == "two_objects") scene.rejection = "box 7 is inverted";
        if (scene.name == "many_against_one") scene.most_bytes = 1000;
        scene.accepted_in_double = false;
    }
    const std::vector<aabblab::extreme_row> rows = rows_of();
    const std::vector<std::vector<std::string>> boxes = aabblab::scene_table(rows, aabblab::row_group::boxes).rows;
    REQUIRE(boxes.size() == 1);
    CHECK(boxes[0][0] == "two_objects");
    CHECK(boxes[0][1].ends_with(" WRONG"));
    CHECK(boxes[0][2] == "WRONG");
    const aabblab::table meshes = aabblab::scene_table(rows, aabblab::row_group::meshes);
    REQUIRE(meshes.rows.size() == 2);
    CHECK(meshes.rows[0][1].ends_with(" WRONG"));
    CHECK(meshes.rows[0][2] == "exact");
    CHECK(meshes.rows[1][1].ends_with(" rejected"));
    // An inexact engine must reject the scene too.
    CHECK(meshes.columns[4].name == "fcl");
    CHECK(meshes.rows[1][4] == "WRONG");
    const std::vector<std::string> failures = aabblab::failures_in(rows);
    const auto has = [&](const std::string& sentence) {
        return std::ranges::find(failures, sentence) != failures.end();
    };
    CHECK(has("brute_force on two_objects: returns a result, but must reject the scene"));
    CHECK(has("fcl on beyond_float: returns a result, but must reject the scene"));
    CHECK(std::ranges::any_of(failures, [](const std::string& sentence) {
        return sentence.find(" on many_against_one: holds ") != std::string::npos;
    }));
    const std::vector<std::string> memory = aabblab::memory_in(rows);
    REQUIRE(memory.size() == 1);
    CHECK(memory[0].starts_with("many_against_one, "));
    CHECK(memory[0].ends_with(" bytes; limit: 64 per triangle + 64 KiB = 1,000"));

    // Stored rows give the same.
    const std::string text = csv_of(rows);
    const auto stored = aabblab::read_extreme_rows(folder.write("extreme.csv", text));
    CHECK(csv_of(stored) == text);
    CHECK(aabblab::failures_in(stored) == failures);
    CHECK(aabblab::memory_in(stored) == memory);
    CHECK(aabblab::scene_table(stored, aabblab::row_group::meshes).rows == meshes.rows);
}

TEST_CASE("A case with a wrong expectation fails every exact test, and the program exits with status 1") {
    const temporary_folder folder;
    const std::string file = folder.write("c.toml", lie);
    const std::filesystem::path out = folder / "results";
    const program_result ran = run_program({"validate", "extreme", "--quick", "--cases", file, "--out", out});
    CHECK(ran.status == 1);
    CHECK(holds(ran.err, "aabblab: exact in double on lie: reports that they intersect\n"));
    CHECK(holds(ran.out, "results are not as expected.\n"));
    // Only the lie is wrong.
    CHECK(holds(ran.out, "crossing      1      4 WRONG"));
    for (const std::string scene : {"lattice  ", "flushed_boxes", "same_place", "upward_meshes", "pairs_zero_area"})
        CHECK(holds(ran.out, "\n" + scene));
    CHECK(holds(ran.out, "\n  box_inverted: box 7 is inverted"));
    CHECK(holds(ran.out, "many_against_many, "));
    check_narrow(ran.out.substr(0, ran.out.find("\nRejected:")));

    const auto rows = csv_rows(out / "extreme.csv");
    REQUIRE(rows.size() >= 1000);
    std::set<std::string> wrong;
    std::size_t rejected = 0;
    for (const auto& row : rows) {
        if (row.at("as_expected") == "no") wrong.insert(row.at("scene"));
        if (row.at("answer") != "refused") continue;
        ++rejected;
        CHECK_FALSE(row.at("reason").empty());
    }
    CHECK(wrong == std::set<std::string>{"lie"});
    CHECK(rejected > 100);
}

TEST_CASE_METHOD(in_folder, "validate extreme rejects arguments that do not apply to it") {
    const std::string file = folder.write("c.toml", "[[case]]\nname = 1\n");
    const auto error_of = [](const std::vector<std::string>& arguments) { return run_refused(arguments).err; };
    CHECK(error_of({"validate", "--quick", "extreme", "--cases", file}) ==
          "aabblab: validate: --quick does not apply to 'extreme', whose own options follow its name\n");
    CHECK(error_of({"validate", file, "extreme"}).starts_with("aabblab: validate: CONFIG does not apply to 'extreme'"));
    CHECK(error_of({"validate", "extreme", "--cases", file}) ==
          "aabblab: " + file + ":2: name is a number; expected a name\n");
    CHECK(error_of({"validate", "extreme", "--qiuck"}) ==
          "aabblab: validate extreme: unknown option '--qiuck'; did you mean '--quick'?\n");
    CHECK(holds(error_of({"validate", "extreme", "more.toml"}), "validate extreme: "));
    const std::string help = run_program({"validate", "extreme", "--help"}).out;
    CHECK(holds(help, "--cases FILE"));
    CHECK(holds(help, "\npairs_sliver "));
    CHECK(holds(run_program({"validate", "--help"}).out, "  extreme "));
}
