#include "program_json.hpp"

#include "csv_rows.hpp"

namespace {

std::string digest_of(const std::string& scene) {
    return json_of({"pairs", scene, "--json"})["digest"];
}

}  // namespace

TEST_CASE_METHOD(in_folder, "Boxes keep every bit when they are converted, and every format is a scene") {
    const std::string recording = folder / "scene.aabbs";
    run_well({"scene", "brownian", "--objects", "200", "--density", "0.2", "--frames", "3", "--out", recording});
    const std::string digest = digest_of(recording);
    std::string last = recording;
    for (const char* name : {"a.csv", "b.npy", "c.aabbs", "d.npy", "e.csv", "f.aabbs"}) {
        CAPTURE(name);
        CHECK(holds(run_well({"convert", last, folder / name}).out, "200 objects, 4 frames, floats"));
        last = folder / name;
        CHECK(digest_of(last) == digest);
    }
    // The first bytes of a recording are its name and type.
    CHECK(bytes_of_file(last).substr(256) == bytes_of_file(recording).substr(256));
    CHECK(bytes_of_file(folder / "b.npy").size() == 128 + 4 * 200 * 6 * 4);
    CHECK(bytes_of_file(folder / "b.npy") == bytes_of_file(folder / "d.npy"));
}

TEST_CASE_METHOD(in_folder, "Coordinates that are no floats are kept as doubles") {
    // As floats, both boxes would touch.
    const std::string table = folder.write("boxes.csv", "0 0 0 0.1 1 1\n0.10000000000000002 0 0 1 1 1\n");
    for (const char* name : {"a.npy", "a.aabbs", "b.csv"}) {
        CAPTURE(name);
        run_well({"convert", table, folder / name});
        CHECK(json_of({"pairs", folder / name, "--json"})["pairs"] == 0);
    }
    CHECK(holds(bytes_of_file(folder / "a.npy").substr(0, 128), "'descr': '<f8'"));
    CHECK(bytes_of_file(folder / "b.csv") ==
          "frame,object,min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,0,0,0.1,1,1\n0,1,0.10000000000000002,0,0,1,1,1\n");
    CHECK(json_of({"pairs", folder.write("touching.csv", "0;0;0;0.1;1;1\n0.1;0;0;1;1;1\n"), "--json"})["pairs"] == 1);
}

TEST_CASE_METHOD(in_folder, "Tables have any usual columns, and rows in any order") {
    for (const auto& [name, text] : {std::pair<std::string, std::string>("a.csv", "0,0,0,2,2,2\n1,1,1,3,3,3\n"),
                                     {"b.csv", "id x0 y0 z0 x1 y1 z1\n1 1 1 1 3 3 3\n0 0 0 0 2 2 2\n"},
                                     {"d.csv", "mass,xmin,xmax,ymin,ymax,zmin,zmax\n7,0,2,0,2,0,2\n7,1,3,1,3,1,3\n"},
                                     {"e.csv",
                                      "object,frame,min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,0,0,2,2,2\n"
                                      "1,0,1,1,1,3,3,3\n"},
                                     {"c.csv", "0,1,1,1,1,3,3,3\n0,0,0,0,0,2,2,2\n"}}) {
        CAPTURE(name);
        CHECK(json_of({"pairs", folder.write(name, text), "--json"})["pairs"] == 1);
    }
}

TEST_CASE_METHOD(in_folder, "Pairs are written as CSV, as an array and as JSON") {
    const std::string scene =
        folder.write("boxes.csv", "0,0,0,0,0,2,2,2\n0,1,1,1,1,3,3,3\n1,0,0,0,0,2,2,2\n1,1,1,1,1,3,3,3\n");
    for (const char* name : {"pairs.csv", "pairs.npy", "pairs.json"})
        run_well({"pairs", scene, "--out", folder / name});
    CHECK(bytes_of_file(folder / "pairs.csv") == "frame,a,b\n0,0,1\n1,0,1\n");
    const auto json = nlohmann::json::parse(bytes_of_file(folder / "pairs.json"));
    CHECK(json["columns"] == nlohmann::json::array({"frame", "a", "b"}));
    CHECK(json["rows"] == nlohmann::json::array({{0, 0, 1}, {1, 0, 1}}));
    const std::string array = bytes_of_file(folder / "pairs.npy");
    CHECK(holds(array.substr(0, 128), "'descr': '<u4', 'fortran_order': False, 'shape': (2, 3, )"));
    const std::uint32_t values[] = {0, 0, 1, 1, 0, 1};
    CHECK(array.substr(128) == std::string(reinterpret_cast<const char*>(values), sizeof values));

    const std::vector<std::string> collide{"collide", "icosphere:triangles=20", "icosphere:triangles=80", "--geometry"};
    run_well(joined(collide, {"--out", folder / "hits.json"}));
    const auto hits = nlohmann::json::parse(bytes_of_file(folder / "hits.json"));
    for (const auto& row : hits["rows"]) CHECK(row.size() == hits["columns"].size());
    CHECK(holds(run_refused(joined(collide, {"--out", folder / "hits.npy"})).err, "an .npy file has integers only"));
}

TEST_CASE_METHOD(in_folder, "Files that hold no boxes are rejected in one sentence") {
    const auto rejected = [&](const std::string& name, const std::string& text, const std::string& sentence) {
        CAPTURE(name, text);
        CHECK(holds(run_refused({"convert", folder.write(name, text), folder / "out.aabbs"}).err, sentence));
    };
    rejected("a.csv", "0,0,0,1,1\n", "a.csv:1: expected six coordinates");
    rejected("a.csv", "0,0,0,1,1,1\n0,0,0,1,1\n", "a.csv:2: expected 6 columns, found 5");
    rejected("a.csv", "0,0,0,1,1,1\n0,0,0,1,1,x\n", "a.csv:2: expected a finite coordinate, found 'x'");
    rejected("a.csv", "0,0,0,1,1,1\n2,0,0,1,1,1\n", "a.csv:2: the box is inverted");
    rejected("a.csv", "0,0,0,0,0,1,1,1\n1,1,0,0,0,1,1,1\n", "expected each object once in each of 2 frames");
    rejected("a.csv", "\n", "has no boxes");
    rejected("a.csv", "0,0,0,1,1,1O\n0,0,0,1,1,1\n", "a.csv:1: expected a finite coordinate, found '1O'");
    rejected("a.csv", "a,b,c,d,e,f\n0,0,0,1,1,1\n", "a.csv:1: expected a header with min_x");
    rejected("a.npy", "no array", "is not an .npy file");
    CHECK(
        holds(run_refused({"convert", folder / "a.csv", folder / "b.txt"}).err, "expected the ending .aabbs, .csv or"));
    CHECK(holds(run_refused({"convert", folder / "a.csv", folder / "a.csv"}).err, "would overwrite"));
}
