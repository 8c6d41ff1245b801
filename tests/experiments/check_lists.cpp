#include "checked_lists.hpp"

#include "mesh_bytes.hpp"

// `check` on what other commands write, and what it says of lists that are wrong as a whole.

namespace {

using ids = std::vector<std::vector<std::uint32_t>>;

std::string text_of_ids(const ids& list) {
    std::string text;
    for (const auto& row : list) {
        for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + std::to_string(row[i]);
        text += "\n";
    }
    return text;
}

/// Three tetrahedra, of which the second enters the first and the third the second.
constexpr const char* three_objects =
    "0 0  1 0 0 0  0 1 0 0  0 0 1 0\n"
    "0 1  1 0 0 0.25 0 1 0 0.25  0 0 1 0\n"
    "0 2  1 0 0 9 0 1 0 0  0 0 1 0\n"
    "1 2  1 0 0 0.25 0 1 0 0.25  0 0 1 0.125\n"
    "2 0  1 0 0 90 0 1 0 0  0 0 1 0\n";

/// Unit cubes at gaps of 3, 4 and 5; the last one is 12 from the first on x.
void write_four_cubes(const std::string& file) {
    std::vector<std::array<float, 6>> boxes;
    for (const auto& [x, y] : {std::pair{0.F, 0.F}, {4.F, 0.F}, {4.F, 5.F}, {17.F, 0.F}})
        boxes.push_back({x, y, 0, x + 1, y + 1, 1});
    write_boxes(file, {boxes});
}

}  // namespace

TEST_CASE_METHOD(in_folder, "check accepts what pairs, collide and contacts write, in each format") {
    const checked_scene scene = scene_in(folder);
    const std::string motion = folder.write("motion.txt", three_objects);
    const std::string mesh = folder.write("a.off", tetrahedron);
    const std::vector<std::string> two{"icosphere:triangles=80", "torus_knot:triangles=200"};
    // A tetrahedron, and a triangle through it.
    const std::string folded = folder.write("folded.off",
                                            "OFF\n7 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0.2 0.2\n2 0.2 0.2\n0.2 2 0.3\n"
                                            "3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n3 4 5 6\n");
    for (const char* name : {"list.csv", "list.npy", "list.json"}) {
        CAPTURE(name);
        const std::string list = folder / name;
        const auto is_right = [&](const std::vector<std::string>& command, const std::vector<std::string>& scene_of) {
            run_well(joined(command, {"--out", list}));
            const auto report = checked(joined(scene_of, {list}));
            INFO(report.dump());
            CHECK(report["right"] == true);
            CHECK(report["rows"] > 0);
        };
        is_right({"pairs", scene.recording}, {scene.recording});
        is_right(joined({"collide"}, two), two);
        is_right({"pairs", scene.recording, "--swept"}, {scene.recording, "--swept"});
        is_right({"pairs", scene.recording, "--within", "0.25"}, {scene.recording, "--within", "0.25"});
        is_right({"contacts", motion, mesh}, {motion, mesh});
        is_right({"contacts", motion, mesh, "--within", "0.5"}, {motion, mesh, "--within", "0.5"});
        for (const char* self : {"--self", "--self=all", "--self=no-adjacent"})
            is_right({"collide", folded, self}, {folded, self});
    }
    // JSON is read as strictly as other text.
    const auto rejected = [&](const std::string& text, const std::string& sentence) {
        CHECK(holds(run_refused({"check", scene.recording, folder.write("list.json", text)}).err, sentence));
    };
    rejected("{\"columns\":[\"frame\",\"a\",\"b\"],\"rows\":[[0,1]]}", "rows[0] must have 3 columns");
    rejected("{\"columns\":[\"frame\",\"a\",\"b\"],\"rows\":[[0,1,1.5]]}", "rows[0][2] must be an integer");
    rejected("{\"columns\":[\"frame\",\"a\"],\"rows\":[]}", "names no columns a and b");
    rejected("{\"rows\":[]}", "columns is missing");
    rejected("[", "is not a list of pairs");
}

