// External programs that take part in an experiment through the pairs and times that they write.
#include <catch2/generators/catch_generators.hpp>
#include <csignal>

#include "configs.hpp"

namespace {

/// Finds the exact pairs and invents its times.
const std::string good = R"(#!/bin/sh
')" AABBLAB_UNDER_TEST R"(' pairs "$1" --engine brute_force --out "$2" >/dev/null || exit
{ echo frame,update_ms,search_ms; for frame in 0 1 2 3; do echo $frame,0.5,1.25; done; } >"$3"
)";

/// Starts an orphan in another session and process group, and writes its process id to a file.
const std::string stray =
    "(setsid sh -c 'echo $$ >stray.part; mv stray.part stray; exec sleep 1000' &)\n"
    "until [ -e stray ]; do sleep 0.01; done\n";

const std::string pairs = "the pairs of the external engine 'mine'";
const std::string no_time = ": expected a time in milliseconds, finite and not negative";
const std::string timing = "the times of the external engine 'mine'";

std::string config_of(const std::string& kind, const std::string& more) {
    return "name = \"joined\"\n[[external]]\nname = \"mine\"\ncommand = [\"./mine\"]\n" + more +
           "[[scene]]\nkind = \"" + kind + "\"\nobjects = 150\nframes = 3\n[measure]\nrepeats = 2\n";
}

/// Runs an experiment with the external engine `mine`, a script beside the config.
program_result run_with(const temporary_folder& folder, const std::string& script, const std::string& kind = "brownian",
                        const std::string& more = {}) {
    std::filesystem::permissions(folder.write("mine", script), std::filesystem::perms::owner_all);
    std::filesystem::remove_all(folder / "out");
    return run_program({"run", folder.write("joined.toml", config_of(kind, more)).string(), "--out", folder / "out"});
}

/// The smallest valid table of an external engine.
const std::string listed = "[[external]]\nname = \"a\"\ncommand = \"ls\"\n";

/// Whether a process is gone or a zombie.
bool has_ended(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(in, text);
    const std::size_t name_end = text.rfind(')');
    return name_end == std::string::npos || text[name_end + 2] == 'Z';
}

}  // namespace

TEST_CASE_METHOD(in_folder, "An external engine is compared with the ground truth and has its reported times") {
    const std::string kind = GENERATE("brownian", "population", "lattice", "mixed_sizes");
    CAPTURE(kind);
    const program_result result = run_with(folder, good, kind);
    INFO(result.err << result.out);
    REQUIRE(result.status == 0);
    REQUIRE(holds(result.out, "  mine  "));
    const std::vector<aabblab::row> rows = aabblab::verified_rows(folder / "out");
    REQUIRE(rows.size() == 4);
    for (const aabblab::row& r : rows) {
        CHECK(r.digest == rows[0].digest);
        CHECK(r.status == "exact");
        CHECK(r.bytes.back().has_value() == r.name.engine.empty());
        if (r.name.engine.empty()) continue;
        CHECK(r.name.engine == "mine");
        CHECK(r.first_ms == 1.75);
        CHECK(r.update_ms == 1.5);
        CHECK(r.search_ms == 3.75);
        CHECK_FALSE(r.update_cpu_ms.has_value());
    }
    // No exchanged file remains.
    CHECK(std::ranges::none_of(std::filesystem::directory_iterator(folder.path()), [](const auto& entry) {
        return entry.path().string().ends_with(".aabbs") || entry.path().string().ends_with(".pairs.csv");
    }));
    run_well({"compare", folder / "out", folder / "out"});
    run_well({"validate", folder / "joined.toml"});
    CHECK(holds(run_program({"explain", folder / "joined.toml"}).out, "  mine\n"));
}

