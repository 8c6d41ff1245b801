#include "checked_lists.hpp"

TEST_CASE_METHOD(in_folder, "check accepts right lists in every format, order of rows, ids and columns") {
    const checked_scene scene = scene_in(folder);
    rows mixed = scene.pairs;
    std::ranges::reverse(mixed);
    for (std::size_t i = 0; i < mixed.size(); i += 3) std::swap(mixed[i][1], mixed[i][2]);
    rows columns = mixed;
    for (auto& [first, second, third] : columns) std::swap(first, third);  // b, a, frame
    std::string quoted = "\"id\";\"Step\";\"I\";\"J\"\n";
    for (const auto& [frame, a, b] : mixed)
        quoted += "7;" + std::to_string(frame) + ";" + std::to_string(a) + ";" + std::to_string(b) + "\n";
    for (const auto& [name, text] : {std::pair<std::string, std::string>("a.csv", text_of(scene.pairs)),
                                     {"b.txt", text_of(mixed, "", ' ')},
                                     {"c.csv", "# from an engine\n\n" + text_of(mixed, "", '\t')},
                                     {"d.csv", text_of(columns, "b,a,frame\n")},
                                     {"e.csv", quoted},
                                     {"f.npy", npy_of(mixed)}}) {
        CAPTURE(name);
        const auto report = checked({scene.recording, folder.write(name, text)});
        CHECK(report["right"] == true);
        CHECK(report["rows"] == scene.pairs.size());
        CHECK(report["correct"] == scene.pairs.size());
    }
    CHECK(holds(run_well({"check", scene.recording, folder / "a.csv"}).out, "The list is right."));
}

TEST_CASE_METHOD(in_folder, "check counts each kind of error, by class, with its place") {
    const checked_scene scene = scene_in(folder);
    rows list = scene.pairs;
    const auto [frame, a, b] = list[5];
    list.erase(list.begin() + 5);
    list.push_back({0, list[0][2], list[0][1]});  // a duplicate in the other order
    list.push_back({1, 4, 4});
    list.push_back({1, 4, 60});
    list.push_back({1, -1, 3});
    list.push_back({6, 0, 1});
    const auto report = checked({scene.recording, folder.write("list.csv", text_of(list))});
    CHECK(report["false_negatives"] == 1);
    CHECK(report["false_positives"] == 0);
    CHECK(report["duplicates"] == 1);
    CHECK(report["self_pairs"] == 1);
    CHECK(report["unknown_ids"] == 2);
    CHECK(report["unknown_frames"] == 1);
    REQUIRE(report["first"].size() == 1);
    CHECK(report["first"][0]["frame"] == frame);
    CHECK(report["first"][0]["a"] == a);
    CHECK(report["first"][0]["b"] == b);
    CHECK(report["first"][0]["listed"] == false);
    CHECK(report["frames"] == nlohmann::json::array({{frame, 1, 0}}));
    const program_result text = run_program({"check", scene.recording, folder / "list.csv"});
    CHECK(text.status == 1);
    for (const char* part :
         {"false negatives            1  pairs", "false positives            0  rows",
          "duplicates                 1  rows that repeat a pair", "self pairs                 1  rows with one object",
          "unknown ids                2  rows with an id that no object has",
          "unknown frames             1  rows with a frame that the scene"})
        CHECK(holds(text.out, part));
}

TEST_CASE_METHOD(in_folder, "check finds every wrong pair of random lists, wherever it stands") {
    const checked_scene scene = scene_in(folder);
    const std::set<std::array<std::int64_t, 3>> truth(scene.pairs.begin(), scene.pairs.end());
    std::uint64_t state = 1;
    const auto below = [&state](std::uint64_t most) {  // a linear congruential generator (Knuth)
        state = state * 6364136223846793005U + 1442695040888963407U;
        return static_cast<std::int64_t>((state >> 33U) % most);
    };
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        std::set<std::array<std::int64_t, 3>> list = truth;
        std::erase_if(list, [&](const auto&) { return below(8) == 0; });
        for (int added = 0; added < 40; ++added) {
            const std::int64_t b = 1 + below(59);
            list.insert({below(6), below(static_cast<std::uint64_t>(b)), b});
        }
        list.insert({i % 6, 58, 59});                                   // behind all others of a frame
        std::map<std::int64_t, std::array<std::uint64_t, 2>> expected;  // by frame
        for (const auto& row : truth) expected[row[0]][0] += !list.contains(row);
        for (const auto& row : list) expected[row[0]][1] += !truth.contains(row);
        auto frames = nlohmann::json::array();
        for (const auto& [frame, wrong] : expected)
            if (wrong[0] + wrong[1] > 0) frames.push_back({frame, wrong[0], wrong[1]});
        const auto report =
            checked({scene.recording, folder.write("list.csv", text_of(rows(list.begin(), list.end())))});
        CHECK(report["frames"] == frames);
        std::uint64_t classified = 0;
        for (const auto& counts : report["classes"])
            classified += counts[0].get<std::uint64_t>() + counts[1].get<std::uint64_t>();
        CHECK(classified ==
              report["false_negatives"].get<std::uint64_t>() + report["false_positives"].get<std::uint64_t>());
    }
}