TEST_CASE_METHOD(in_folder, "check counts wrong contacts of moving meshes, and names objects and triangles") {
    const std::string motion = folder.write("motion.txt", three_objects);
    const std::string mesh = folder.write("a.off", tetrahedron);
    run_well({"contacts", motion, mesh, "--out", folder / "right.csv"});
    ids list = numbers_of(bytes_of_file(folder / "right.csv"));
    REQUIRE(list.size() > 6);
    const std::vector<std::uint32_t> lost = list[3];
    list.erase(list.begin() + 3);
    std::swap(list[0][1], list[0][2]);  // objects in the other order, with their triangles
    std::swap(list[0][3], list[0][4]);
    list.push_back({2, 0, 2, 1, 3});  // far away
    list.push_back({1, 2, 2, 0, 1});
    list.push_back({1, 0, 1, 0, 4});
    list.push_back({1, 0, 3, 0, 0});
    const auto report = checked({motion, mesh, folder.write("list.csv", text_of_ids(list))});
    INFO(report.dump());
    CHECK(report["false_negatives"] == 1);
    CHECK(report["false_positives"] == 1);
    CHECK(report["self_pairs"] == 1);
    CHECK(report["unknown_ids"] == 2);
    CHECK(report["frames"] == nlohmann::json::array({{lost[0], 1, 0}, {2, 0, 1}}));
    REQUIRE(report["first"].size() == 2);
    const auto& first = report["first"][0];
    CHECK(first["objects"] == nlohmann::json::array({lost[1], lost[2]}));
    CHECK(first["a"] == lost[3]);
    CHECK(first["b"] == lost[4]);
    CHECK(holds(first["shapes"][0].get<std::string>(), "object " + std::to_string(lost[1]) + ", triangle "));
    CHECK(report["first"][1]["objects"] == nlohmann::json::array({0, 2}));
    const std::string text = run_program({"check", motion, mesh, folder / "list.csv"}).out;
    CHECK(holds(text, "objects 0,2, triangles 1,3 is a false positive"));
    check_narrow(text);
}

TEST_CASE_METHOD(in_folder, "check recognises contacts whose ids count from 1") {
    const std::string motion = folder.write("motion.txt", three_objects);
    const std::string mesh = folder.write("a.off", tetrahedron);
    run_well({"contacts", motion, mesh, "--out", folder / "right.csv"});
    const ids right = numbers_of(bytes_of_file(folder / "right.csv"));
    const auto report = [&](std::uint32_t objects_from, std::uint32_t triangles_from) {
        ids list = right;
        for (auto& row : list)
            for (std::size_t i = 1; i < 5; ++i) row[i] += i < 3 ? objects_from : triangles_from;
        return checked({motion, mesh, folder.write("list.csv", text_of_ids(list))});
    };
    CHECK(report(0, 0)["right"] == true);
    CHECK(holds(pattern_of(report(1, 0)),
                "Objects count from 1: with 1 taken from each of their ids, the list is right."));
    CHECK(holds(pattern_of(report(0, 1)), "Triangles count from 1: with 1 taken"));
    CHECK(holds(pattern_of(report(1, 1)), "Objects and triangles count from 1: with 1 taken"));
    for (const auto& pattern : report(2, 0)["patterns"]) CHECK_FALSE(holds(pattern.get<std::string>(), "from 1"));
}

TEST_CASE_METHOD(in_folder, "check takes lists without pairs that only touch") {
    // Two tetrahedra that share a face touch in it, or cross if one is shifted along it.
    const std::string mesh = folder.write("a.off", tetrahedron);
    const std::string motion = folder.write("motion.txt",
                                            "0 0  1 0 0 0 0 1 0 0 0 0 1 0\n0 1  1 0 0 1 0 1 0 0 0 0 1 0\n"
                                            "1 1  1 0 0 0.25 0 1 0 0.25 0 0 1 0.125\n");
    const std::vector<std::string> two{mesh, mesh, "--pose-b", "1,0,0,0.25,0,1,0,0.25,0,0,1,0"};
    for (const auto& [command, scene] :
         {std::pair<std::vector<std::string>, std::vector<std::string>>{{"contacts", motion, mesh}, {motion, mesh}},
          {joined({"collide"}, two), two}}) {
        CAPTURE(command);
        const std::string full = folder / "full.csv", crossing = folder / "crossing.csv";
        run_well(joined(command, {"--out", full}));
        run_well(joined(command, {"--touching", "no", "--out", crossing}));
        const std::size_t touching =
            numbers_of(bytes_of_file(full)).size() - numbers_of(bytes_of_file(crossing)).size();
        REQUIRE(touching > 0);
        const auto report = [&](const std::string& list, const std::string& wanted) {
            return checked(joined(scene, {list, "--touching", wanted}));
        };
        CHECK(report(full, "yes")["right"] == true);
        CHECK(report(crossing, "no")["right"] == true);
        CHECK(report(crossing, "no")["rows"] > 0);
        CHECK(report(crossing, "yes")["false_negatives"] == touching);
        const auto with_touching = report(full, "no");
        CHECK(with_touching["false_positives"] == touching);
        CHECK(with_touching["classes"]["touching"] == nlohmann::json::array({0, touching}));
        CHECK(pattern_of(with_touching) == "All wrong pairs are of one class: touching.");
    }
}