TEST_CASE_METHOD(in_folder, "A wrong result of an external engine is a failure, or counted if declared inexact") {
    const auto [fault, message] = GENERATE(table<std::string, std::string>({
        {"sed -i 2d \"$2\"\n", " is a false negative\n"},
        {"sed -i '2s/.*/0,0,1/' \"$2\"\n", "the pair 0 1 is a false positive\n"},
        {"sed -i 1q \"$2\"\n", " is a false negative\n"},
    }));
    const program_result result = run_with(folder, good + fault);
    INFO(result.err << result.out);
    REQUIRE(result.status == 1);
    REQUIRE(result.err.starts_with("aabblab: mine has a wrong result on brownian ("));
    REQUIRE(holds(result.err, message));
    REQUIRE(aabblab::read_rows(folder / "out/results.csv").size() == 2);
    const program_result counted = run_with(folder, good + fault, "brownian", "exact = false\n");
    INFO(counted.err << counted.out);
    REQUIRE(counted.status == 0);
    for (const aabblab::row& r : aabblab::verified_rows(folder / "out")) {
        CHECK((r.status == "exact") == r.name.engine.empty());
        CHECK((r.false_negatives.value() + r.false_positives.value() > 0) == !r.name.engine.empty());
    }
}

TEST_CASE_METHOD(in_folder, "run says what check says of the wrong list of an external engine, and how to reduce it") {
    const auto [exactness, processes] = GENERATE(table<std::string, std::string>({
        {"", ""},
        {"exact = false\n", ""},
        {"", "processes = 2\n"},
    }));
    CAPTURE(exactness, processes);
    const std::string fault = good + "sed -i 2d \"$2\"\n";
    std::filesystem::permissions(folder.write("mine", fault), std::filesystem::perms::owner_all);
    const std::string config = folder.write("joined.toml", config_of("brownian", exactness) + processes);
    const program_result result = run_program({"run", config, "--out", folder / "out"});
    INFO(result.err);
    REQUIRE(result.status == (exactness.empty() ? 1 : 0));
    CHECK(holds(result.err, "aabblab: mine on brownian (objects=150 frames=3 seed=1): "));
    CHECK(holds(result.err, ", 1 false negative and 0 false positives: "));
    CHECK(holds(result.err, " is a false negative ("));
    const std::string kept = folder / "out/wrong_lists/mine_brownian_0.csv";
    CHECK(bytes_of_file(kept).starts_with("frame,a,b\n"));
    CHECK(holds(result.err, "mine: this list is " + kept + "; to check it again and find the smallest scene: "));

    // The line does what it says.
    const std::string before = "the smallest scene: ";
    std::string line = result.err.substr(result.err.find(before) + before.size());
    line.resize(line.find('\n'));
    std::filesystem::create_symlink(AABBLAB_UNDER_TEST, folder / "aabblab");
    const std::string here = folder.path().string();
    const program_result repeated = run_command({"sh", "-c", "cd '" + here + "'; PATH=.:$PATH; " + line});
    INFO(repeated.out << repeated.err);
    CHECK(repeated.status == 1);
    CHECK(holds(repeated.out, "2 objects in 1 frame"));
}

