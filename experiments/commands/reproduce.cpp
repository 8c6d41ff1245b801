#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "output.hpp"
#include "process.hpp"

#include "error_studies.hpp"
#include "suite_report.hpp"

import aabb.base;
import aabblab.claims;
import aabblab.conditions;
import aabblab.configs;
import aabblab.errors;
import aabblab.files;
import aabblab.tables;
import aabblab.reproduction;
import aabblab.results;

namespace aabblab {

namespace {

/// Configs of the paper's experiments.
std::vector<std::filesystem::path> configs() {
    std::vector<std::filesystem::path> all;
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(AABBLAB_CONFIGS)))
        if (file.path().extension() == ".toml") all.push_back(file.path());
    std::ranges::sort(all);
    return all;
}

struct reproduce_request {
    std::optional<std::string> out;
    bool quick = false;
    bool judge = false;
};

/// The elementary tests of claim C6, timed by Google Benchmark in processes of their own. What is there of the same
/// build and size stays.
/// @returns a sentence where they are wrong
std::vector<std::string> time_tests(const std::filesystem::path& folder, bool quick) {
    const std::size_t processes = quick ? 3 : 5;
    const std::string repetitions = quick ? "3" : "9";
    const std::string made = build_description() + "repetitions " + repetitions + "\n";
    const std::filesystem::path maker = folder / "made_by.txt";
    const auto file_of = [&](std::size_t process) { return folder / ("process-" + std::to_string(process) + ".json"); };
    if (!std::filesystem::exists(maker) || bytes_of_file(maker) != made)
        for (std::size_t process = 0; std::filesystem::remove(file_of(process));) ++process;
    std::filesystem::create_directories(folder);
    std::ofstream(maker, std::ios::binary) << made;
    for (std::size_t process = 0; process < processes; ++process) {
        if (std::filesystem::exists(file_of(process))) continue;
        const std::filesystem::path part = file_of(process).string() + ".part";
        const std::filesystem::path log = folder / "benchmarks.log";
        const ended_process ended =
            run_to_end(own_folder() / "aabblab_benchmarks",
                       {"--benchmark_filter=^test/", "--benchmark_out_format=json", "--benchmark_out=" + part.string(),
                        "--benchmark_enable_random_interleaving=true", "--benchmark_repetitions=" + repetitions},
                       log);
        if (ended.status != 0) return {"an elementary test of c6 is wrong; see " + log.string()};
        std::filesystem::rename(part, file_of(process));
    }
    return {};
}

/// What was wrong stands beside the results, a sentence a line, since a later judgement has to say it too.
std::filesystem::path file_of_failures(const std::filesystem::path& folder) {
    return folder / "failures.txt";
}
void keep_failures(const std::filesystem::path& folder, const std::vector<std::string>& failures) {
    std::string text;
    for (const std::string& failure : failures) text += failure + "\n";
    write_file(file_of_failures(folder), text);
}
std::vector<std::string> kept_failures(const std::filesystem::path& folder) {
    std::vector<std::string> failures;
    std::ifstream in(file_of_failures(folder));
    for (std::string line; std::getline(in, line);) failures.push_back(line);
    return failures;
}

/// The project's studies of error against run time, as far as they have something to plot.
std::vector<error_study> studies_with_curves(bool quick) {
    std::vector<error_study> studies;
    for (const std::filesystem::path& config : error_configs()) {
        error_study study = read_error_study(config, quick ? experiment_size::quick : experiment_size::full);
        if (!study.curves.empty()) studies.push_back(std::move(study));
    }
    return studies;
}

std::filesystem::path folder_of_study(const std::filesystem::path& folder, const error_study& study) {
    return folder / "errors" / study.name;
}

/// The suites of `validate` that stand in the report.
std::filesystem::path file_of_suite(const std::filesystem::path& folder, const std::string& suite) {
    return folder / suite / "report.json";
}

/// @returns what is not as it must be
std::vector<std::string> play_suites(const std::filesystem::path& folder, bool quick) {
    std::vector<std::string> failures;
    const auto keep = [&](const std::string& suite, const suite_report& report) {
        keep_report(file_of_suite(folder, suite), report);
        failures.insert(failures.end(), report.failures.begin(), report.failures.end());
    };
    note("the extreme scenes");
    keep("extreme", play_extreme_suite(folder / "extreme", usual_cases(), quick, false));
    note("the stiff scenes");
    keep("stiff", play_stiff_suite(folder / "stiff", {}, quick, false));
    return failures;
}

/// Plays every experiment of the paper, and keeps what is wrong as soon as it is found.
void measure(const std::filesystem::path& folder, bool quick) {
    std::vector<experiment> experiments;
    for (const std::filesystem::path& config : configs())
        experiments.push_back(open_experiment(config.string(), quick));
    const std::vector<error_study> studies = studies_with_curves(quick);
    const std::size_t all = experiments.size() + 1 + studies.size();
    std::vector<std::string> failures;
    const auto add = [&](const std::vector<std::string>& found) {
        failures.insert(failures.end(), found.begin(), found.end());
        keep_failures(folder, failures);
    };
    std::filesystem::remove(file_of_failures(folder));
    for (const experiment& e : experiments) {
        note(fmt::format("experiment {} of {}: {}", &e - experiments.data() + 1, all, e.name));
        add(play_experiment(e, folder / e.name, existing_results::replace, "the same command", printed::nothing));
    }
    note(fmt::format("experiment {} of {}: c6, the elementary tests", experiments.size() + 1, all));
    add(time_tests(folder / "c6", quick));
    for (const error_study& study : studies) {
        note(fmt::format("experiment {} of {}: errors of {}", experiments.size() + 2 + (&study - studies.data()), all,
                         study.name));
        add(measure_study(study, folder_of_study(folder, study), printed::nothing));
    }
    add(play_suites(folder, quick));
}