TEST_CASE_METHOD(in_folder, "check compares lists of what is within a distance, of boxes and of triangles") {
    const std::string scene = folder / "boxes.aabbs";
    write_four_cubes(scene);
    const auto report = [&](const std::string& text, const std::vector<std::string>& options) {
        return checked(joined({scene, folder.write("list.csv", text)}, options));
    };
    const std::string full = "0 1\n0 2\n1 2\n";
    CHECK(report(full, {"--within", "5"})["right"] == true);
    CHECK(report(full, {"--within", "4.5", "--metric", "axis"})["right"] == true);
    const auto open = report("0 1\n1 2\n", {"--within", "5"});
    CHECK(open["classes"]["at D, to 4 units in the last place"] == nlohmann::json::array({1, 0}));
    CHECK(open["first"][0]["description"] == "a distance of 5");
    CHECK(holds(pattern_of(open), "Every false negative is at the distance D"));
    CHECK(holds(pattern_of(report(full, {"--within", "4.5"})), "the list is of --metric axis"));
    CHECK(holds(pattern_of(report("0 1\n1 2\n", {"--within", "4.5", "--metric", "axis"})),
                "as --metric euclidean has it"));
    const auto far = report(full + "0 3\n", {"--within", "5"});
    CHECK(far["classes"]["farther than D"] == nlohmann::json::array({0, 1}));
    CHECK(far["patterns"].empty());
    CHECK(report("0 2\n1 2\n", {"--within", "5"})["classes"]["nearer than D"] == nlohmann::json::array({1, 0}));

    const std::vector<std::string> meshes{"icosphere:triangles=80", "icosphere:triangles=20"};
    const std::vector<std::string> apart{"--pose-b", "1,0,0,2.3,0,1,0,0,0,0,1,0"};
    run_well(joined(joined({"collide"}, meshes), joined(apart, {"--within", "0.7", "--out", folder / "near.csv"})));
    const std::string near = bytes_of_file(folder / "near.csv");
    const auto check_near = [&](const std::string& text, const char* within) {
        return checked(joined(joined(meshes, {folder.write("list.csv", text), "--within", within}), apart));
    };
    CHECK(check_near(near, "0.7")["right"] == true);
    const auto too_few = check_near("a,b\n", "0.7"), too_many = check_near(near, "0.5");
    CHECK(too_few["classes"]["at most D"][0] == too_few["pairs"]);
    CHECK(too_few["classes"]["at most D"][0] > 0);
    CHECK(too_many["classes"]["farther than D"][1] == too_many["false_positives"]);
    CHECK(too_many["false_positives"] > 0);
}

TEST_CASE_METHOD(in_folder, "check knows pairs that a filter leaves out") {
    const checked_scene scene = scene_in(folder);
    const auto [frame, a, b] = scene.pairs.front();
    const std::string except = folder.write("except.csv", "a,b\n" + std::to_string(b) + "," + std::to_string(a) + "\n");
    const std::string full = folder.write("full.csv", text_of(scene.pairs));
    run_well({"pairs", scene.recording, "--except", except, "--out", folder / "kept.csv"});
    CHECK(checked({scene.recording, folder / "kept.csv", "--except", except})["right"] == true);
    const auto report = checked({scene.recording, full, "--except", except});
    CHECK(report["classes"]["left out by the filter"][1] == report["false_positives"]);
    CHECK(report["first"][0]["description"] == "left out by the filter");
    CHECK(holds(report["patterns"][0].get<std::string>(), "left out by --groups or --except"));

    const std::string motion = folder.write("motion.txt", three_objects);
    const std::string mesh = folder.write("a.off", tetrahedron);
    const std::string groups = folder.write("groups.csv", "object,rest\n0,1\n1,1\n");
    run_well({"contacts", motion, mesh, "--out", folder / "all.csv"});
    run_well({"contacts", motion, mesh, "--groups", groups, "--out", folder / "few.csv"});
    CHECK(checked({motion, mesh, folder / "few.csv", "--groups", groups})["right"] == true);
    const auto contacts = checked({motion, mesh, folder / "all.csv", "--groups", groups});
    CHECK(contacts["classes"]["left out by the filter"][1] == contacts["false_positives"]);
    CHECK(contacts["false_positives"] > 0);
}