TEST_CASE_METHOD(in_folder, "Rows that no scene has, and repeated ones, make the list of an external engine wrong") {
    const auto [fault, rows, said] = GENERATE(table<std::string, std::string, std::string>({
        {"echo 3,-1,2 >>\"$2\"\n", "1 row of its list cannot be a pair of the scene, or repeats one", "1 unknown id"},
        {"echo 3,1,150 >>\"$2\"\n", "1 row of its list cannot be a pair of the scene, or repeats one", "1 unknown id"},
        {"echo 4,1,2 >>\"$2\"\n", "1 row of its list cannot be a pair of the scene, or repeats one", "1 unknown frame"},
        {"echo 3,7,7 >>\"$2\"\n", "1 row of its list cannot be a pair of the scene, or repeats one", "1 self pair"},
        {"tail -n 1 \"$2\" | { IFS=, read f a b; echo $f,$b,$a >>\"$2\"; }\n",
         "1 row of its list cannot be a pair of the scene, or repeats one", "1 duplicate"},
        {"echo 3,7,7 >>\"$2\"; echo 4,1,2 >>\"$2\"\n", "2 rows of its list cannot be pairs of the scene, or repeat one",
         "1 self pair, 1 unknown frame"},
    }));
    CAPTURE(fault);
    for (const char* exactness : {"", "exact = false\n"}) {
        const program_result result = run_with(folder, good + fault, "brownian", exactness);
        INFO(result.err);
        REQUIRE(result.status == 1);
        CHECK(holds(result.err, "mine has a wrong result on brownian (objects=150 frames=3 seed=1): " + rows + "\n"));
        CHECK(holds(result.err, said));
        // The other candidate has its rows.
        CHECK(aabblab::read_rows(folder / "out/results.csv").size() == 2);
    }
    // Ids from 1 are recognised.
    const program_result from_one =
        run_with(folder, good +
                             "awk -F, 'NR > 1 { print $1 \",\" $2 + 1 \",\" $3 + 1; next } 1' \"$2\" >\"$2.new\"\n"
                             "mv \"$2.new\" \"$2\"\n");
    INFO(from_one.err);
    CHECK(from_one.status == 1);
    CHECK(holds(from_one.err, "Ids are off by one: with 1 taken from each, the list is right."));
}

TEST_CASE_METHOD(in_folder, "run says nothing of lists that are right, and leaves out what a filter does") {
    std::filesystem::permissions(folder.write("mine", good), std::filesystem::perms::owner_all);
    folder.write("groups.csv", "object,rest\n0,1\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n7,1\n8,1\n9,1\n");
    const std::string scene = "groups = \"groups.csv\"\n[measure]";
    std::string filtered = config_of("brownian", "");
    filtered.replace(filtered.find("[measure]"), 9, scene);
    for (const std::string& config : {config_of("brownian", ""), filtered}) {
        std::filesystem::remove_all(folder / "out");
        const program_result result = run_well({"run", folder.write("joined.toml", config), "--out", folder / "out"});
        CHECK_FALSE(holds(result.err, "false negative"));
        CHECK_FALSE(std::filesystem::exists(folder / "out/wrong_lists"));
    }
    // Only the pair that is lost is wrong, not those that the filter leaves out.
    std::filesystem::permissions(folder.write("mine", good + "sed -i '$d' \"$2\"\n"),
                                 std::filesystem::perms::owner_all);
    std::filesystem::remove_all(folder / "out");
    const program_result wrong = run_program({"run", folder.write("joined.toml", filtered), "--out", folder / "out"});
    CHECK(holds(wrong.err, ", 1 false negative and 0 false positives: "));
}

