// Filters from files, in each command that takes them.
#include <set>

#include "../experiments/program_json.hpp"

#include "../experiments/csv_rows.hpp"
#include "../experiments/mesh_bytes.hpp"

namespace {

/// Four boxes, which all overlap, in two frames; box 3 is far away in the second.
std::string recording_in(const temporary_folder& folder) {
    std::string bytes(256, '\0');
    const auto add = [&](auto number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); };
    const auto add_box = [&](float low, float high) {
        for (const float corner : {low, high}) {
            for (int k = 0; k < 3; ++k) add(corner);
            add(0.0F);
        }
    };
    for (const std::int32_t number : {4, 1, 0, 0}) add(number);
    add_box(0, 9);
    for (int frame = 0; frame < 2; ++frame)
        for (int id = 0; id < 4; ++id) {
            const float low = frame == 1 && id == 3 ? 8 : 0;
            add_box(low, low + 1);
        }
    return folder.write("scene.aabbs", bytes);
}

using rows = std::vector<std::vector<std::uint32_t>>;

/// Forty objects at rest in a row, 0.5 apart from each other, and four that pass through them in twelve frames, as
/// lines of a file: `row(frame, object, x, y)`.
template <class Row>
std::string passing_objects(Row row) {
    std::string text;
    for (int frame = 0; frame < 12; ++frame)
        for (int id = 0; id < 44; ++id) {
            const bool rests = id < 40;
            text += row(frame, id, rests ? 1.5 * id : 4.0 * (id - 40) + 3 * frame, rests ? 0.0 : 0.75);
        }
    return text;
}

std::string boxes_row(int frame, int id, double x, double y) {
    std::string row = std::to_string(frame) + "," + std::to_string(id);
    for (const double edge : {0.0, 1.0})
        row += "," + std::to_string(x + edge) + "," + std::to_string(y + edge) + "," + std::to_string(edge);
    return row + "\n";
}

std::string motion_row(int frame, int id, double x, double y) {
    return std::to_string(frame) + " " + std::to_string(id) + " 1 0 0 " + std::to_string(x) + " 0 1 0 " +
           std::to_string(y) + " 0 0 1 0\n";
}

/// Files of objects that rest and of two sets, and whether they keep a pair.
struct rest_and_sets {
    explicit rest_and_sets(const temporary_folder& folder) {
        std::string of_rest = "object,rest\n", of_sets = "object,set\n";
        for (int id = 0; id < 44; ++id) {
            of_rest += std::to_string(id) + (id < 40 ? ",1\n" : ",0\n");
            of_sets += std::to_string(id) + (id % 8 == 0 ? ",a\n" : ",b\n");
        }
        files = {
            {folder.write("rest.csv", of_rest), [](std::uint32_t a, std::uint32_t b) { return a >= 40 || b >= 40; }},
            {folder.write("sets.csv", of_sets),
             [](std::uint32_t a, std::uint32_t b) { return (a % 8 == 0) != (b % 8 == 0); }}};
    }
    std::map<std::string, std::function<bool(std::uint32_t a, std::uint32_t b)>> files;
};

}  // namespace