TEST_CASE_METHOD(in_folder, "check recognises exchanged and mirrored ids, early lists and frames without rows") {
    const checked_scene scene = scene_in(folder);
    const auto report = [&](const std::function<void(rows&)>& damage) {
        rows list = scene.pairs;
        damage(list);
        return checked({scene.recording, folder.write("list.csv", text_of(list))});
    };
    std::map<std::int64_t, int> pairs_of;  // by object
    for (const auto& [frame, a, b] : scene.pairs) ++pairs_of[a], ++pairs_of[b];
    const std::int64_t p = std::ranges::max_element(pairs_of, {}, [](const auto& n) { return n.second; })->first;
    const std::int64_t q = p == 7 ? 8 : 7;
    const auto exchange_from = [&](std::int64_t first) {
        return [&, first](rows& list) {
            for (auto& [frame, a, b] : list)
                for (std::int64_t* id : {&a, &b})
                    if (frame >= first && (*id == p || *id == q)) *id = p + q - *id;
        };
    };
    const std::string exchanged =
        "The ids " + std::to_string(std::min(p, q)) + " and " + std::to_string(std::max(p, q)) + " are exchanged";
    CHECK(holds(pattern_of(report(exchange_from(0))), exchanged + ": with each"));
    CHECK(holds(pattern_of(report(exchange_from(3))), exchanged + " from frame 3 on"));
    CHECK(holds(pattern_of(report([](rows& list) {
                    for (auto& [frame, a, b] : list) a = 59 - a, b = 59 - b;
                })),
                "Ids are mirrored: with 59 - id"));
    // Where 0 is -1, ids are off by one; -7 stands for no object.
    REQUIRE(pairs_of.contains(0));
    const auto less_one = [](std::int64_t of_0) {
        return [of_0](rows& list) {
            for (auto& [frame, a, b] : list)
                for (std::int64_t* id : {&a, &b}) *id = *id == 0 ? of_0 : *id - 1;
        };
    };
    CHECK(holds(pattern_of(report(less_one(-1))), "with 1 added to each"));
    CHECK(report(less_one(-7))["patterns"].empty());
    // No later frame has pairs that frame 0 could list too early.
    const std::string parting = folder.write("parting.csv",
                                             "0,0,0,0,0,1,1,1\n0,1,0,0,0,1,1,1\n1,0,0,0,0,1,1,1\n"
                                             "1,1,5,0,0,6,1,1\n");
    CHECK(holds(pattern_of(checked({parting, folder.write("late.csv", "1,0,1\n")})), "The list is late"));
    const auto early = [](rows& list) {
        for (auto& row : list) --row[0];
    };
    CHECK(holds(pattern_of(report(early)), "Frames are off by one: with 1 added"));
    CHECK(holds(pattern_of(report([&](rows& list) {
                    early(list);
                    std::erase_if(list, [](const auto& row) { return row[0] < 0; });
                })),
                "The list is early"));
    const auto pairs_in = [&](std::int64_t frame) {
        return std::ranges::count_if(scene.pairs, [&](const auto& row) { return row[0] == frame; });
    };
    const auto without_2 = [](rows& list) { std::erase_if(list, [](const auto& row) { return row[0] == 2; }); };
    const std::string lacking = "The list has no rows of frame 2, with " + std::to_string(pairs_in(2)) + " pairs.";
    CHECK(pattern_of(report(without_2)) == lacking + " Its other frames are right.");
    const auto two_errors = report([&](rows& list) {
        without_2(list);
        list.pop_back();
    });
    CHECK(two_errors["patterns"][0] == lacking);
    CHECK(holds(
        report([](rows& list) { std::erase_if(list, [](const auto& row) { return row[0] % 2 == 1; }); })["patterns"][0]
            .get<std::string>(),
        "no rows of frames 1, 3, 5, with"));
}