TEST_CASE_METHOD(in_folder, "Malformed output of an external engine gets one sentence and status 2") {
    const auto [fault, message] = GENERATE(table<std::string, std::string>({
        {"exit 3\n", "the external engine 'mine' ended with status 3"},
        {"kill -9 $$\n", "the external engine 'mine' was terminated by signal 9"},
        {"rm \"$2\"\n", pairs + " are missing: the engine did not write the file"},
        {"rm \"$3\"\n", timing + " are missing: the engine did not write the file"},
        {": >\"$2\"\n", pairs + " are an empty file; expected the line frame,a,b"},
        {"sed -i 1d \"$3\"\n", timing + ", line 1, '0,0.5,1.25': expected the line frame,update_ms,search_ms"},
        {"rm \"$2\"; mkdir \"$2\"\n", pairs + " are a folder; expected a file"},
        {"sed -i '2s/.*/0,1,2,7/' \"$2\"\n", pairs + ", line 2, '0,1,2,7': expected frame,a,b"},
        {"sed -i \"2s/.*/$(printf %070d 7)/\" \"$2\"\n",
         pairs + ", line 2, '" + std::string(60, '0') + "…': expected frame,a,b"},
        {"sed -i '2s/.*/0\\x00,4/' \"$2\"\n", pairs + ": is not text: a NUL byte in line 2, with more text after it"},
        {"sed -i '2s/.*/0,4/' \"$2\"\n", pairs + ", line 2, '0,4': expected frame,a,b"},
        {"sed -i '2s/.*//' \"$2\"\n", pairs + ", line 2, '': expected frame,a,b"},
        {"sed -i '2s/.*/0,1,x/' \"$2\"\n", pairs + ", line 2, '0,1,x': expected an object below 150"},
        {"echo 0,1,2 >>\"$2\"\n",
         ", '0,1,2': this row of frame 0 follows one of frame 3; expected rows sorted by frame, from 0 on, in "
         "any order within a frame"},
        {"sed -i '$d' \"$3\"\n", timing + " end before frame 3"},
        {"sed -i '3s/.*/2,1,1/' \"$3\"\n",
         timing + ", line 3, '2,1,1': expected frame 1; each frame has one row, in order"},
        {"sed -i '3s/.*/1,-1,1/' \"$3\"\n", timing + ", line 3, \'1,-1,1\'" + no_time},
        {"sed -i '3s/.*/1,nan,1/' \"$3\"\n", timing + ", line 3, \'1,nan,1\'" + no_time},
        {"sed -i '3s/.*/1,1,2ms/' \"$3\"\n", timing + ", line 3, \'1,1,2ms\'" + no_time},
        {"sed -i '3s/.*/1,0,0/' \"$3\"\n", timing + ", line 3, '1,0,0': expected a sum of the two times above 0 ms"},
        {"echo 4,1,1 >>\"$3\"\n", timing + ", line 6, '4,1,1': expected a frame below 4"},
    }));
    CAPTURE(fault);
    const program_result result = as_refused(run_with(folder, good + fault));
    CAPTURE(result.err);
    REQUIRE(result.err.starts_with("aabblab: " + (folder / "joined.toml").string() +
                                   ":4: brownian (objects=150 frames=3 seed=1): "));
    REQUIRE(holds(result.err, message + "\n"));
}

TEST_CASE_METHOD(in_folder, "An external engine may report its time in either column") {
    const std::string columns = GENERATE("0,1.25", "0.5,0");
    CAPTURE(columns);
    REQUIRE(run_with(folder, good + "sed -i '2,$s/0.5,1.25/" + columns + "/' \"$3\"\n").status == 0);
}

TEST_CASE_METHOD(in_folder, "An interrupted run leaves no external engine and no exchanged files") {
    const auto [ended_by, processes] = GENERATE(table<int, std::string>({
        {SIGTERM, "1"},
        {SIGINT, "1"},
        {SIGKILL, "1"},
        {SIGTERM, "2"},
    }));
    CAPTURE(ended_by, processes);
    const auto exchange_folder = folder / "tmp";
    std::filesystem::create_directory(exchange_folder);
    // Processes that it started must end too, even in another session.
    std::filesystem::permissions(
        folder.write("mine", "#!/bin/sh\nsleep 1000 &\nof=$!\ncd \"${0%/*}\"\n" + stray +
                                 "echo $$ $of $(cat stray) >began.part\nmv began.part began\nwait\n"),
        std::filesystem::perms::owner_all);
    const auto config = folder.write("joined.toml", config_of("brownian", "") + "processes = " + processes + "\n");
    const pid_t program =
        started({"sh", "-c", "exec \"$0\" \"$@\" >/dev/null 2>&1", "env", "TMPDIR=" + exchange_folder.string(),
                 AABBLAB_UNDER_TEST, "run", config.string(), "--out", (folder / "out").string()});
    const bool began = comes_true([&] { return std::filesystem::exists(folder / "began"); });
    const bool was_used = !std::filesystem::is_empty(exchange_folder);
    kill(program, ended_by);
    waitpid(program, nullptr, 0);
    REQUIRE(began);
    REQUIRE(was_used);
    pid_t engine = 0, child = 0, orphan = 0;
    std::ifstream(folder / "began") >> engine >> child >> orphan;
    REQUIRE(orphan > 0);
    for (const pid_t process : {engine, child, orphan}) CHECK(comes_true([&] { return has_ended(process); }));
    CHECK(comes_true([&] { return std::filesystem::is_empty(exchange_folder); }));
}

