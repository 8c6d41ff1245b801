#include <csignal>

#include "interrupted.hpp"

#include "configs.hpp"

#include "../altered_search.hpp"

import aabblab.trials;

using aabblab::existing_results;
using aabblab::results_folder;
using aabblab::row;

namespace {

constexpr const char* config =
    "name = \"shared\"\nseed = [1, 2]\nquick = { seed = 3 }\n[[scene]]\nkind = \"brownian\"\nobjects = 60\nframes = 2\n"
    "[compose]\nsort = [\"std\", \"insertion\"]\n[measure]\nrepeats = 6\nprocesses = 3\nquick = { repeats = 2 }\n";

/// A config in a folder of its own, and its runs, which write to `out`.
struct shared_run : in_folder {
    explicit shared_run(const std::string& text = config) : file(folder.write("shared.toml", text)) {}

    program_result run(const std::vector<std::string>& more = {}) const {
        return run_well(joined({"run", file, "--out", out}, more));
    }
    [[nodiscard]] std::vector<row> read_rows() const { return aabblab::read_rows(out / "results.csv"); }

    std::string file;
    std::filesystem::path out = folder / "out";
};

/// The fields of rows except their times.
std::set<std::string> results_of(const std::filesystem::path& results) {
    std::set<std::string> lines;
    for (const row& r : aabblab::read_rows(results / "results.csv")) {
        std::string text = r.key() + " " + std::to_string(r.process) + " " + r.digest + " " + r.status;
        for (const auto& count : r.counts) text += " " + std::to_string(count.value_or(0));
        lines.insert(text);
    }
    return lines;
}

/// Keeps the first lines of the table and half of the next, as a process that is killed does.
void truncate_table(const std::filesystem::path& results, std::size_t lines) {
    const std::string table = bytes_of_file(results / "results.csv");
    std::size_t at = 0;
    for (std::size_t i = 0; i < lines; ++i) at = table.find('\n', at) + 1;
    std::ofstream(results / "results.csv", std::ios::binary) << table.substr(0, at + 40);
    unseal(results);
}

}  // namespace

TEST_CASE_METHOD(shared_run, "Repeats are divided among processes, of which only the first validates") {
    REQUIRE(holds(run().out, "insertion"));
    const std::vector<row> rows = read_rows();
    REQUIRE(rows.size() == 2 * 2 * 6);
    for (const row& r : rows) {
        CHECK(r.process == r.repeat / 2);
        CHECK(r.digest == std::ranges::find(rows, r.scene, &row::scene)->digest);
        CHECK(r.update_ms.has_value());
        CHECK(r.counts == std::ranges::find_if(rows, [&](const row& other) {
                              return other.name == r.name && other.scene == r.scene;
                          })->counts);
    }
    // Processes run one after another, so that their times are far apart.
    CHECK(std::ranges::is_sorted(rows, {}, &row::process));
}

TEST_CASE_METHOD(shared_run, "A run that is killed and resumed has the rows of an uninterrupted one") {
    run();
    const std::set<std::string> uninterrupted = results_of(out);
    // The cuts are in the first process, between two processes, and in the last.
    for (const std::size_t lines : {1, 4, 9, 13, 24}) {
        CAPTURE(lines);
        truncate_table(out, lines);
        run({"--resume"});
        REQUIRE(results_of(out) == uninterrupted);
    }
}