TEST_CASE_METHOD(in_folder, "check counts long lists in any order, whatever ids they have") {
    const checked_scene scene = scene_in(folder);
    const std::set<std::array<std::int64_t, 3>> truth(scene.pairs.begin(), scene.pairs.end());
    std::uint64_t state = 1;
    const auto below = [&state](std::uint64_t most) {  // a linear congruential generator (Knuth)
        state = state * 6364136223846793005U + 1442695040888963407U;
        return static_cast<std::int64_t>((state >> 31U) % most);
    };
    // Most rows are of objects of the scene; ids of few bits and of all are sorted in different ways.
    for (const std::uint64_t ids : {60ULL, 64ULL, 3'000ULL, 70'000ULL, 4'294'967'295ULL}) {
        CAPTURE(ids);
        rows list = scene.pairs;
        for (int i = 0; i < 20'000; ++i) {
            const auto id = [&] { return below(below(4) == 0 ? ids : 60); };
            list.push_back({below(6), id(), id()});
        }
        std::uint64_t unknown = 0, self = 0;
        std::set<std::array<std::int64_t, 3>> pairs;
        for (const auto& [frame, a, b] : list) {
            const bool is_known = a < 60 && b < 60;
            unknown += !is_known;
            self += is_known && a == b;
            if (is_known && a != b) pairs.insert({frame, std::min(a, b), std::max(a, b)});
        }
        for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[static_cast<std::size_t>(below(i))]);
        if (ids == 64) std::ranges::sort(list, {}, [](const auto& row) { return row[0]; });  // by frame
        const auto report = checked({scene.recording, folder.write("list.csv", text_of(list))});
        CHECK(report["false_negatives"] == 0);
        CHECK(report["false_positives"] == pairs.size() - truth.size());
        CHECK(report["unknown_ids"] == unknown);
        CHECK(report["self_pairs"] == self);
        CHECK(report["duplicates"] == list.size() - unknown - self - pairs.size());
        CHECK(report["first"][0]["b"] < 60);
    }
}

TEST_CASE_METHOD(in_folder, "check classifies many wrong pairs as it does few") {
    constexpr int n = 40;
    std::string every_pair = "a,b\n";
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b) every_pair += std::to_string(a) + "," + std::to_string(b) + "\n";
    folder.write("every_pair.csv", every_pair);
    folder.write("no_pair.csv", "a,b\n");
    for (const double unit : {0x1p-23, 0x1p-52})  // in the last place of 1 to 2; the scene is of floats, or of doubles
        for (const bool has_far : {false, true}) {
            CAPTURE(unit, has_far);
            // Boxes that end, or begin, at 1 and up to 19 units; some of them are far away.
            std::ostringstream boxes, others;
            boxes.precision(17);
            for (int i = 0; i < n; ++i) {
                const double end = 1 + unit * (7 * (i / 2) % 20), y = has_far && i % 3 == 0 ? 1e6 : 0;
                boxes << (i % 2 == 0 ? 0 : end) << ',' << y << ",0," << (i % 2 == 0 ? end : 1.5) << ',' << y + 1
                      << ",1\n";
            }
            // Beside as many others that no row names, the same wrong pairs are few.
            for (int i = 0; i < 8 * n * n; ++i) others << -2 - i << ",9,9," << -2 - i << ",9,9\n";
            const auto report_on = [&](const std::string& scene, const std::string& list) {
                return checked({folder.write("boxes.csv", scene), folder / list});
            };
            for (const std::string list : {"every_pair.csv", "no_pair.csv"}) {
                CAPTURE(list);
                const auto many = report_on(boxes.str(), list), few = report_on(boxes.str() + others.str(), list);
                for (const char* part : {"false_negatives", "false_positives", "classes", "first", "patterns"})
                    CHECK(many[part] == few[part]);
                const bool is_empty = list == "no_pair.csv";
                for (const char* near : {"within 1 unit in the last place", "within 4", "within 16", "beyond 16"})
                    CHECK(many["classes"][near][is_empty ? 0 : 1] > 0);
                CHECK((many["classes"]["touching"][0] > 0) == is_empty);
                CHECK(holds(pattern_of(many), is_empty         ? "The list is empty"
                                              : has_far        ? "No pair is missing"
                                              : unit < 0x1p-23 ? "right for boxes rounded to float"
                                                               : "x may not be tested"));
            }
        }
}

