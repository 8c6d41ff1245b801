#include <regex>

#include "../experiments/program.hpp"

#include "worlds.hpp"

import aabblab.archive;
import aabblab.record;

namespace {

/// The results of a run that is finished, as `reproduce` leaves them.
void write_finished_run(const std::filesystem::path& folder, double ratio = 0.6) {
    worlds::write_world(folder, ratio, 0.05);
    // The study of errors and the atlas have their own results; any experiment can stand for them.
    std::vector<aabblab::experiment> experiments = worlds::all_experiments(aabblab::experiment_size::quick);
    aabblab::experiment& any = *std::ranges::find(experiments, "c10", &aabblab::experiment::name);
    worlds::write_experiment(folder / "errors", any, [](const auto&, auto&) {});
    any.name = "atlas";
    worlds::write_experiment(folder / "atlas", any, [](const auto&, auto&) {});
    // A suite leaves its rows, or, in earlier versions, its report.
    for (const char* suite : {"stiff", "extreme"}) std::filesystem::create_directories(folder / suite);
    std::ofstream(folder / "stiff/plate.csv")
        << "subject,quantity,measured,expected,verdict\na shot,share,0.25,0,FAILS\n";
    std::ofstream(folder / "stiff/plate_points.csv") << "figure,line,x,y\ntunnelled,plain boxes,1,0.25\n";
    std::ofstream(folder / "extreme/report.json")
        << R"({"paragraphs": ["All of it."], "failures": [], "tables": [{"name": "t", "caption": "Few",
               "columns": [{"name": "scene", "is_number": false}], "rows": [["lattice"]]}], "figures": [
               {"name": "f", "caption": "Drawn", "x": {"label": "x", "logarithmic": false, "names": []},
                "y": {"label": "y", "logarithmic": true, "names": []}, "marks": [{"x": 1, "label": "here"}],
                "panels": [], "lines": [{"label": "one", "style": 0, "points": [[1, 2, 2, 2], [2, null, null, null]]}]}]})";
    // Other files in its folder are not part of the record.
    std::ofstream(folder / "extreme/extreme.csv") << "of another version\n";
    std::ofstream(folder / "failures.txt") << "";
    aabblab::seal_record(folder);
}

/// The command that judges these sources.
std::vector<std::string> judge(const std::vector<std::string>& sources, const std::string& out,
                               const std::vector<std::string>& more = {}) {
    return joined(joined({"reproduce", "--judge", "--out", out}, sources), more);
}

/// Applies `change` to the lines of a file.
void change_lines(const std::filesystem::path& file, const std::function<void(std::vector<std::string>&)>& change) {
    std::vector<std::string> lines = lines_of(bytes_of_file(file));
    change(lines);
    std::ofstream out(file, std::ios::binary);
    for (const std::string& line : lines) out << line << "\n";
}

}  // namespace

TEST_CASE("An archive, and results with other line endings and another row order, give the same report") {
    const temporary_folder folder;
    const std::filesystem::path results = folder / "results";
    write_finished_run(results);
    const std::string archive = folder / "run.tar.xz";
    const program_result judged = run_well(judge({results}, folder / "a", {"--archive", archive}));
    CHECK_FALSE(holds(judged.err, "not sealed"));
    CHECK(std::regex_search(judged.out, std::regex("run\\.tar\\.xz \\([0-9.]+ MiB\\), SHA-256 [0-9a-f]{64}\n")));
    const std::string page = bytes_of_file(folder / "a/report.html");
    REQUIRE_FALSE(holds(page, "not sealed"));
    CHECK(holds(page, "Atlas of the broad phase"));
    for (const char* part :
         {"Stiff scenes", "a shot", "Share of shots", "Extreme scenes", "All of it.", "lattice", "Drawn"})
        CHECK(holds(page, part));
    CHECK(holds(bytes_of_file(folder / "a/figures/tunnelled.csv"), ",1,0.25,0.25,0.25,plain boxes\n"));
    // Nothing was written beside the results.
    CHECK(!std::filesystem::exists(results / "report.html"));

    run_well(judge({archive}, folder / "b", {"--archive", folder / "again.tar.xz"}));
    CHECK(bytes_of_file(folder / "b/report.html") == page);
    CHECK(bytes_of_file(folder / "b/macros.tex") == bytes_of_file(folder / "a/macros.tex"));
    CHECK(bytes_of_file(folder / "again.tar.xz") == bytes_of_file(archive));

    CHECK(holds(run_refused(judge({results, archive}, folder / "both")).err, archive + " are the same run"));
    write_finished_run(folder / "other", 0.7);
    run_well(judge({folder / "other", archive}, folder / "both"));
    CHECK(holds(bytes_of_file(folder / "both/report.md"), "run.tar.xz together ("));

    std::mt19937 random(1);
    for (const std::filesystem::path& file : aabblab::archived_files(results)) {
        if (file.filename() == "results.csv")
            change_lines(results / file, [&](auto& lines) { std::shuffle(lines.begin() + 1, lines.end(), random); });
        const std::string text = std::regex_replace(bytes_of_file(results / file), std::regex("\n"), "\r\n");
        std::ofstream(results / file, std::ios::binary) << text;
    }
    run_well(judge({results}, folder / "c"));
    CHECK(bytes_of_file(folder / "c/report.html") == page);
}