TEST_CASE_METHOD(in_folder, "Processes left by an external engine are killed when it ends, in any session") {
    const std::string ending = GENERATE("", "exit 3\n", "kill -9 $$\n");
    CAPTURE(ending);
    const program_result result = run_with(folder, good + "cd \"${0%/*}\"\n" + stray + ending);
    INFO(result.err);
    CHECK(result.status == (ending.empty() ? 0 : 2));
    pid_t orphan = 0;
    std::ifstream(folder / "stray") >> orphan;
    REQUIRE(orphan > 0);
    CHECK(has_ended(orphan));
}

TEST_CASE("An external engine that kills its process group fails, and an ignored SIGCHLD is harmless") {
    const temporary_folder folder;
    CHECK(holds(as_refused(run_with(folder, good + "kill 0\nsleep 1000\n")).err, "terminated by signal 15"));
    REQUIRE(run_with(folder, good, "brownian", "timeout_s = 20\n").status == 0);
    const program_result ignored = run_command(
        {"env", "--ignore-signal=CHLD", AABBLAB_UNDER_TEST, "run", folder / "joined.toml", "--out", folder / "again"});
    INFO(ignored.err);
    CHECK(ignored.status == 0);
}

TEST_CASE("An external engine that hangs is killed with its children, and other candidates still run") {
    const temporary_folder folder;
    const auto [hang, rows_of_engine] = GENERATE(table<std::string, std::size_t>({
        {"sleep 1000 & cd \"${0%/*}\"; echo $! >began; wait\n", 0},
        // A program that has closed its output is not waited for either.
        {"exec >&-; sleep 1000 & cd \"${0%/*}\"; echo $! >began; wait\n", 0},
        // Only the second repeat hangs.
        {"cd \"${0%/*}\"; echo >>calls; [ $(wc -l <calls) -lt 3 ] || { sleep 1000 & echo $! >began; wait; }\n", 1},
    }));
    CAPTURE(hang);
    const program_result result = run_with(folder, good + hang, "brownian", "timeout_s = 1\n");
    CAPTURE(result.err, result.out);
    REQUIRE(result.status == 1);
    CHECK(holds(result.err,
                ":4: brownian (objects=150 frames=3 seed=1): the external engine 'mine' was killed: it was "
                "still running after 1 s, its timeout_s\n"));
    const std::vector<aabblab::row> rows = aabblab::read_rows(folder / "out/results.csv");
    CHECK(std::ranges::count_if(rows, [](const auto& r) { return r.name.engine.empty(); }) == 2);
    CHECK(static_cast<std::size_t>(
              std::ranges::count_if(rows, [](const auto& r) { return r.name.engine == "mine"; })) == rows_of_engine);
    pid_t child = 0;
    std::ifstream(folder / "began") >> child;
    REQUIRE(child > 0);
    CHECK(comes_true([&] { return has_ended(child); }));
}

TEST_CASE_METHOD(in_folder, "An external engine that cannot be started gets one sentence and status 2") {
    folder.write("mine", good);  // not executable
    const auto config = folder.write("joined.toml", config_of("brownian", ""));
    const program_result rejected = run_refused({"run", config, "--out", folder / "out"});
    REQUIRE(rejected.err.starts_with("aabblab: " + config.string() + ":4: brownian ("));
    REQUIRE(holds(rejected.err, "mine cannot be started: Permission denied\n"));
    const auto bare = folder.write("bare.toml",
                                   "name = \"joined\"\n[[external]]\nname = \"mine\"\ncommand = \"no_such_program\"\n"
                                   "[[scene]]\nkind = \"brownian\"\nobjects = 5\n");
    REQUIRE(holds(run_refused({"run", bare.string(), "--out", folder / "bare"}).err,
                  "the external engine 'mine': there is no program no_such_program in PATH; write "
                  "./no_such_program for one in the folder of the config\n"));
}