TEST_CASE_METHOD(in_folder, "check names what is wrong with a list as a whole") {
    const checked_scene scene = scene_in(folder);
    const auto pattern = [&](const std::function<void(rows&)>& damage) {
        rows list = scene.pairs;
        damage(list);
        return pattern_of(checked({scene.recording, folder.write("list.csv", text_of(list))}));
    };
    CHECK(holds(pattern([](rows& list) { list.clear(); }), "is empty"));
    CHECK(holds(pattern([](rows& list) {
                    for (auto& [frame, a, b] : list) ++a, ++b;
                }),
                "with 1 taken from each"));
    CHECK(holds(pattern([](rows& list) {
                    for (auto& [frame, a, b] : list) --a, --b;
                }),
                "with 1 added to each"));
    CHECK(holds(pattern([](rows& list) {
                    for (auto& row : list) ++row[0];
                }),
                "Frames are off by one"));
    CHECK(holds(pattern([](rows& list) {  // frame 0 twice, without the last frame
                    rows late;
                    for (const auto& [frame, a, b] : list) {
                        if (frame == 0) late.push_back({0, a, b});
                        if (frame < 5) late.push_back({frame + 1, a, b});
                    }
                    list = late;
                }),
                "The list is late"));
    CHECK(holds(pattern([](rows& list) {
                    rows constant;
                    for (std::int64_t frame = 0; frame < 6; ++frame)
                        for (const auto& [of, a, b] : list)
                            if (of == std::min<std::int64_t>(frame, 2)) constant.push_back({frame, a, b});
                    list = constant;
                }),
                "The list is not renewed: from frame 3 on, it stays that of frame 2"));
    CHECK(holds(pattern([](rows& list) {
                    rows renewed;  // in every third frame
                    for (std::int64_t frame = 0; frame < 6; ++frame)
                        for (const auto& [of, a, b] : list)
                            if (of == frame / 3 * 3) renewed.push_back({frame, a, b});
                    list = renewed;
                }),
                "renewed only now and then"));
    CHECK(holds(pattern([](rows& list) { std::erase_if(list, [](const auto& row) { return row[0] > 3; }); }),
                "ends with frame 3 and is right up to there"));
    CHECK(holds(pattern([](rows& list) {
                    const rows once = list;
                    for (const auto& [frame, a, b] : once) list.push_back({frame, b, a});
                }),
                "Every pair is listed twice"));
    CHECK(holds(pattern([](rows& list) {  // each frame after the second lacks more
                    std::array<int, 6> dropped{};
                    std::erase_if(list, [&](const auto& row) {
                        return row[0] > 1 && dropped[static_cast<std::size_t>(row[0])]++ < row[0] - 1;
                    });
                }),
                "right up to frame 1; then its errors grow"));
}