TEST_CASE_METHOD(in_folder, "Altered results are rejected in a sentence that names the file") {
    const std::filesystem::path original = folder / "whole";
    write_finished_run(original);
    const auto rejected = [&](const std::string& text, const std::function<void(const std::filesystem::path&)>& alter) {
        const std::filesystem::path altered = folder / "altered";
        std::filesystem::remove_all(altered);
        std::filesystem::copy(original, altered, std::filesystem::copy_options::recursive);
        alter(altered);
        INFO(text);
        CHECK(holds(run_refused(judge({altered}, folder / "out")).err, "altered/" + text));
        CHECK(!std::filesystem::exists(folder / "out/report.html"));
        // Nor are they compared.
        CHECK(holds(run_refused({"compare", original, altered}).err, "altered/" + text));
    };
    const auto of_table = [](const std::function<void(std::vector<std::string>&)>& change) {
        return [=](const std::filesystem::path& results) { change_lines(results / "c3/results.csv", change); };
    };
    const auto of_file = [](const std::string& name, const std::string& what, const std::string& with) {
        return [=](const std::filesystem::path& results) {
            const std::string text = replaced(bytes_of_file(results / name), what, with);
            std::ofstream(results / name, std::ios::binary) << text;
        };
    };
    // Other alterations of a table are tested in tests/experiments/seal.cpp.
    rejected("c3/results.csv was altered after the run: its rows do not have the checksum",
             of_table([](auto& lines) { lines[6] = replaced(lines[6], "50.000000", "50.000001"); }));
    rejected("c3/manifest.json was altered after the run",
             of_file("c3/manifest.json", worlds::exact_digest, "0000000000000000"));
    rejected("c6/process-1.json was altered after the run", of_file("c6/process-1.json", "0.6", "0.5"));
    rejected("stiff/plate.csv was altered after the run", of_file("stiff/plate.csv", "FAILS", "holds"));
    rejected("extreme/report.json was altered after the run", of_file("extreme/report.json", "lattice", "pile"));
    rejected("failures.txt is missing", [](const auto& results) { std::filesystem::remove(results / "failures.txt"); });
    rejected("c3/manifest.json is missing", [](const auto& results) { std::filesystem::remove_all(results / "c3"); });
    rejected("c3/results.csv is missing", [](const auto& run) { std::filesystem::remove(run / "c3/results.csv"); });
    rejected("errors/c10/results.csv is missing",
             [](const auto& results) { std::filesystem::remove(results / "errors/c10/results.csv"); });
    rejected("c6/process-3.json was added after the run", [](const auto& results) {
        std::filesystem::copy(results / "c6/process-0.json", results / "c6/process-3.json");
    });
    rejected("SHA256SUMS:1: expected a checksum", of_file("SHA256SUMS", "  ", " "));
    // The last alteration is still there.
    CHECK(holds(run_program({"atlas", "--judge", folder / "altered"}).err, "expected a checksum"));
    run_well({"compare", original, original});
}

TEST_CASE_METHOD(in_folder, "Unfinished results are judged, and the report says so") {
    const std::filesystem::path results = folder / "results";
    write_finished_run(results);
    aabblab::unseal_record(results);
    std::filesystem::remove_all(results / "c3");
    CHECK(holds(run_well(judge({results}, folder / "out")).err,
                "results: the results are not sealed: the run was not finished"));
    CHECK(holds(bytes_of_file(folder / "out/report.html"), "Note: the results are not sealed"));
}

TEST_CASE_METHOD(in_folder, "Invalid archives of a run are rejected in one sentence") {
    const std::string results = folder / "results";
    worlds::write_tests(results, 1, 1);
    aabblab::seal_record(results);
    const auto rejected = [&](const std::vector<std::string>& arguments, const std::string& sentence) {
        CHECK_THAT(run_refused(joined({"reproduce", "--out", folder / "out"}, arguments)).err,
                   Catch::Matchers::ContainsSubstring(sentence));
    };
    rejected({"--judge", results}, "there are no results of a reproduction in " + results);
    rejected({"--judge", folder / "none"}, "none does not exist");
    rejected({"--judge", folder.write("page.html", "<!doctype html>")},
             "page.html is not an archive of results, which is tar compressed by xz");
    rejected({results}, "only --judge takes existing results");
    rejected({"--judge", results, results, "--archive", "x"}, "--archive takes the results of one run");

    write_finished_run(folder / "run");
    const std::string archive = folder / "run.tar.xz";
    run_well(judge({folder / "run"}, folder / "judged", {"--archive", archive}));
    const std::string bytes = bytes_of_file(archive);
    rejected({"--judge", folder.write("cut.tar.xz", bytes.substr(0, bytes.size() / 2))}, "is damaged or cut off");
    // Errors inside an archive are reported with its name.
    std::filesystem::remove(folder / "run/c6/process-0.json");
    aabblab::write_archive(folder / "altered.tar.xz", aabblab::archive_folder, folder / "run",
                           aabblab::archived_files(folder / "run"));
    rejected({"--judge", folder / "altered.tar.xz"}, "altered.tar.xz/c6/process-0.json is missing");
    CHECK(std::filesystem::is_empty(folder / "out"));
}