/// Error against run time, from the results of the studies that are there.
report_section errors_section(const std::filesystem::path& folder, bool quick) {
    report_section section{
        .id = "errors",
        .title = "Error against run time",
        .paragraphs = {"Beyond the paper: what methods get wrong, and what that saves. Every answer is held against "
                       "the exact one; a method that gets nothing wrong stands at one wrong answer in all."},
        .figures = {},
        .tables = {}};
    for (const error_study& study : studies_with_curves(quick)) {
        const std::filesystem::path results = folder_of_study(folder, study);
        if (!study.whole && std::filesystem::exists(results / "errors.csv")) {
            const std::vector<error_point> points = read_error_rows(results / "errors.csv");
            for (const pair_group group : groups_in(points)) {
                section.paragraphs.push_back(group_statement(points, group));
                section.figures.push_back(group_figure(points, group));
                section.tables.push_back(
                    {section.figures.back().name,
                     fmt::format("In {}: shares of pairs with a wrong answer, of intersecting ones that were missed, "
                                 "of others that were invented.",
                                 title_of(group)),
                     error_summary(points, group)});
            }
        } else if (study.whole && std::filesystem::exists(results / "results.csv")) {
            const std::vector<scene_summary> scenes = summarise(read_rows(results / "results.csv"));
            std::ranges::copy(metric_statements(study, scenes), std::back_inserter(section.paragraphs));
            std::ranges::copy(metric_figures(study, scenes), std::back_inserter(section.figures));
            for (const scene_summary& scene : scenes)
                section.tables.push_back({fmt::format("{}_{}", study.name, &scene - scenes.data() + 1),
                                          heading_of(scene), table_of(scene, study.whole->shown)});
        }
    }
    return section;
}

/// Of a suite, where it was played.
std::optional<report_section> suite_section(const std::filesystem::path& folder, const std::string& suite,
                                            const std::string& title, const std::string& about) {
    if (!std::filesystem::exists(file_of_suite(folder, suite))) return std::nullopt;
    suite_report report = kept_report(file_of_suite(folder, suite));
    report_section section{suite, title, {about}, std::move(report.figures), {}};
    for (captioned_table& t : report.tables) section.tables.push_back({t.name, t.caption, std::move(t.content)});
    std::ranges::move(report.paragraphs, std::back_inserter(section.paragraphs));
    return section;
}

/// What the reports have behind the claims.
std::vector<report_section> sections_of(const std::filesystem::path& folder, bool quick) {
    std::vector<report_section> sections;
    if (report_section errors = errors_section(folder, quick); !errors.figures.empty())
        sections.push_back(std::move(errors));
    if (auto extreme =
            suite_section(folder, "extreme", "Extreme scenes",
                          "Beyond the paper: every composition and engine where exactness is hardest, exact, "
                          "refused with the reason, or wrong."))
        sections.push_back(*std::move(extreme));
    if (auto stiff = suite_section(folder, "stiff", "Stiff scenes",
                                   "Beyond the paper: bodies stepped in time, pushed by the contacts that are found, "
                                   "and held against closed forms and published results."))
        sections.push_back(*std::move(stiff));
    return sections;
}

/// The verdicts as a terminal shows them.
std::string verdict_text(const reproduction& all) {
    std::string text;
    for (const claim_result& c : all.claims)
        text += fmt::format("{:<4} {}\n     {}: {}\n", c.id, c.claim, text_of(c), c.because);
    return text;
}

int reproduce(const reproduce_request& request) {
    outlive_reader();
    const std::filesystem::path folder =
        request.out.value_or(request.quick ? "results/reproduce-quick" : "results/reproduce");
    const auto is_there = [&](const std::filesystem::path& config) {
        return std::filesystem::exists(folder / config.stem() / "results.csv");
    };
    if (request.judge && std::ranges::none_of(configs(), is_there))
        throw aabb::input_error("there are no results of a reproduction in " + folder.string());
    const folder_lock alone(folder);
    if (!request.judge) measure(folder, request.quick);
    const std::vector<std::string> failures = kept_failures(folder);
    const reproduction all = judged(measurements(folder));
    write_reproduction(folder, all, sections_of(folder, request.quick), failures);
    print(verdict_text(all));
    if (!failures.empty())
        print(fmt::format("\n{} answers were wrong; compositions among them have no times:\n", failures.size()));
    for (const std::string& failure : failures) print("  " + failure + "\n");
    print("\nThe report is " + visible((folder / "report.html").string()) + "\n");
    return failures.empty() ? 0 : 1;
}

}  // namespace

void add_reproduce(CLI::App& program, int& status) {
    auto* command = program.add_subcommand("reproduce", "Every table, figure and claim of the paper, with a verdict");
    auto request = std::make_shared<reproduce_request>();
    command->add_flag("--quick", request->quick, "Small scenes, few repeats: some minutes in place of most of an hour");
    command->add_flag("--judge", request->judge,
                      "Measure nothing: judge the results that are there, of whatever build or machine, and write the "
                      "report anew");
    command->add_option("--out", request->out, "Folder of results and report (default results/reproduce)")
        ->type_name("DIR");
    command->callback([request, &status] { status = reproduce(*request); });
}

}  // namespace aabblab