TEST_CASE_METHOD(in_folder, "pairs leaves out what the files say, with every strategy and engine alike") {
    const std::string scene = recording_in(folder);
    const std::string out = folder / "pairs.csv";
    const auto pairs = [&](const std::vector<std::string>& options) {
        const auto summary = json_of(joined({"pairs", scene, "--json", "--out", out}, options));
        const rows written = numbers_of(bytes_of_file(out));
        CHECK(summary["pairs"] == written.size());
        return written;
    };
    CHECK(pairs({}).size() == 6 + 3);
    const std::string masks = folder.write("masks.csv", "object,group,mask\n0,0x1,0x2\n1,2,1\n2,2,-1\n3,4,\n");
    const rows by_masks{{0, 0, 1}, {0, 0, 2}, {0, 2, 3}, {1, 0, 1}, {1, 0, 2}};
    const std::string sets = folder.write("sets.csv", "set , object\r\n a , 0\r\n\r\nb,3\r\n,1\r\n");
    const std::string rest = folder.write("rest.csv", "object,rest\n3,1\n0,1\n1,0\n");
    const std::string except = folder.write("except.csv", "a,b\n1,0\n2,3\n0,1\n");
    const std::vector<std::vector<std::string>> methods{
        {}, {"--engine", "brute_force"}, {"--sort", "shell", "--sweep", "all_axes"}, {"--prepare", "neighbour_list"}};
    for (const std::vector<std::string>& method : methods) {
        CAPTURE(method);
        CHECK(pairs(joined(method, {"--groups", masks})) == by_masks);
        CHECK(pairs(joined(method, {"--groups", sets})) == rows{{0, 0, 3}});
        CHECK(pairs(joined(method, {"--groups", rest})) ==
              rows{{0, 0, 1}, {0, 0, 2}, {0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 0, 1}, {1, 0, 2}, {1, 1, 2}});
        CHECK(pairs(joined(method, {"--except", except})) ==
              rows{{0, 0, 2}, {0, 0, 3}, {0, 1, 2}, {0, 1, 3}, {1, 0, 2}, {1, 1, 2}});
        CHECK(pairs(joined(method, {"--except", except, "--groups", masks})) == rows{{0, 0, 2}, {1, 0, 2}});
    }
    CHECK(holds(run_well({"pairs", scene, "--groups", sets}).out, ", filtered by " + sets + ": 4 objects"));
    // The digest is that of the pairs that are kept.
    const auto digest = [&](const std::vector<std::string>& options) {
        return json_of(joined({"pairs", scene, "--json"}, options))["digest"];
    };
    const std::string nothing = folder.write("nothing.csv", "object,group,mask,set,rest\n0,,,,\n");
    CHECK(digest({"--groups", nothing}) == digest({}));
    CHECK(digest({"--except", except}) != digest({}));
    const std::string every_pair = folder.write("all.csv", "a,b\n0,1\n0,2\n1,2\n0,3\n1,3\n2,3\n");
    CHECK(digest({"--except", every_pair}) ==
          digest({"--groups", folder.write("0.csv", "object,mask\n0,0\n1,0\n2,0\n3,0\n")}));
}

TEST_CASE_METHOD(in_folder, "malformed filters are rejected with file and line") {
    const std::string scene = recording_in(folder);
    const auto check = [&](const char* option, const std::string& text, const std::string& message) {
        const std::string file = folder.write("f.csv", text);
        CAPTURE(text);
        CHECK(run_refused({"pairs", scene, option, file}).err == "aabblab: " + file + message + "\n");
    };
    const std::string columns = "object,group,mask,set,rest";
    const std::string known = "the number of an object, below 4, as the scene has 4";
    check("--groups", "", ": is empty; expected the header " + columns);
    check("--groups", "\n \n", ": is empty; expected the header " + columns);
    check("--groups", "group,mask\n", ":1: the header lacks the column object; expected " + columns);
    check("--groups", "object,goup\n", ":1: unknown column 'goup'; did you mean 'group'?");
    check("--groups", "0,1,1\n", ":1: there is no header; expected " + columns + " before the first row");
    check("--groups", "object,0\n", ":1: unknown column '0'; expected one of object, group, mask, set, rest");
    check("--groups", "object,mask,mask\n", ":1: the header has the column mask twice");
    check("--groups", "object,mask\n0,1,1\n", ":2: expected 2 values, object,mask, found 3");
    check("--groups", "object,mask\n\n4,1\n", ":3: object is '4'; expected " + known);
    check("--groups", "object,mask\n-1,1\n", ":2: object is '-1'; expected " + known);
    check("--groups", "object,mask\n,1\n", ":2: object is ''; expected " + known);
    check("--groups", "object,mask\n0,1\n1,1\n0,1\n", ":4: object 0 is listed twice");
    const std::string bits = "32 bits, as a number such as 5, 0x5 or -3, or -1 for all";
    for (const char* bad : {"4294967296", "-2147483649", "--1", "0x", "1e3", "0b1", "0x100000000", "1 2"})
        check("--groups", "object,mask\n0," + std::string(bad) + "\n",
              ":2: mask is '" + std::string(bad) + "'; expected " + bits);
    check("--groups", "object,group\n0,x\n", ":2: group is 'x'; expected " + bits);
    check("--groups", "object,set\n0,c\n", ":2: set is 'c'; expected a, b or nothing");
    check("--groups", "object,rest\n0,yes\n", ":2: rest is 'yes'; expected 1 for an object at rest, else 0");
    check("--except", "a,c\n", ":1: unknown column 'c'; expected one of a, b");
    check("--except", "0,1\n2,3\n", ":1: there is no header; expected a,b before the first row");
    check("--except", " -1 ,1\n", ":1: there is no header; expected a,b before the first row");
    check("--except", "a\n", ":1: the header lacks the column b; expected a,b");
    check("--except", "a,b\n0,4\n", ":2: b is '4'; expected " + known);
    check("--except", "a,b\n0,1\n2,2\n", ":3: object 2 is paired with itself");
    CHECK(holds(run_refused({"pairs", scene, "--groups", folder / "none.csv"}).err, "none.csv: no such file"));
    const std::string good = folder.write("good.csv", "a,b\n0,1\n");
    CHECK(holds(run_refused({"pairs", scene, "--except", good, "--out", good}).err, "would overwrite"));
    CHECK(bytes_of_file(good) == "a,b\n0,1\n");
}