TEST_CASE_METHOD(in_folder, "check recognises boxes that were rounded from double to float") {
    // Every second box ends 1e-9 before the next one begins, the others touch.
    std::string doubles, right, rounded;
    for (int i = 0; i < 20; ++i) {
        const std::string end = i % 2 == 0 ? std::to_string(i) + ".999999999" : std::to_string(i + 1);
        doubles += std::to_string(i) + "," + std::to_string(i) + ",0,0," + end + ",1,1\n";
        if (i == 19) continue;
        const std::string pair = std::to_string(i) + "," + std::to_string(i + 1) + "\n";
        rounded += pair;
        if (i % 2 == 1) right += pair;
    }
    const std::string scene = folder.write("boxes.csv", doubles);
    CHECK(checked({scene, folder.write("list.csv", right)})["right"] == true);
    const auto report = checked({scene, folder.write("list.csv", rounded)});
    CHECK(report["false_positives"] == 10);
    CHECK(holds(pattern_of(report), "Every wrong pair is right for boxes rounded to float"));
}

TEST_CASE_METHOD(in_folder, "check names a program that writes another list each time, and does not reduce its scene") {
    const checked_scene scene = scene_in(folder);
    const std::string program = folder.write("program.sh", "cd '" + folder.path().string() +
                                                               "'\nn=$(cat n 2>/dev/null || echo 2)\n"
                                                               "sed \"${n}d\" right.csv >\"$2\"\n"
                                                               "echo $((n + 1)) >n\n");
    const std::string smallest = folder / "smallest.aabbs";
    const std::vector<std::string> arguments{scene.recording, "--command", "sh " + program, "--smallest", smallest};
    const auto report = checked(arguments);
    CHECK(report["false_negatives"] == 1);
    const std::string last = report["patterns"].back();
    CHECK(last ==
          "The program is not deterministic: in a second run on the same scene, 2 rows were other. The scene "
          "is not reduced.");
    CHECK_FALSE(std::filesystem::exists(smallest));
}

TEST_CASE_METHOD(in_folder, "check rejects options that do not belong to the scene") {
    const checked_scene scene = scene_in(folder);
    const std::string motion = folder.write("motion.txt", three_objects);
    const std::string mesh = folder.write("a.off", tetrahedron);
    const std::string list = folder / "right.csv";
    check_refused(
        {"check"},
        {{{scene.recording, list, "--metric", "axis"}, "--metric is the distance of boxes"},
         {{mesh, mesh, list, "--within", "1", "--metric", "axis"}, "--metric is the distance of boxes"},
         {{mesh, list, "--self", "--within", "1"}, "--within is about two meshes; omit --self"},
         {{mesh, mesh, list, "--groups", "g.csv"}, "--groups and --except are about several objects"},
         {{mesh, mesh, mesh, list}, "expected a recording, two meshes, or a motion file and its meshes"},
         {{mesh, mesh, list, "--swept"}, "--swept is about boxes"},
         {{scene.recording, list, "--touching", "no"}, "--touching is about triangles, not about boxes"},
         {{mesh, mesh, list, "--within", "1", "--touching", "no"},
          "triangles that need not intersect; omit --touching"},
         {{mesh, list, "--self=all", "--touching", "no"}, "give --touching=no with plain --self"},
         {{motion, mesh, list, "--self"}, "a motion file has the poses of its meshes"},
         {{motion, mesh, "--command", "true"}, "not a motion"},
         {{scene.recording, "--command", "true", "--within", "1"}, "--command checks a list of all overlaps"},
         {{scene.recording, "--command", "true", "--timeout", "0"}, "--timeout is a number of seconds"},
         {{scene.recording, "--command", "true", "--timeout=-3"}, "--timeout is a number of seconds"},
         {{motion, mesh, folder.write("pairs.csv", "0,1\n")},
          "expected object_a,object_b,triangle_a,triangle_b, perhaps after frame"},
         {{motion, mesh, folder.write("names.csv", "frame,a,b\n0,1,2\n")},
          "names no columns object_a,object_b,triangle_a,triangle_b"},
         {{motion, mesh, folder.write("four.csv", "0,1,2,3\n")}, "the list has no frames, but the motion has 3"}});
}
