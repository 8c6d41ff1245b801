#include <catch2/catch_test_macros.hpp>
#include <random>
#include <regex>

#include "../experiments/program.hpp"
#include "../experiments/temporary_folder.hpp"

#include "worlds.hpp"

import aabb.std;
import aabblab.archive;
import aabblab.record;

namespace {

/// The results of a run that is finished, as `reproduce` leaves them.
void write_finished_run(const std::filesystem::path& folder, double ratio = 0.6) {
    worlds::write_world(folder, ratio, 0.05);
    // A study of errors and the atlas have results of their own; any experiment does for one.
    std::vector<aabblab::experiment> all = worlds::all_experiments(aabblab::experiment_size::quick);
    aabblab::experiment& any = *std::ranges::find(all, "c10", &aabblab::experiment::name);
    worlds::write_experiment(folder / "errors", any, [](const auto&, auto&) {});
    any.name = "atlas";
    worlds::write_experiment(folder / "atlas", any, [](const auto&, auto&) {});
    std::ofstream(folder / "failures.txt") << "";
    aabblab::seal_record(folder);
}

program_result judge(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& out,
                     const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"reproduce", "--judge", "--out", out.string()};
    for (const std::filesystem::path& source : sources) arguments.push_back(source.string());
    return run_program(joined(arguments, more));
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// The lines of a file as `change` leaves them.
void change_lines(const std::filesystem::path& file, const std::function<void(std::vector<std::string>&)>& change) {
    std::vector<std::string> lines = lines_of(bytes_of_file(file));
    change(lines);
    std::ofstream out(file, std::ios::binary);
    for (const std::string& line : lines) out << line << "\n";
}

void replace_once(std::string& text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("An archive, and results with other ends of lines and another order of rows, give the very report") {
    const temporary_folder folder;
    const std::filesystem::path results = folder / "results";
    write_finished_run(results);
    const program_result judged = judge({results}, folder / "a", {"--archive", (folder / "run.tar.xz").string()});
    INFO(judged.err);
    REQUIRE(judged.status == 0);
    CHECK(judged.err.find("not sealed") == std::string::npos);
    CHECK(std::regex_search(judged.out, std::regex("run\\.tar\\.xz \\([0-9.]+ MiB\\), SHA-256 [0-9a-f]{64}\n")));
    const std::string page = bytes_of_file(folder / "a/report.html");
    REQUIRE(page.find("not sealed") == std::string::npos);
    CHECK(page.find("Atlas of global search") != std::string::npos);
    // Nothing was written beside the results.
    CHECK(!std::filesystem::exists(results / "report.html"));

    const program_result of_archive =
        judge({folder / "run.tar.xz"}, folder / "b", {"--archive", (folder / "again.tar.xz").string()});
    INFO(of_archive.err);
    REQUIRE(of_archive.status == 0);
    CHECK(bytes_of_file(folder / "b/report.html") == page);
    CHECK(bytes_of_file(folder / "b/macros.tex") == bytes_of_file(folder / "a/macros.tex"));
    CHECK(bytes_of_file(folder / "again.tar.xz") == bytes_of_file(folder / "run.tar.xz"));

    const program_result copied = judge({results, folder / "run.tar.xz"}, folder / "both");
    CHECK(copied.status == 2);
    CHECK(copied.err.find("results and " + (folder / "run.tar.xz").string() + " are the same run") !=
          std::string::npos);
    write_finished_run(folder / "other", 0.7);
    REQUIRE(judge({folder / "other", folder / "run.tar.xz"}, folder / "both").status == 0);
    CHECK(bytes_of_file(folder / "both/report.md").find("run.tar.xz together (") != std::string::npos);

    std::mt19937 random(1);
    for (const std::filesystem::path& file : aabblab::archived_files(results)) {
        if (file.filename() == "results.csv")
            change_lines(results / file, [&](auto& lines) { std::shuffle(lines.begin() + 1, lines.end(), random); });
        const std::string text = std::regex_replace(bytes_of_file(results / file), std::regex("\n"), "\r\n");
        std::ofstream(results / file, std::ios::binary) << text;
    }
    const program_result mixed = judge({results}, folder / "c");
    INFO(mixed.err);
    REQUIRE(mixed.status == 0);
    CHECK(bytes_of_file(folder / "c/report.html") == page);
}

TEST_CASE("Results that were altered are not judged, and a sentence says which and where") {
    const temporary_folder folder;
    const std::filesystem::path whole = folder / "whole";
    write_finished_run(whole);
    const auto refused = [&](const std::string& sentence,
                             const std::function<void(const std::filesystem::path&)>& alter) {
        const std::filesystem::path altered = folder / "altered";
        std::filesystem::remove_all(altered);
        std::filesystem::copy(whole, altered, std::filesystem::copy_options::recursive);
        alter(altered);
        const program_result r = judge({altered}, folder / "out");
        INFO(sentence);
        INFO(r.err);
        CHECK(r.status == 2);
        CHECK(is_one_sentence(r.err));
        CHECK(r.err.find("altered/" + sentence) != std::string::npos);
        CHECK(!std::filesystem::exists(folder / "out/report.html"));
        // Nor are they compared.
        const program_result compared = run_program({"compare", whole.string(), altered.string()});
        INFO(compared.err);
        CHECK(compared.status == 2);
        CHECK(is_one_sentence(compared.err));
        CHECK(compared.err.find("altered/" + sentence) != std::string::npos);
    };
    const auto of_table = [](const std::function<void(std::vector<std::string>&)>& change) {
        return [=](const std::filesystem::path& results) { change_lines(results / "c3/results.csv", change); };
    };
    const auto of_file = [](const std::string& name, const std::string& what, const std::string& by) {
        return [=](const std::filesystem::path& results) {
            std::string text = bytes_of_file(results / name);
            replace_once(text, what, by);
            std::ofstream(results / name, std::ios::binary) << text;
        };
    };
    const std::string rows = "c3/results.csv was altered after the run: its rows do not have the checksum";
    refused(rows, of_table([](auto& lines) { replace_once(lines[6], "50.000000", "50.000001"); }));
    refused(rows, of_table([](auto& lines) {
                for (std::size_t i = 1; i < lines.size(); ++i) replace_once(lines[i], "50.000000", "25.000000");
            }));
    refused("c3/results.csv:7: the row is exact, but its digest is '0000000000000000'; that of the scene is " +
                std::string(worlds::exact_digest),
            of_table([](auto& lines) { replace_once(lines[6], worlds::exact_digest, "0000000000000000"); }));
    const std::size_t there = lines_of(bytes_of_file(whole / "c3/results.csv")).size() - 1;
    refused("c3/results.csv has " + std::to_string(there - 1) + " rows; when the run was finished it had " +
                std::to_string(there),
            of_table([](auto& lines) { lines.erase(lines.begin() + 6); }));
    refused("c3/manifest.json was altered after the run",
            of_file("c3/manifest.json", worlds::exact_digest, "0000000000000000"));
    refused("c6/process-1.json was altered after the run", of_file("c6/process-1.json", "0.6", "0.5"));
    refused("failures.txt is missing", [](const auto& results) { std::filesystem::remove(results / "failures.txt"); });
    refused("c3/manifest.json is missing", [](const auto& results) { std::filesystem::remove_all(results / "c3"); });
    refused("c3/results.csv is missing",
            [](const auto& results) { std::filesystem::remove(results / "c3/results.csv"); });
    refused("errors/c10/results.csv is missing",
            [](const auto& results) { std::filesystem::remove(results / "errors/c10/results.csv"); });
    refused("c6/process-3.json was added after the run", [](const auto& results) {
        std::filesystem::copy(results / "c6/process-0.json", results / "c6/process-3.json");
    });
    refused("SHA256SUMS:1: expected a checksum", of_file("SHA256SUMS", "  ", " "));
    // What is left of the last.
    CHECK(run_program({"atlas", "--judge", (folder / "altered").string()}).err.find("expected a checksum") !=
          std::string::npos);
    CHECK(run_program({"compare", whole.string(), whole.string()}).status == 0);
}

TEST_CASE("Results that are not finished are judged, and the report says so") {
    const temporary_folder folder;
    const std::filesystem::path results = folder / "results";
    write_finished_run(results);
    aabblab::unseal_record(results);
    std::filesystem::remove_all(results / "c3");
    const program_result r = judge({results}, folder / "out");
    CHECK(r.status == 0);
    CHECK(r.err.find("results: the results are not sealed: the run was not finished") != std::string::npos);
    CHECK(bytes_of_file(folder / "out/report.html").find("Note: the results are not sealed") != std::string::npos);
}

TEST_CASE("What is no archive of a run is refused in one sentence") {
    const temporary_folder folder;
    const std::filesystem::path results = folder / "results";
    worlds::write_tests(results, 1, 1);
    aabblab::seal_record(results);
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& sentence) {
        const program_result r = run_program(joined({"reproduce", "--out", (folder / "out").string()}, arguments));
        INFO(sentence);
        INFO(r.err);
        CHECK(r.status == 2);
        CHECK(is_one_sentence(r.err));
        CHECK(r.err.find(sentence) != std::string::npos);
    };
    const std::string results_name = results.string();
    refused({"--judge", results_name}, "there are no results of a reproduction in " + results_name);
    refused({"--judge", (folder / "none").string()}, "none is not there");
    refused({"--judge", folder.write("page.html", "<!doctype html>").string()},
            "page.html is not an archive of results, which is tar compressed by xz");
    refused({results_name}, "only --judge takes results that are there");
    refused({"--judge", results_name, results_name, "--archive", "x"}, "--archive takes the results of one run");

    write_finished_run(folder / "run");
    const std::string archive = (folder / "run.tar.xz").string();
    REQUIRE(judge({folder / "run"}, folder / "judged", {"--archive", archive}).status == 0);
    const std::string bytes = bytes_of_file(archive);
    refused({"--judge", folder.write("cut.tar.xz", bytes.substr(0, bytes.size() / 2)).string()},
            "cut.tar.xz is damaged or cut off");
    // What is wrong inside is told by the archive's name.
    std::filesystem::remove(folder / "run/c6/process-0.json");
    aabblab::write_archive(folder / "altered.tar.xz", aabblab::record_top, folder / "run",
                           aabblab::archived_files(folder / "run"));
    refused({"--judge", (folder / "altered.tar.xz").string()}, "altered.tar.xz/c6/process-0.json is missing");
    CHECK(std::filesystem::is_empty(folder / "out"));
}