TEST_CASE_METHOD(in_folder, "pairs --within and --swept leave out what the files say") {
    const std::string scene = folder.write("boxes.csv", passing_objects(boxes_row)), out = folder / "pairs.csv";
    const rest_and_sets filters(folder);
    const auto pairs = [&](const std::vector<std::string>& options) {
        run_well(joined({"pairs", scene, "--out", out}, options));
        return numbers_of(bytes_of_file(out));
    };
    for (const std::vector<std::string>& question : std::vector<std::vector<std::string>>{
             {"--within", "0.6"}, {"--metric", "axis", "--within", "0.6"}, {"--swept"}, {}})
        for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
                 {}, {"--prepare", "neighbour_list"}, {"--engine", "brute_force"}, {"--sort", "shell"}})
            for (const auto& [file, keeps] : filters.files) {
                CAPTURE(question, method, file);
                const std::vector<std::string> options = joined(question, method);
                rows expected = pairs(options);
                const std::size_t unfiltered = expected.size();
                std::erase_if(expected, [&](const auto& row) { return !keeps(row[1], row[2]); });
                CHECK(pairs(joined(options, {"--groups", file})) == expected);
                CHECK(expected.size() > 12);
                if (!question.empty() && question.back() == "0.6") CHECK(expected.size() < unfiltered);
            }
}

TEST_CASE_METHOD(with_mesh_file, "contacts --within leaves out what the files say") {
    const std::string motion = folder.write("motion.txt", passing_objects(motion_row)), out = folder / "contacts.csv";
    const rest_and_sets filters(folder);
    const auto contacts = [&](const std::vector<std::string>& options) {
        run_well(joined({"contacts", motion, mesh, "--within", "0.6", "--out", out}, options));
        return numbers_of(bytes_of_file(out));
    };
    for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
             {}, {"--prepare", "neighbour_list"}, {"--prepare", "split_mesh:size=0.1"}, {"--tree", "canonical"}})
        for (const auto& [file, keeps] : filters.files) {
            CAPTURE(method, file);
            rows expected = contacts(method);
            const std::size_t unfiltered = expected.size();
            std::erase_if(expected, [&](const auto& row) { return !keeps(row[1], row[2]); });
            CHECK(contacts(joined(method, {"--groups", file})) == expected);
            CHECK(expected.size() > 12);
            CHECK(expected.size() < unfiltered);
        }
}

TEST_CASE_METHOD(with_mesh_file, "summaries as JSON name the files of the filter") {
    const std::string scene = folder.write("boxes.csv", passing_objects(boxes_row));
    const std::string motion = folder.write("motion.txt", passing_objects(motion_row));
    const std::string rest = folder.write("rest.csv", "object,rest\n0,1\n");
    const std::string except = folder.write("except.csv", "a,b\n0,1\n");
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"pairs", scene, "--json"}, {"contacts", motion, mesh, "--json"}}) {
        CHECK_FALSE(json_of(command).contains("groups"));
        CHECK_FALSE(json_of(command).contains("except"));
        CHECK(json_of(joined(command, {"--groups", rest}))["groups"] == rest);
        const auto both = json_of(joined(command, {"--except", except, "--groups", rest}));
        CHECK(both["groups"] == rest);
        CHECK(both["except"] == except);
    }
}

TEST_CASE_METHOD(in_folder, "pairs of an external engine are those of all objects, and are filtered") {
    // It finds all pairs of the recording, whatever rests.
    std::filesystem::permissions(folder.write("mine", R"(#!/bin/sh
')" AABBLAB_UNDER_TEST R"(' pairs "$1" --engine brute_force --out "$2" >/dev/null || exit
{ echo frame,update_ms,search_ms; seq 0 20 | sed 's/$/,0.5,1/'; } >"$3"
)"),
                                 std::filesystem::perms::owner_all);
    std::string rest = "object,rest\n";
    for (int id = 0; id < 140; ++id) rest += std::to_string(id) + ",1\n";
    folder.write("rest.csv", rest);
    folder.write("except.csv", "a,b\n140,149\n");
    const auto candidates = [&](const std::string& keys, const std::string& engine) {
        const std::string config =
            folder.write("c.toml",
                         "name = \"c\"\n[[external]]\nname = \"mine\"\ncommand = [\"./mine\"]\n[[scene]]\nkind = "
                         "\"pile\"\nobjects = 150\nframes = 20\n" +
                             keys + "[measure]\nrepeats = 2\n");
        std::filesystem::remove_all(folder / "out");
        const program_result ran = run_program({"run", config, "--out", folder / "out"});
        INFO(ran.err << ran.out);
        REQUIRE(ran.status == 0);
        std::set<std::string> numbers;
        for (const auto& row : csv_rows(folder / "out" / "results.csv")) {
            CHECK(row.at("status") == "exact");
            if (row.at("engine") == engine) numbers.insert(row.at("candidates"));
        }
        REQUIRE(numbers.size() == 1);
        return std::stoi(*numbers.begin());
    };
    const std::string filter = "groups = \"rest.csv\"\nexcept = \"except.csv\"\n";
    const int kept = candidates(filter, "mine");
    CHECK(kept == candidates(filter, ""));
    CHECK(kept > 0);
    CHECK(candidates("", "mine") > 2 * kept);
}

