#include "interrupted.hpp"

#include "configs.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

/// A mesh name with every special character of CSV.
const std::string mesh_name = "two\nlines, \"one\"\rname.off";

std::string config_of(const std::string& mesh) {
    std::string name;
    for (const char c : mesh) name += c == '\n' ? "\\n" : c == '\r' ? "\\r" : c == '"' ? "\\\"" : std::string(1, c);
    return "name = \"odd\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = [\"" + name +
           "\", \"icosphere:triangles=20\"]\nframes = 2\n[measure]\nrepeats = 3\n";
}

/// A small experiment and a folder for its results.
struct small_run : in_folder {
    std::string config = folder.write("a.toml", "name = \"a\"\n[[scene]]\nkind = \"still\"\nobjects = 20\nframes=1\n");
    std::string out = folder / "out";
};

}  // namespace

TEST_CASE_METHOD(small_run, "Two runs cannot write to one folder at the same time") {
    auto held = std::make_unique<aabblab::folder_lock>(folder / "out");
    CHECK_THROWS_WITH(aabblab::folder_lock(folder / "out"),
                      StartsWith("another aabblab is writing to ") && EndsWith("with --out"));
    for (const auto& arguments : {std::vector<std::string>{"run", config, "--out", out},
                                  std::vector<std::string>{"reproduce", "--quick", "--out", out}})
        CHECK(holds(run_refused(arguments).err, "another aabblab is writing to " + out));
    CHECK(std::filesystem::is_empty(folder / "out"));
    held.reset();
    run_well({"run", config, "--out", out});
    run_well({"run", config, "--out", out, "--resume"});
}

TEST_CASE_METHOD(small_run, "Duplicate rows of a results.csv are rejected with file and lines") {
    run_well({"run", config, "--out", out});
    const std::string text = bytes_of_file(folder / "out/results.csv");
    const std::size_t second_line = text.find('\n') + 1;
    std::ofstream(folder / "out/results.csv", std::ios::app)
        << text.substr(second_line, text.find('\n', second_line) + 1 - second_line);
    for (const auto& arguments : {std::vector<std::string>{"run", config, "--out", out, "--resume"},
                                  std::vector<std::string>{"compare", out, out}})
        CHECK(holds(run_refused(arguments).err, "/results.csv:11: the measurement of line 2 is repeated here"));
}

TEST_CASE_METHOD(small_run, "Results from before a count existed are read without it, and other columns are rejected") {
    run_well({"run", config, "--out", out});
    const std::string text = bytes_of_file(folder / "out/results.csv");
    // Fields are counted from the end of each line, since those after the counts contain no commas.
    const std::string header = text.substr(0, text.find('\n'));
    const auto columns_after = std::ranges::count(header.substr(header.find(",restarts,") + 10), ',') + 1;
    std::string earlier;
    for (std::string line : lines_of(text)) {
        std::size_t end = line.size();
        for (auto n = columns_after; n > 0; --n) end = line.rfind(',', end - 1);
        earlier += line.erase(line.rfind(',', end - 1), end - line.rfind(',', end - 1)) + "\n";
    }
    const auto restarts = static_cast<std::size_t>(aabb::work::restarts);
    const std::vector<aabblab::row> now = aabblab::read_rows(folder / "out/results.csv");
    const std::vector<aabblab::row> then = aabblab::read_rows(folder.write("earlier.csv", earlier));
    REQUIRE(then.size() == now.size());
    CHECK(now[0].counts[restarts] == 0);
    CHECK(!then[0].counts[restarts]);
    CHECK(then[0].counts[restarts + 1] == now[0].counts[restarts + 1]);
    CHECK(then[0].status == "exact");
    CHECK_THROWS_WITH(aabblab::read_rows(folder.write("others.csv", replaced(earlier, "box_tests", "box_texts"))),
                      ContainsSubstring("others.csv:1: these are not the columns of this version; column ") &&
                          EndsWith(" is 'box_texts'; expected 'box_tests'"));
}

TEST_CASE_METHOD(in_folder, "Results of a mesh with special characters in its name are read, resumed and compared") {
    const std::string mesh =
        folder.write(mesh_name, "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    const std::string config = folder.write("odd.toml", config_of(mesh));
    const std::string out = folder / "out";
    run_well({"run", config, "--out", out});
    const std::filesystem::path table = folder / "out/results.csv";
    const auto complete = aabblab::read_rows(table);
    REQUIRE(complete.size() == 3);
    CHECK(complete[0].scene.meshes == std::vector<std::string>{mesh, "icosphere:triangles=20"});
    run_well({"compare", out, out});
    // The cut is in the mesh name of the last row, which spans two lines.
    const std::string text = bytes_of_file(table);
    std::filesystem::resize_file(table, text.rfind('\n', text.rfind("lines,")) + 3);
    unseal(folder / "out");
    REQUIRE(aabblab::read_rows(table).size() == 2);
    run_well({"run", config, "--out", out, "--resume"});
    const auto resumed = aabblab::read_rows(table);
    REQUIRE(resumed.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(resumed[i].key() == complete[i].key());
    CHECK(resumed[0].search_ms == complete[0].search_ms);
}