TEST_CASE_METHOD(in_folder, "check tells touching boxes and rounded ones from others") {
    const float next = std::nextafter(2.F, 3.F);
    // Object 1 touches 0; 2 has a gap of one unit to 0; 3 overlaps 0 by much; 4 overlaps it on x and z only.
    const std::string file = folder / "boxes.aabbs";
    write_boxes(file, {{{0, 0, 0, 2, 2, 2},
                        {2, 0, 0, 3, 2, 2},
                        {next, 0, 0, 4, -0.F + 2, 2},
                        {1, 1, 1, 1.5F, 1.5F, 1.5F},
                        {0, 9, 0, 2, 9.5F, 2}}});
    // The overlaps are 0-1, 0-3 and 1-2.
    const auto report = [&](const std::string& text) { return checked({file, folder.write("list.csv", text)}); };
    REQUIRE(report("0 1\n0 3\n1 2\n")["right"] == true);
    const auto open = report("0 3\n1 2\n");
    CHECK(open["classes"]["touching"] == nlohmann::json::array({1, 0}));
    CHECK(open["first"][0]["description"] == "touching on x");
    CHECK(holds(pattern_of(open), "Every false negative touches"));
    const auto rounded = report("0 1\n0 3\n1 2\n0 2\n");
    CHECK(rounded["classes"]["within 1 unit in the last place"] == nlohmann::json::array({0, 1}));
    CHECK(holds(pattern_of(rounded), "list is of rounded boxes"));
    const std::string shape = rounded["first"][0]["shapes"][1];
    CHECK(shape ==
          "2: x 2.0000002 to 4, y 0 to 2, z 0 to 2; in hexadecimal x 0x1.000002p+1 to 0x1p+2, y 0x0p+0 to "
          "0x1p+1, z 0x0p+0 to 0x1p+1");
    const auto untested = report("0 1\n0 3\n1 2\n0 4\n");
    CHECK(untested["classes"]["beyond 16"] == nlohmann::json::array({0, 1}));
    CHECK(holds(pattern_of(untested), "y may not be tested"));
    const auto deep = report("0 1\n1 2\n");
    CHECK(deep["first"][0]["description"] == "an overlap of 0.5 on x");
    CHECK(deep["patterns"].empty());
}

TEST_CASE_METHOD(in_folder, "check compares triangles of two meshes, at poses, and of one with itself") {
    const std::vector<std::string> meshes{"icosphere:triangles=80", "torus_knot:triangles=200"};
    const std::string poses = folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0.25 0 1 0 0 0 0 1 0.125\n");
    run_well(joined(joined({"collide"}, meshes), {"--poses", poses, "--out", folder / "right.csv"}));
    const std::string right = bytes_of_file(folder / "right.csv");
    const auto check = [&](const std::string& text) {
        return checked(joined(meshes, {folder.write("list.csv", text), "--poses", poses}));
    };
    CHECK(check(right)["right"] == true);
    // The last row is missing, and a row is wrong.
    const std::string damaged = right.substr(0, right.rfind('\n', right.size() - 2) + 1) + "0,0,199\n";
    const auto report = check(damaged);
    CHECK(report["false_negatives"] == 1);
    CHECK(report["false_positives"] == 1);
    std::uint64_t classified = 0;
    for (const auto& counts : report["classes"])
        classified += counts[0].get<std::uint64_t>() + counts[1].get<std::uint64_t>();
    CHECK(classified == 2);
    CHECK(report["first"][0]["shapes"].size() == 2);
    std::string exchanged = "pose,b,a\n" + right.substr(right.find('\n') + 1);
    CHECK(holds(pattern_of(check(exchanged)), "ids are exchanged"));

    for (const char* self : {"--self", "--self=all", "--self=no-adjacent"}) {
        CAPTURE(self);
        const std::string mesh = "noise_sphere:triangles=320";
        run_well({"collide", mesh, self, "--out", folder / "self.csv"});
        CHECK(checked({mesh, folder / "self.csv", self})["right"] == true);
    }
}