TEST_CASE_METHOD(in_folder, "An external engine skips scenes of meshes") {
    std::filesystem::permissions(folder.write("mine", good), std::filesystem::perms::owner_all);
    const auto config =
        folder.write("meshes.toml",
                     "name = \"joined\"\n[[external]]\nname = \"mine\"\ncommand = \"./mine\"\n[[scene]]\n"
                     "kind = \"mesh_swarm\"\nmeshes = [\"icosphere:triangles=20\"]\nobjects = 5\n"
                     "frames = 1\n[measure]\nrepeats = 1\n");
    REQUIRE(run_well({"run", config, "--out", folder / "out"}).err ==
            "aabblab: mine does not run on mesh_swarm: it takes only boxes\n");
}

TEST_CASE("External engines in a config are checked and part of its hash") {
    const std::string scene = "[[scene]]\nkind = \"brownian\"\nobjects = 10\n";
    const auto with = [&](const std::string& external) { return "name = \"x\"\n" + external + scene; };
    const auto [external, message] = GENERATE(table<std::string, std::string>({
        {"[external]\nname = \"a\"\ncommand = \"ls\"\n", ":2: external must be in double brackets: [[external]]"},
        {"[[external]]\ncommand = \"ls\"\n", ":2: this [[external]] has no name; expected name = \"…\""},
        {"[[external]]\nname = \"a/b\"\ncommand = \"ls\"\n",
         ":3: the name 'a/b' must consist of letters, digits, - and _"},
        {"[[external]]\nname = \"cgal\"\ncommand = \"ls\"\n",
         ":3: there is an engine 'cgal' already; give this one another name"},
        {"[[external]]\nname = \"a\"\n", ":2: 'a' has no command; expected command = [\"…\"]"},
        {"[[external]]\nname = \"a\"\ncommand = []\n", ":4: the command of 'a' is empty; expected a program"},
        {"[[external]]\nname = \"a\"\ncommand = \"\"\n", ":4: the command of 'a' is empty; expected a program"},
        {"[[external]]\nname = \"a\"\ncommand = \"./no/such\"\n", ":4: ./no/such: no such file"},
        {"[[external]]\nname = \"a\"\ncommand = \"/usr/\"\n", ":4: /usr/ is a folder; expected a program"},
        {listed + "exact = 1\n", ":5: exact is a number; expected true or false"},
        {listed + "timeout_s = 0\n", ":5: timeout_s must be a whole number, at least 1, not 0"},
        {listed + "timeout_s = 1000001\n", ":5: timeout_s must be at most 1000000"},
        {"[[external]]\nname = \"a\"\ncomand = \"ls\"\n", "did you mean 'command'?"},
        {listed + listed, ":5: two [[external]] have the name 'a'"},
        {"[[external]]\nname = \"a\"\ncommand = [\"ls\", \"-l\"]\n", "accepted"},
    }));
    CAPTURE(external);
    REQUIRE(holds(rejection_of(with(external)), message));
    const auto hash = [&](const std::string& text) {
        return aabblab::hash_of(aabblab::parse_experiment(with(text), "x.toml", aabblab::experiment_size::full));
    };
    REQUIRE(hash(listed) != hash(""));
    REQUIRE(hash(listed) != hash("[[external]]\nname = \"a\"\ncommand = [\"ls\", \"-l\"]\n"));
    REQUIRE(hash(listed) != hash(listed + "exact = false\n"));
}
