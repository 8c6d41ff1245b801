#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>

#include "program_json.hpp"

namespace {

/// Runs the program with a standard output whose reader has closed it.
program_result run_unread(const std::vector<std::string>& arguments) {
    int ends[2];
    REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
    close(ends[0]);
    program_result result = run_program(arguments, {}, ends[1]);
    close(ends[1]);
    return result;
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

/// The length of the longest line, in characters, not bytes.
std::size_t widest_line(const std::string& text) {
    std::size_t widest = 0;
    for (const std::string& line : lines_of(text))
        widest = std::max(widest, static_cast<std::size_t>(std::ranges::count_if(
                                      line, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; })));
    return widest;
}

/// The program, its commands and their subcommands, as listed by --help.
std::vector<std::vector<std::string>> every_command(const std::vector<std::string>& from = {}) {
    std::vector<std::vector<std::string>> commands{from};
    const std::string help = run_program(joined(from, {"--help"})).out;
    const std::size_t begin = help.find("\nSubcommands:\n");
    if (begin == std::string::npos) return commands;
    for (const std::string& line : lines_of(help.substr(begin + 2, help.find("\n\n", begin + 2) - begin - 2)))
        if (line.starts_with("  ") && line[2] != ' ')
            for (std::vector<std::string>& command : every_command(joined(from, {words_of(line).front()})))
                commands.push_back(std::move(command));
    return commands;
}

/// The output of a shell command, of both streams, on a terminal of that width.
std::string shown_on_terminal(unsigned short columns, const std::string& command) {
    const winsize size{.ws_row = 50, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
    int terminal = -1, line = -1;
    REQUIRE(openpty(&terminal, &line, nullptr, nullptr, &size) == 0);
    std::string shown;
    std::thread reader([&] {
        char bytes[4096];
        for (ssize_t n = 0; (n = read(terminal, bytes, sizeof bytes)) > 0;)
            shown.append(bytes, static_cast<std::size_t>(n));
    });
    static_cast<void>(run_command({"sh", "-c", command + " 2>&1"}, {}, line));
    close(line);
    reader.join();
    close(terminal);
    std::erase(shown, '\r');
    return shown;
}

}  // namespace

TEST_CASE("The program prints its version and its help") {
    REQUIRE(run_program({"--version"}).out.starts_with("aabblab "));
    const program_result help = run_well({"--help"});
    for (const char* command :
         {"pairs", "collide", "contacts", "classify", "scene", "list", "run", "test", "data", "benchmark"})
        REQUIRE(holds(help.out, std::string("\n  ") + command + " "));
    REQUIRE(holds(run_program({"pairs", "--help"}).out, "--sweep"));
    for (const char* command : {"pairs", "collide", "contacts"})
        REQUIRE(holds(run_program({command, "--help"}).out, "aabblab list shows every strategy"));
}

TEST_CASE("Help and list fit the given width, or 80 characters without a terminal") {
    const std::vector<std::vector<std::string>> commands = every_command();
    REQUIRE(commands.size() > 16);
    for (const std::vector<std::string>& command : commands) {
        CAPTURE(command);
        CHECK(widest_line(run_program(joined(command, {"--help"})).out) <= 80);
    }
    CHECK(widest_line(run_program({"list"}).out) <= 80);
    const std::string sorts = run_program({"list", "sort"}).out;
    const program_result narrow = run_command({"env", "COLUMNS=50", AABBLAB_UNDER_TEST, "list", "sort"});
    CHECK(widest_line(sorts) > 50);
    CHECK(widest_line(narrow.out) <= 50);
    // Descriptions wrap within their own column, without losing words.
    CHECK(holds(narrow.out, "\n" + std::string(25, ' ')));
    CHECK(words_of(narrow.out) == words_of(sorts));
}

TEST_CASE("list and error messages fit the width of the terminal") {
    const std::string program = AABBLAB_UNDER_TEST;
    const std::string sorts = shown_on_terminal(60, program + " list sort");
    CHECK(widest_line(sorts) <= 60);
    CHECK(words_of(sorts) == words_of(run_program({"list", "sort"}).out));
    const std::string rejected = shown_on_terminal(60, program + " pairs s.aabbs --sweep unknown_at_all");
    CHECK(widest_line(rejected) <= 60);
    CHECK(rejected.starts_with("aabblab: unknown sweep 'unknown_at_all'; expected one of"));
    CHECK(holds(rejected, "\n         "));  // after "aabblab: "
}

TEST_CASE("list can be limited to one kind") {
    const program_result sorts = run_well({"list", "sort"});
    CHECK(sorts.out.starts_with("sort\n  insertion "));
    CHECK_FALSE(holds(sorts.out, "partition"));
    CHECK(holds(run_program({"list"}).out, sorts.out));
    const auto full = json_of({"list", "--json"});
    CHECK(json_of({"list", "sort", "--json"}) ==
          nlohmann::json{{"strategies", {{"sort", full["strategies"]["sort"]}}}});
    CHECK(json_of({"list", "engines", "--json"}) ==
          nlohmann::json{{"engines", full["engines"]}, {"engines_left_out", full["engines_left_out"]}});
    for (const auto& [name, content] : full.items()) {
        if (name == "strategies" || name == "engines_left_out") continue;
        INFO(name);
        CHECK(run_program({"list", name}).out.starts_with(name));
        CHECK(json_of({"list", name, "--json"})[name] == content);
    }
}

TEST_CASE("Output that cannot be written is an error, but a closed pipe is not") {
    const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
    REQUIRE(full >= 0);
    as_refused(run_program({"list"}, {}, full));
    close(full);

    const program_result quiet = run_unread({"list", "--json"});
    REQUIRE(quiet.status == 0);
    REQUIRE(quiet.err.empty());
}

TEST_CASE_METHOD(in_folder, "An experiment whose output pipe is closed runs to its end") {
    const std::string config =
        folder.write("c.toml", "name = \"c\"\n[[scene]]\nkind = [\"brownian\", \"still\"]\nobjects = 20\nframes = 1\n" +
                                   std::string("[measure]\nrepeats = 2\n"));
    const program_result unread = run_unread({"run", config, "--out", folder / "r"});
    CHECK(unread.status == 0);
    CHECK(unread.err.empty());
    CHECK(std::ranges::count(bytes_of_file(folder / "r/results.csv"), '\n') == 1 + 2 * 2);
    // The second scene cannot be run, which the exit status must report.
    folder.write("a.off", "OFF\n3 1 0\n0 0 0\n3e300 0 0\n0 3e300 0\n3 0 1 2\n");
    const std::string failing =
        folder.write("f.toml",
                     "name = \"f\"\n[[scene]]\nkind = \"still\"\nobjects = 20\nframes = 1\n[[scene]]\nkind = "
                     "\"mesh_pair\"\nmeshes = [\"" +
                         (folder / "a.off").string() + "\"]\nframes = 2\nnormalise = \"no\"\n");
    CHECK(run_unread({"validate", failing}).status == 2);
    CHECK(run_unread({"run", failing, "--out", folder / "f"}).status == 2);
}

TEST_CASE_METHOD(in_folder, "A closed standard output is rejected before any file is opened") {
    const std::string out = folder / "s.aabbs";
    const program_result rejected =
        as_refused(run_program({"scene", "brownian", "--n", "20", "--frames", "1", "--out", out}, {}, closed_output));
    CHECK(holds(rejected.err, "standard output is closed"));
    CHECK(folder.files() == 0);
}

TEST_CASE("list shows every strategy, engine, scene, shape and metric") {
    const program_result text = run_well({"list"});
    const auto list = json_of({"list", "--json"});
    std::vector<std::string> names;
    for (const char* kind : {"prepare", "sort", "partition", "sweep", "build", "tree", "triangle"}) {
        REQUIRE(list["strategies"][kind].size() >= 1);
        for (const auto& strategy : list["strategies"][kind]) {
            names.push_back(strategy["name"]);
            for (const auto& parameter : strategy["parameters"]) {
                names.push_back(parameter["name"].get<std::string>() + "=" + parameter["default"].get<std::string>());
                REQUIRE_FALSE(parameter["expected"].get<std::string>().empty());
                REQUIRE_FALSE(parameter["help"].get<std::string>().empty());
            }
        }
    }
    for (const char* group : {"engines", "engines_left_out", "scenes", "shapes", "metrics"})
        for (const auto& entry : list[group]) names.push_back(entry["name"]);
    for (const char* expected : {"insertion", "median", "brute_force", "brownian", "icosphere", "frame_ms",
                                 "comparisons", "all_bytes", "missing"})
        REQUIRE(std::ranges::find(names, expected) != names.end());
    names.emplace_back("triangles=5000");  // of a shape
    for (const std::string& name : names) REQUIRE_THAT(text.out, Catch::Matchers::ContainsSubstring(" " + name));
    for (const auto& engine : list["engines_left_out"])
        REQUIRE(holds(text.out, "left out: " + engine["not_found"].get<std::string>() + " was not found"));
}
