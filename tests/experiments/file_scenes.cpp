// Recordings and motion files as scenes of an experiment.

#include "program_json.hpp"

#include "configs.hpp"

using aabblab::experiment_size;

namespace {

/// A blank, a comma, quotes, a plus and an equals sign.
const std::string odd = "a b, \"c\"+d=e";

std::string in_toml(const std::filesystem::path& file) {
    return "'" + file.string() + "'";
}

void record(const std::string& file, const std::string& seed) {
    run_well({"scene", "brownian", "--n", "60", "--frames", "3", "--density", "1", "--seed", seed, "--out", file});
}

const std::string mesh = "icosphere:triangles=80";

void record_motion(const std::string& file) {
    run_well({"scene", "mesh_swarm", "--n", "10", "--frames", "3", "--density", "3", "--normalise", "no", "--mesh",
              mesh, "--motion", file});
}

/// @param settings of the scene, lines of TOML
std::string recording_config(const std::string& settings) {
    return "name = \"own\"\nseed = [1, 2]\n[[scene]]\nkind = \"recording\"\n" + settings +
           "[measure]\nrepeats = 1\nmetrics = [\"counts\"]\n";
}

std::string recording_at(const std::filesystem::path& file) {
    return recording_config("file = " + in_toml(file) + "\n");
}

}  // namespace

TEST_CASE_METHOD(in_folder, "Every command finds the same pairs in a user's recordings and motion files") {
    std::map<std::string, std::string> digests;  // by parameters
    std::string files;
    for (const std::string seed : {"3", "4"}) {
        const std::string file = folder / (odd + seed + ".aabbs");
        record(file, seed);
        files += (files.empty() ? "" : ", ") + in_toml(file);
        digests["file=" + file] = json_of({"pairs", file, "--json"})["digest"].get<std::string>();
    }
    const std::string motion = folder / (odd + ".txt");
    record_motion(motion);
    digests["file=" + motion + " meshes=" + mesh] =
        json_of({"contacts", motion, mesh, "--json"})["digest"].get<std::string>();
    REQUIRE(digests.size() == 3);
    const std::string config = folder.write(
        "own.toml",
        "name = \"own\"\nseed = [1, 2]\nengines = [\"cgal\", \"fcl\"]\n[[scene]]\nkind = \"recording\"\n"
        "file = [" +
            files + "]\n[[scene]]\nkind = \"motion\"\nfile = " + in_toml(motion) + "\nmeshes = [\"" + mesh +
            "\"]\n[compose]\nsort = [\"insertion\", \"shell\"]\n"
            "tree = [\"canonical\", \"compressed\"]\n[measure]\nrepeats = 2\n");
    CHECK_FALSE(holds(run_well({"run", config, "--out", folder / "out"}).out, "seed="));
    const auto rows = aabblab::read_rows(folder / "out/results.csv");
    CHECK(rows.size() == 2 * 2 * (2 + 2) + 2 * (4 + 2));
    for (const aabblab::row& r : rows) {
        INFO(r.key());
        // FCL's triangle test may err.
        if (r.scene.kind == "recording" || r.name.engine != "fcl") CHECK(r.status == "exact");
        if (r.status == "exact") CHECK(r.digest == digests.at(parameters_text(r.scene)));
        CHECK(r.frames == 4);
    }
    const std::string validated = run_program({"validate", config}).out;
    CHECK_FALSE(holds(validated, "seed="));
    for (const auto& [parameters, digest] : digests) {
        CHECK(holds(validated, "(" + parameters + ")"));
        CHECK(holds(validated, "digest " + digest));
    }
    const std::string explained = run_well({"explain", config}).out;
    CHECK(holds(explained, "motion (file=" + motion));
    CHECK(holds(explained, "memory after the first 2 of 4 frames; aabblab run reports it after the last\n"));
    const auto manifest = nlohmann::json::parse(bytes_of_file(folder / "out/manifest.json"));
    for (const auto& scene : manifest["scenes"]) {
        const auto& parameters = scene["parameters"];
        const std::string key = "file=" + parameters["file"].get<std::string>();
        CHECK(scene["digest"] == digests.at(parameters.contains("meshes") ? key + " meshes=" + mesh : key));
        CHECK_FALSE(scene.contains("seed"));
    }
}

