#include <regex>

#include "../experiments/program.hpp"

#include "studies.hpp"
#include "worlds.hpp"

import aabblab.archive;
import aabblab.claims;
import aabblab.errors;
import aabblab.measuring;
import aabblab.record;

namespace {

/// The files of a report's figures and tables, by name.
std::map<std::string, std::string> drawn_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const char* part : {"figures", "tables"})
        for (const auto& file : std::filesystem::directory_iterator(folder / part))
            files[std::string(part) + "/" + file.path().filename().string()] = bytes_of_file(file.path());
    return files;
}

/// The results of a run that is finished, as `reproduce` leaves them.
void write_finished_run(const std::filesystem::path& folder, double ratio = 0.6) {
    worlds::write_world(folder, ratio, 0.05);
    write_studies(folder);
    // The atlas has its own results; any experiment can stand for them.
    std::vector<aabblab::experiment> experiments = worlds::all_experiments(aabblab::experiment_size::quick);
    aabblab::experiment& any = *std::ranges::find(experiments, "c10", &aabblab::experiment::name);
    any.name = "atlas";
    worlds::write_experiment(folder / "atlas", any, [](const auto&, auto&) {});
    // A suite leaves its rows, or, in earlier versions, its report.
    for (const char* suite : {"stiff", "extreme"}) std::filesystem::create_directories(folder / suite);
    std::ofstream(folder / "stiff/plate.csv")
        << "subject,quantity,measured,expected,verdict\na shot,share,0.25,0,FAILS\n";
    std::ofstream(folder / "stiff/plate_points.csv") << "figure,line,x,y\ntunnelled,plain boxes,1,0.25\n";
    std::ofstream(folder / "stiff/gone.csv")
        << "subject,quantity,measured,expected,verdict\nits subject,share,0.125,0,holds\n";
    std::ofstream(folder / "stiff/gone_points.csv") << "figure,line,x,y\n";
    std::ofstream(folder / "extreme/report.json")
        << R"({"paragraphs": ["All of it."], "failures": [], "tables": [{"name": "t", "caption": "Few",
               "columns": [{"name": "scene", "is_number": false}], "rows": [["lattice"]]}], "figures": [
               {"name": "f", "caption": "Drawn", "x": {"label": "x", "logarithmic": false, "names": []},
                "y": {"label": "y", "logarithmic": true, "names": []}, "marks": [{"x": 1, "label": "here"}],
                "panels": [], "lines": [{"label": "one", "style": 0, "points": [[1, 2, 2, 2], [2, null, null, null]]}]}]})";
    // Other files in its folder are not part of the record.
    std::ofstream(folder / "extreme/extreme.csv") << "of another version\n";
    std::ofstream(folder / "failures.txt") << "";
    std::ofstream(folder / "endpoints.toml") << aabblab::stated_text();
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
    for (const char* part : {"Stiff scenes", "gone: a study of another version", "its subject", "a shot",
                             "Share of shots", "Extreme scenes", "All of it.", "lattice", "Drawn"})
        CHECK(holds(page, part));
    CHECK(holds(bytes_of_file(folder / "a/figures/tunnelled.csv"), ",1,0.25,0.25,0.25,plain boxes\n"));
    const auto drawn = drawn_in(folder / "a");
    for (const std::string& name : {std::string("figures/figure1.csv"), "figures/" + lists_figure + ".csv",
                                    std::string("figures/errors_float.svg"), std::string("tables/lists_1.csv"),
                                    std::string("tables/errors_meshes.tex"), std::string("tables/winners.md")})
        CHECK(drawn.contains(name));
    // Nothing was written beside the results.
    CHECK(!std::filesystem::exists(results / "report.html"));

    const aabblab::unpacked_archive unpacked(archive, aabblab::archive_folder);
    CHECK(bytes_of_file(unpacked.folder() / "LICENSE") == bytes_of_file(AABBLAB_CONFIGS "/../../LICENSE"));
    CHECK(bytes_of_file(unpacked.folder() / "FORMATS.md") ==
          bytes_of_file(AABBLAB_CONFIGS "/../../experiments/FORMATS.md"));
    // The description names every kind of file that is there.
    const std::string described = bytes_of_file(unpacked.folder() / "README.md");
    for (const std::filesystem::path& file : aabblab::archived_files(results)) {
        CAPTURE(file);
        const std::string name = file.filename().string();
        const bool is_of_study = file.begin()->string() == "stiff" || name.starts_with("process-");
        CHECK((is_of_study || name == "report.json" || holds(described, name)));
    }

    run_well(judge({archive}, folder / "b", {"--archive", folder / "again.tar.xz"}));
    CHECK(bytes_of_file(folder / "b/report.html") == page);
    CHECK(drawn_in(folder / "b") == drawn);
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
    CHECK(drawn_in(folder / "c") == drawn);
}