TEST_CASE_METHOD(with_mesh_file, "contacts leaves out what the files say") {
    std::string motion;
    for (int object = 0; object < 4; ++object)
        motion += "0 " + std::to_string(object) + " 1 0 0 " + std::to_string(0.1 * object) + " 0 1 0 0  0 0 1 0\n";
    const std::string file = folder.write("m.txt", motion);
    const std::string out = folder / "contacts.csv";
    const auto objects = [&](const std::vector<std::string>& options) {
        const auto summary = json_of(joined({"contacts", file, mesh, "--json", "--out", out}, options));
        std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (const std::vector<std::uint32_t>& row : numbers_of(bytes_of_file(out))) pairs.emplace(row[1], row[2]);
        CHECK(summary["object_pairs"] == pairs.size());
        CHECK(summary["candidates"] >= pairs.size());  // with split_mesh of parts
        return pairs;
    };
    using pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;
    CHECK(objects({}).size() == 6);
    const std::string sets = folder.write("sets.csv", "object,set\n0,a\n1,b\n2,b\n3,a\n");
    const std::string except = folder.write("except.csv", "a,b\n2,0\n");
    for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
             {}, {"--engine", "cgal"}, {"--prepare", "split_mesh:size=0.1"}, {"--tree", "compressed"}}) {
        CAPTURE(method);
        CHECK(objects(joined(method, {"--groups", sets})) == pairs{{0, 1}, {0, 2}, {1, 3}, {2, 3}});
        CHECK(objects(joined(method, {"--groups", sets, "--except", except})) == pairs{{0, 1}, {1, 3}, {2, 3}});
    }
    CHECK(holds(run_well({"contacts", file, mesh, "--except", except}).out, ", filtered by " + except));
}

TEST_CASE_METHOD(in_folder, "run, recommend and explain leave out what the files say") {
    std::string groups = "object,set,rest\n";
    for (int id = 0; id < 150; ++id)
        groups += std::to_string(id) + (id % 2 == 0 ? ",a," : ",b,") + (id % 8 < 6 ? "1\n" : "0\n");
    folder.write("groups.csv", groups);
    folder.write("except.csv", "a,b\n6,7\n6,1\n");
    const std::string scene = "[[scene]]\nkind = \"brownian\"\nobjects = 150\nframes = 3\ndensity = 0.5\n";
    const auto config = [&](const std::string& keys) {
        return folder.write("c.toml", "name = \"c\"\nengines = [\"brute_force\", \"cgal\"]\n" + scene + keys +
                                          "[compose]\nsort = [\"std\", \"insertion\"]\nprepare = [\"none\", "
                                          "\"neighbour_list\"]\n[measure]\nrepeats = 2\n");
    };
    const auto candidates = [&](const std::string& keys) {
        std::filesystem::remove_all(folder / "out");
        const program_result ran = run_program({"run", config(keys).string(), "--out", folder / "out"});
        INFO(ran.err << ran.out);
        REQUIRE(ran.status == 0);
        std::set<std::string> numbers, statuses;
        for (const auto& row : csv_rows(folder / "out" / "results.csv")) {
            numbers.insert(row.at("candidates"));
            statuses.insert(row.at("status"));
        }
        CHECK(statuses == std::set<std::string>{"exact"});
        REQUIRE(numbers.size() == 1);
        return std::stoi(*numbers.begin());
    };
    const int unfiltered = candidates("");
    const int by_groups = candidates("groups = \"groups.csv\"\n");
    const int by_both = candidates("groups = \"groups.csv\"\nexcept = \"except.csv\"\n");
    CHECK(by_both > 0);
    CHECK(by_groups >= by_both);
    CHECK(unfiltered > 3 * by_groups);
    CHECK(holds(bytes_of_file(folder / "out" / "results.csv"), "groups.csv"));

    // A changed file is another experiment.
    run_well({"run", config("except = \"except.csv\"\n").string(), "--out", folder / "two"});
    run_well({"run", config("except = \"except.csv\"\n").string(), "--out", folder / "two", "--resume"});
    folder.write("except.csv", "a,b\n6,7\n6,2\n");
    run_refused({"run", config("except = \"except.csv\"\n").string(), "--out", folder / "two", "--resume"});

    folder.write("bad.csv", "object,set\n150,a\n");
    CHECK(holds(run_refused({"run", config("groups = \"bad.csv\"\n").string()}).err, "bad.csv:2: object is '150'"));
    CHECK(holds(run_refused({"run", config("groups = \"none.csv\"\n").string()}).err, "none.csv"));

    const std::string recording = folder / "r.aabbs";
    run_well({"scene", "brownian", "--n", "150", "--frames", "3", "--density", "0.5", "--out", recording});
    const std::string file = folder / "groups.csv";
    CHECK(holds(run_refused({"explain", config("").string(), "--groups", file}).err,
                "--groups and --except are for a scene; a config has the keys groups and except"));
    CHECK(holds(run_refused({"recommend", recording, "--groups", file, "--report", file}).err, "would overwrite"));
}