TEST_CASE_METHOD(in_folder, "check runs a program and reduces its error to two boxes or triangles") {
    // A program in Python that leaves out pairs which touch on x.
    const std::string program = folder.write("open.py", R"(
import struct, sys
with open(sys.argv[1], "rb") as file: data = file.read()
objects, last = struct.unpack_from("<2i", data, 256)
with open(sys.argv[2], "w") as out:
    for frame in range(last + 1):
        boxes = [struct.unpack_from("<8f", data, 304 + 32 * (frame * objects + i)) for i in range(objects)]
        for a in range(objects):
            for b in range(a + 1, objects):
                p, q = boxes[a], boxes[b]
                if p[0] < q[4] and q[0] < p[4] and all(p[k] <= q[4 + k] and q[k] <= p[4 + k] for k in (1, 2)):
                    print(frame, a, b, file=out)
)");
    std::vector<std::vector<std::array<float, 6>>> frames(4);
    for (std::size_t f = 0; f < frames.size(); ++f)
        for (std::size_t i = 0; i < 30; ++i) {
            const auto x = static_cast<float>(3 * i + (i == 17 && f == 2 ? 2 : 0));
            frames[f].push_back({x, 0, 0, x + 1, 1, 1});
        }
    frames[2][18][0] = frames[2][17][3];
    const std::string scene = folder / "scene.aabbs", smallest = folder / "smallest.aabbs";
    write_boxes(scene, frames);
    const std::string command = "python3 " + program;
    const program_result result = run_program({"check", scene, "--command", command, "--smallest", smallest});
    INFO(result.out + result.err);
    REQUIRE(result.status == 1);
    CHECK(holds(result.out, "Every false negative touches"));
    CHECK(holds(result.out, "2 objects in 1 frame"));
    CHECK(holds(result.out, "aabblab check " + smallest + " --command '" + command + "'"));
    // The printed line repeats the error, and keeps the smallest scene.
    const std::string bytes = bytes_of_file(smallest);
    CHECK(bytes.size() == 304 + 2 * 32);
    const program_result again = run_program({"check", smallest, "--command", command, "--smallest", smallest});
    CHECK(again.status == 1);
    CHECK(bytes_of_file(smallest) == bytes);

    // A program that finds no triangles at all.
    const program_result meshes = run_program({"check", "icosphere:triangles=80", "icosphere:triangles=20", "--command",
                                               "sh -c ': > \"$3\"' sh", "--smallest", folder / "small"});
    INFO(meshes.out + meshes.err);
    REQUIRE(meshes.status == 1);
    CHECK(holds(meshes.out, "2 triangles"));
    for (const char* name : {"small_a.off", "small_b.off"}) CHECK(holds(bytes_of_file(folder / name), "OFF\n3 1 0\n"));
}

TEST_CASE_METHOD(in_folder, "The program in the handbook writes a right list") {
    const std::string handbook = bytes_of_file(AABBLAB_CONFIGS "/../README.md");
    const std::size_t begin = handbook.find("```python\n") + 10;
    const std::string program = folder.write("my.py", handbook.substr(begin, handbook.find("```", begin) - begin));
    const checked_scene scene = scene_in(folder);
    CHECK(holds(run_well({"check", scene.recording, "--command", "python3 " + program}).out, "The list is right."));
}

TEST_CASE_METHOD(in_folder, "check rejects what is no list, and arguments that do not fit, in one sentence") {
    const checked_scene scene = scene_in(folder);
    const auto rejected = [&](const std::vector<std::string>& arguments, const std::string& sentence) {
        CHECK(holds(run_refused(joined({"check"}, arguments)).err, sentence));
    };
    const auto list = [&](const std::string& text) { return folder.write("list.csv", text); };
    rejected({scene.recording, list("0,1,2\n0,1\n")}, "list.csv:2: expected 3 columns, found 2");
    rejected({scene.recording, list("frame,a,b\n0,1,x\n")}, "list.csv:2: expected an integer, found 'x'");
    rejected({scene.recording, list("0,1,2,3\n")}, "list.csv:1: expected a,b or frame,a,b");
    rejected({scene.recording, list("w,h,d,e\n")}, "names no columns a and b");
    rejected({scene.recording, list("body0,body1,frame\n1,2,0\n")}, "names no columns a and b");
    rejected({scene.recording, list("0,1.5,2\n0,1,2\n")}, "list.csv:1: expected an integer, found '1.5'");
    rejected({scene.recording, "--command", "true", "--smallest", "a.npy"}, "expected the ending of the scene, .aabbs");
    rejected({"none.aabbs", "--command", "true"}, "none.aabbs");
    rejected({scene.recording, list("0,1\n")}, "the list has no frames, but the scene has 6");
    rejected({scene.recording, folder.write("no.npy", "PK")}, "no.npy: is not an .npy file");
    rejected({scene.recording, folder / "none.csv"}, "none.csv");
    rejected({scene.recording}, "expected a list of pairs after the scene, or --command");
    rejected({"icosphere", folder / "list.csv"},
             "expected boxes (.aabbs, .csv, .npy), two meshes, or one mesh with --self");
    rejected({scene.recording, folder / "list.csv", "--self"}, "poses and --self are of meshes");
    rejected({"icosphere", folder / "list.csv", "--self=alle"}, "all");
    rejected({scene.recording, "--command", "exit 3; :"}, "ended with status 3");
    rejected({scene.recording, "--command", "true"}, "wrote no list of pairs");
}