TEST_CASE("Studies are drawn from their rows, whatever the program's defaults are") {
    const temporary_folder folder;
    // As if they had been run by a version with other defaults of sort, partition and sweep, or with today's.
    const auto write = [&](const std::string& name, const std::string& others, bool as_earlier) {
        const aabblab::error_study study =
            aabblab::parse_error_study(lists_config(others), "lists.toml", aabblab::experiment_size::full);
        worlds::write_world(folder / name, 0.6, 0.05);
        std::uint64_t repeats = 0;
        worlds::write_experiment(folder / name / "errors", *study.scene_experiment,
                                 [&](const worlds::played& p, aabblab::row& r) {
                                     r.first_ms = 1 + static_cast<double>(repeats++ % 7) / 10;
                                     r.false_positives = 0;
                                     r.false_negatives = p.has("every=4") ? 10 : p.has("every=2") ? 5 : 0;
                                     r.candidates = 1000;
                                 });
        const std::filesystem::path results = folder / name / "errors/lists";
        if (as_earlier)  // only what the user wrote, which names no sort
            std::ofstream(results / "config.toml") << lists_config();
        else
            write_record(results, record_of(study, aabblab::read_rows(results / "results.csv")));
        std::ofstream(folder / name / "failures.txt") << "";
        aabblab::seal_record(folder / name);
    };
    const std::string radix = "sort = \"radix\"\npartition = \"none\"\nsweep = \"one_axis\"\n";
    write("today", "", /*as_earlier=*/false);
    write("other", radix, /*as_earlier=*/false);
    write("earlier", radix, /*as_earlier=*/true);
    std::map<std::string, std::string> points;
    for (const char* name : {"today", "other", "earlier"}) {
        CAPTURE(name);
        run_well(judge({folder / name}, folder / "judged"));
        points[name] = bytes_of_file(folder / "judged/figures" / (lists_figure + ".csv"));
        // Five points on three curves, three or fewer on the front, and the level without errors.
        CHECK_BETWEEN(1 + 5 + 1, std::ranges::count(points[name], '\n'), 1 + 5 + 1 + 4);
        CHECK(holds(points[name], "over every"));
    }
    CHECK(points["other"] == points["today"]);
    CHECK(points["earlier"] == points["today"]);

    // What is missing is named.
    for (const char* name : {"other", "earlier"}) {
        CAPTURE(name);
        const std::filesystem::path results = folder / name / "errors/lists";
        const std::string table = bytes_of_file(results / "results.csv");
        const std::string manifest = bytes_of_file(results / "manifest.json");
        // The manifest without its seal, the last member.
        std::ofstream(results / "manifest.json") << manifest.substr(0, manifest.find(",\n  \"seal\"")) << "\n}\n";
        aabblab::seal_record(folder / name);
        change_lines(results / "results.csv", [](std::vector<std::string>& lines) {
            std::erase_if(lines, [](const std::string& line) { return holds(line, "margin=0.5"); });
        });
        CHECK(holds(run_refused(judge({folder / name}, folder / "judged")).err,
                    "errors/lists/results.csv has no row for over margin (neighbour_list:margin=0.5"));
        std::ofstream(results / "results.csv") << std::regex_replace(table, std::regex("margin=0.5"), "margin=0.7");
        CHECK(holds(run_refused(judge({folder / name}, folder / "judged")).err, "has no row for over margin"));
    }
    const std::filesystem::path results = folder / "today/errors/lists";
    change_lines(results / "curves.csv", [](std::vector<std::string>& lines) { lines.erase(lines.begin() + 1); });
    aabblab::seal_record(folder / "today");
    CHECK(holds(run_refused(judge({folder / "today"}, folder / "judged")).err,
                "has rows of bucket + columns + simd, which is on no curve of the study"));
}

TEST_CASE("Times of elementary tests do not say where the program is") {
    const std::string context = "{\n  \"context\": {\n    \"host_name\": \"vm\",\n";
    const std::string rest = "    \"num_cpus\": 2\n  }\n}\n";
    CHECK(aabblab::without_path_of_program(context + "    \"executable\": \"/home/me/aabblab_benchmarks\",\n" + rest) ==
          context + rest);
    CHECK(aabblab::without_path_of_program(context + rest) == context + rest);
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
    rejected("errors/lists/results.csv is missing",
             [](const auto& results) { std::filesystem::remove(results / "errors/lists/results.csv"); });
    rejected("errors/lists/curves.csv was altered", of_file("errors/lists/curves.csv", "no list", "a list"));
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