TEST_CASE_METHOD(in_folder, "recommend and explain say what the filter keeps, and how it is applied") {
    // A pile of 60 boxes, of which a tenth is one set.
    std::string boxes, sets = "object,set\n", rest = "object,rest\n";
    for (int frame = 0; frame < 8; ++frame)
        for (int id = 0; id < 60; ++id) boxes += boxes_row(frame, id, 0.01 * id + 0.001 * frame, 0);
    for (int id = 0; id < 60; ++id) {
        sets += std::to_string(id) + (id % 10 == 0 ? ",a\n" : ",b\n");
        rest += std::to_string(id) + (id % 10 == 0 ? ",0\n" : ",1\n");
    }
    const std::string scene = folder.write("boxes.csv", boxes);
    const std::string of_sets = folder.write("sets.csv", sets), of_rest = folder.write("rest.csv", rest);
    const auto explained = [&](const std::vector<std::string>& options) {
        return run_well(joined({"explain", scene, "--seconds", "5"}, options)).out;
    };
    const std::string by_sets = explained({"--groups", of_sets});
    CHECK(holds(by_sets, "groups=" + of_sets));
    CHECK(holds(by_sets, "keeps 18.3 % of the overlapping pairs"));  // 6 * 54 of 60 * 59 / 2
    CHECK(holds(by_sets, "29.5 overlapping pairs per object"));
    CHECK(holds(by_sets, "sets a and b are joined: 6 boxes are looked up in an index of 54"));
    const std::string by_rest = explained({"--groups", of_rest});
    CHECK(holds(by_rest, "keeps 19.2 % of the overlapping pairs"));  // and 6 * 5 / 2
    CHECK(holds(by_rest, "objects at rest "));
    const std::string by_none = explained({});
    CHECK(holds(by_none, "29.5 overlapping pairs per object"));
    CHECK_FALSE(holds(by_none, "of the overlapping pairs"));
    const std::string except = folder.write("except.csv", "a,b\n0,1\n");
    CHECK(holds(explained({"--except", except}), "the filter kept 1769 of 1770 pairs that the search found"));

    // A filter and a Verlet list have their memory in one line.
    const std::string with_list = run_well({"explain",
                                            folder.write("c.toml",
                                                         "name = \"c\"\n[[scene]]\nkind = \"recording\"\nfile = "
                                                         "\"boxes.csv\"\ngroups = \"rest.csv\"\n[compose]\nprepare "
                                                         "= \"neighbour_list\"\n"),
                                            "--seconds", "2"})
                                      .out;
    const auto count = [&with_list](const std::string& line) {
        int lines = 0;
        for (std::size_t at = 0; (at = with_list.find("\n" + line, at)) != std::string::npos; ++at) ++lines;
        return lines;
    };
    CHECK(holds(with_list, "neighbour_list"));
    CHECK(count("      prepare ") == count("    broad phase: "));

    const std::string page = folder / "page.html";
    const std::string advice =
        run_well({"recommend", scene, "--groups", of_sets, "--seconds", "5", "--report", page}).out;
    CHECK(holds(advice, "groups=" + of_sets));
    CHECK(holds(bytes_of_file(page), "keeps 18.3 % of the overlapping pairs"));
}