TEST_CASE_METHOD(in_folder, "Results are resumed unless a recording or motion file has changed") {
    const std::string recording = folder / "a.aabbs";
    const std::string motion = folder / "m.txt";
    record(recording, "1");
    record_motion(motion);
    const std::string config =
        folder.write("c.toml",
                     "name = \"c\"\n[[scene]]\nkind = \"recording\"\nfile = \"a.aabbs\"\n[[scene]]\nkind = \"motion\"\n"
                     "file = \"m.txt\"\nmeshes = [\"" +
                         mesh + "\"]\n[measure]\nrepeats = 1\n");
    const std::vector<std::string> resume{"run", config, "--out", folder / "out", "--resume"};
    run_well(resume);
    const std::string before = bytes_of_file(folder / "out/results.csv");
    run_well(resume);
    CHECK(bytes_of_file(folder / "out/results.csv") == before);
    const std::string poses = bytes_of_file(motion);
    folder.write("m.txt", poses + "4 0 1 0 0 0 0 1 0 0 0 0 1 0\n");
    CHECK(holds(run_refused(resume).err, "of another config"));
    folder.write("m.txt", "# a comment changes nothing\n" + poses);
    run_well(resume);
    record(recording, "2");
    CHECK(holds(run_refused(resume).err, "of another config"));
    CHECK(bytes_of_file(folder / "out/results.csv") == before);
}

TEST_CASE_METHOD(in_folder, "Scenes from files ignore the seeds of a config and reject their own") {
    const std::string file = folder / "a.aabbs";
    record(file, "1");
    const auto e = aabblab::parse_experiment(recording_at(file) + "[[scene]]\nkind = \"still\"\nobjects = 5\n",
                                             "test.toml", experiment_size::full);
    REQUIRE(e.scenes.size() == 1 + 2);
    CHECK_FALSE(e.scenes[0].seed);
    CHECK(aabblab::parameters_text(e.scenes[0]) == "file=" + file);
    const std::string message = " recording reads a file, so it has no seed";
    CHECK(rejection_of(recording_config("file = " + in_toml(file) + "\nseed = 1\n")) == "test.toml:6:" + message);
    CHECK(rejection_of(recording_config("file = " + in_toml(file) + "\nquick={ seed = 1 }\n")) ==
          "test.toml:6:" + message);
    CHECK_THROWS_AS(aabblab::make_box_scene({"recording", {{"file", file}}, {}, 1}), aabb::input_error);
    CHECK_NOTHROW(aabblab::make_box_scene({"recording", {{"file", file}}, {}, std::nullopt}));
    CHECK_THROWS_AS(aabblab::make_box_scene({"still", {}, {}, std::nullopt}), aabb::input_error);
}

TEST_CASE_METHOD(in_folder, "A missing or malformed scene file is rejected with the line of the config") {
    const std::string file = folder / "a.aabbs";
    record(file, "1");
    CHECK(rejection_of(recording_config("")) == "test.toml:3: recording: file must be given, the path of a file");
    CHECK(rejection_of(recording_config("file = \"\"\n")).starts_with("test.toml:3: recording: file must be the path"));
    CHECK(rejection_of(recording_config("file = \"nowhere.aabbs\"\n"), "some/test.toml") ==
          "some/test.toml:5: nowhere.aabbs: no such file, here or in some");
    CHECK(rejection_of(recording_config("file = \"/nowhere.aabbs\"\n")) == "test.toml:5: /nowhere.aabbs: no such file");
    CHECK(rejection_of(recording_at(folder.path())).ends_with(": is a folder, not a file"));
    CHECK(holds(rejection_of(recording_config("flie = \"a\"\n")), "did you mean 'file'?"));
    std::string bytes = bytes_of_file(file);
    bytes.replace(bytes.size() - 32, 4, std::string("\x00\x00\xc0\x7f", 4));  // NaN, in the last box
    const std::string bad = folder.write("bad.aabbs", bytes);
    CHECK(rejection_of(recording_at(bad)) ==
          "test.toml:5: " + bad + ": frame 3: box 59 has a coordinate that is not finite");
    CHECK(rejection_of(recording_config("file = [\n" + in_toml(file) + ",\n" + in_toml(bad) + "]\n"))
              .starts_with("test.toml:7: " + bad + ": frame 3: "));
    const auto motion = [&](const std::string& poses, const std::string& meshes) {
        const std::string motion_file = folder.write("m.txt", poses);
        return rejection_of("name = \"c\"\n[[scene]]\nkind = \"motion\"\nfile = " + in_toml(motion_file) + "\n" +
                            meshes);
    };
    const std::string still = "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n";
    CHECK(motion(still, "") == "test.toml:2: motion needs at least one mesh");
    CHECK(motion("x", "meshes = [\"icosphere\"]\n").starts_with("test.toml:4: " + folder.path().string()));
    CHECK(holds(motion("x", "meshes = [\"icosphere\"]\n"), "m.txt:1: the header lacks a column of frame, object"));
    CHECK(holds(motion(still, "meshes = [\"icosphere\", \"icosphere\"]\n"), "moves 1 objects, but there are 2 meshes"));
    CHECK(motion(still, "meshes = [\"icosphere\"]\n") == "accepted");
}