TEST_CASE("A run that is killed leaves no process behind and can be resumed") {
    const shared_run shared(replaced(config, "objects = 60", "objects = 2000"));
    const pid_t child = started({AABBLAB_UNDER_TEST, "run", shared.file, "--out", shared.out});
    const auto size = [&] {
        std::error_code error;
        const auto bytes = std::filesystem::file_size(shared.out / "results.csv", error);
        return error ? std::uintmax_t{0} : bytes;
    };
    // The header is shorter: some rows are written, and more are to come.
    while (size() < 2000 && waitpid(child, nullptr, WNOHANG) == 0) usleep(1000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    std::uintmax_t before = 0;
    do {
        before = size();
        usleep(300'000);
    } while (size() != before);
    shared.run({"--resume"});
    const std::set<std::string> resumed = results_of(shared.out);
    run_well({"run", shared.file, "--out", shared.folder / "whole"});
    REQUIRE(resumed == results_of(shared.folder / "whole"));
    REQUIRE(resumed.size() == 2 * 2 * 6);
}

TEST_CASE_METHOD(shared_run, "An interrupted repeat is run again for all candidates") {
    run();
    const std::vector<row> before = read_rows();
    // Only one row remains of the second repeat of the first scene.
    truncate_table(out, 4);
    run({"--resume"});
    const std::vector<row> after = read_rows();
    REQUIRE(after.size() == before.size());
    for (std::size_t i = 0; i < 2; ++i) CHECK(after[i].search_ms == before[i].search_ms);
    CHECK(after[2].repeat == 1);
    // Two times are hardly equal to six decimals in both runs.
    CHECK((after[2].search_ms != before[2].search_ms || after[2].build_ms != before[2].build_ms));
}

TEST_CASE_METHOD(shared_run, "A quick run takes the seeds of quick and at most as many processes as repeats") {
    run({"--quick"});
    const std::vector<row> rows = read_rows();
    REQUIRE(rows.size() == 2 * 2);
    for (const row& r : rows) {
        CHECK(r.scene.seed == 3);
        CHECK(r.process == r.repeat);
    }
}

TEST_CASE_METHOD(in_folder, "A candidate that the first process rejects is not timed by later ones") {
    const auto e = aabblab::parse_experiment(config, "shared.toml", aabblab::experiment_size::full);
    results_folder results(folder / "r", record_of(e), existing_results::reject);
    std::vector<aabblab::candidate> candidates = aabblab::candidates_for(e, e.scenes[0]);
    REQUIRE(aabblab::run_scene(e, e.scenes[0], std::span(candidates).first(1), results, 0).empty());
    REQUIRE(aabblab::run_scene(e, e.scenes[0], candidates, results, 1).empty());
    REQUIRE(results.rows().size() == 4);
    for (const row& r : results.rows()) CHECK(r.name == candidates[0].name);
}

TEST_CASE_METHOD(in_folder, "A composition with a wrong result in a later process is reported and loses its rows") {
    const auto e = aabblab::parse_experiment(config, "shared.toml", aabblab::experiment_size::full);
    results_folder results(folder / "r", record_of(e), existing_results::reject);
    std::vector<aabblab::candidate> candidates = aabblab::candidates_for(e, e.scenes[0]);
    REQUIRE(aabblab::run_scene(e, e.scenes[0], candidates, results, 0).empty());
    // The first candidate keeps its name, but loses all pairs.
    candidates[0].make_global = [make = candidates[0].make_global](aabb::instrumentation counted) {
        return std::make_unique<altered_search>(make(counted), [] {}, [](auto& pairs) { pairs.clear(); });
    };
    const auto failures = aabblab::run_scene(e, e.scenes[0], candidates, results, 1);
    REQUIRE(failures.size() == 1);
    CHECK(failures[0].starts_with("std + none + one_axis has a wrong result on brownian"));
    for (const row& r : results.rows()) CHECK(r.name == candidates[1].name);
}

TEST_CASE("More processes than repeats and invalid settings of quick are rejected") {
    const std::string scene = "[[scene]]\nkind = \"still\"\nobjects = 5\nframes = 1\n";
    CHECK(rejection_of("name = \"a\"\n" + scene + "[measure]\nrepeats = 2\nprocesses = 3\n") ==
          "test.toml:8: processes must be at most repeats, which is 2");
    CHECK(rejection_of("name = \"a\"\n" + scene + "[measure]\nprocesses = 0\n").starts_with("test.toml:7: processes "));
    CHECK(holds(rejection_of("name = \"a\"\nquick = { seeds = 1 }\n" + scene), "did you mean 'seed'?"));
    CHECK(rejection_of("name = \"a\"\nquick = 3\n" + scene).starts_with("test.toml:2: quick is a number"));
}