TEST_CASE_METHOD(in_folder, "A relative path is resolved as given, or else from the folder of the config") {
    std::filesystem::create_directory(folder / "sub");
    record(folder / "sub/a.aabbs", "1");
    const auto e = aabblab::parse_experiment(recording_config("file = \"a.aabbs\"\n"), folder / "sub/c.toml",
                                             experiment_size::full);
    CHECK(aabblab::parameters_text(e.scenes[0]) == "file=a.aabbs");
    const auto here = std::filesystem::relative(folder / "sub/a.aabbs");
    const auto as_given = aabblab::parse_experiment(recording_at(here), folder / "c.toml", experiment_size::full);
    CHECK(aabblab::parameters_text(as_given.scenes[0]) == "file=" + here.string());
    CHECK(e.content_digest == as_given.content_digest);
    REQUIRE_FALSE(std::filesystem::exists("a.aabbs"));
    CHECK(aabblab::make_box_scene(e.scenes[0])->objects() == 60);
}

TEST_CASE_METHOD(in_folder, "A mesh beside the config precedes the data folder, and results store only its name") {
    // The data folder may contain a mesh of this name.
    folder.write("sub/elephant.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string config =
        folder.write("sub/c.toml",
                     "name = \"c\"\n[[scene]]\nkind = \"mesh_pair\"\nframes = 1\nmeshes = \"elephant.off\"\n"
                     "without_data = \"icosphere\"\n[measure]\nrepeats = 1\n");
    const std::filesystem::path relative_config = std::filesystem::relative(config);
    run_well({"run", config, "--out", folder / "out"});
    const auto rows = aabblab::read_rows(folder / "out/results.csv");
    REQUIRE(rows.size() == 1);
    CHECK(rows[0].scene.meshes == std::vector<std::string>{"elephant.off"});
    CHECK(rows[0].triangles == 1);
    run_well({"run", relative_config, "--out", folder / "out", "--resume"});
    CHECK(aabblab::read_rows(folder / "out/results.csv").size() == 1);
    CHECK(holds(
        rejection_of("name = \"c\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = \"absent.off\"\n", "some/test.toml"),
        "(a mesh is a file, here, in some or in "));
}

TEST_CASE_METHOD(in_folder, "scene draws a recording and converts a motion file to one") {
    const std::string file = folder / (odd + ".aabbs");
    record(file, "1");
    const std::string bytes = bytes_of_file(file);
    const std::string picture = folder / "x.svg";
    CHECK(holds(run_well({"scene", "recording", "--file", file, "--picture", picture}).out, "60 objects, 4 frames"));
    CHECK_FALSE(holds(bytes_of_file(picture), "seed"));
    CHECK(holds(bytes_of_file(picture), "file="));
    const std::string motion = folder / "m.txt";
    record_motion(motion);
    const std::string boxes = folder / "m.aabbs";
    const std::string again = folder / "again.txt";
    run_well({"scene", "motion", "--file", motion, "--mesh", mesh, "--out", boxes, "--motion", again});
    CHECK(bytes_of_file(again) == bytes_of_file(motion));
    CHECK(json_of({"pairs", boxes, "--json"})["pairs"] == json_of({"contacts", motion, mesh, "--json"})["candidates"]);
    const std::string far = folder.write("far.txt", "0 0 1 0 0 1e39 0 1 0 0 0 0 1 0\n");
    check_refused({"scene"},
                  {{{"recording", "--picture", picture}, "recording: file must be given, the path of a file"},
                   {{"recording", "--file", file, "--out", file}, "would overwrite"},
                   {{"recording", "--file", file, "--seed", "1", "--picture", picture}, "has no seed"},
                   {{"recording", "--file", folder / "absent", "--picture", picture}, "no such file"},
                   {{"brownian", "--file", file, "--picture", picture}, "unknown parameter of brownian 'file'"},
                   {{"motion", "--file", far, "--mesh", mesh, "--picture", picture},
                    "far.txt: frame 0: object 0 lies beyond the range of float"}});
    CHECK(bytes_of_file(file) == bytes);
}

TEST_CASE_METHOD(in_folder, "A recording in place of a config is rejected with the commands that accept it") {
    const std::string file = folder / "s.aabbs";
    run_well({"scene", "brownian", "--n", "20", "--frames", "1", "--out", file});
    for (const char* command : {"run", "validate"})
        CHECK(run_refused({command, file})
                  .err.ends_with("/s.aabbs is a recording, not a config: pairs, explain and recommend take it, and a "
                                 "config reads it as kind = \"recording\", file = \"s.aabbs\" under [[scene]]\n"));
}

TEST_CASE("list reports which scenes require a file") {
    CHECK(holds(run_program({"list"}).out, "    file=… "));
    std::set<std::string> seedless;
    const auto listed = json_of({"list", "--json"});
    for (const auto& scene : listed["scenes"]) {
        if (scene["has_seed"].get<bool>()) continue;
        seedless.insert(scene["name"].get<std::string>());
        CHECK(scene["parameters"][0]["name"] == "file");
        CHECK(scene["parameters"][0]["default"].is_null());
    }
    CHECK(seedless == std::set<std::string>{"motion", "recording"});
}
