module;

#include "archive_readme_md.hpp"
#include "formats_md.hpp"
#include "license.hpp"

module aabblab.measuring;

import aabb.base;
import aabblab.archive;
import aabblab.atlas;
import aabblab.claims;
import aabblab.conditions;
import aabblab.errors;
import aabblab.files;
import aabblab.fmt;
import aabblab.output;
import aabblab.processes;
import aabblab.record;
import aabblab.results;
import aabblab.sha256;
import aabblab.statistics;
import aabblab.suites;
import aabblab.tables;

namespace aabblab {

namespace {

/// The project's studies of error against run time that draw curves, for the report.
std::vector<error_study> studies_with_curves(bool quick) {
    std::vector<error_study> studies;
    for (const std::filesystem::path& config : error_configs()) {
        error_study study = read_error_study(config, quick ? experiment_size::quick : experiment_size::full);
        if (!study.curves.empty()) studies.push_back(std::move(study));
    }
    return studies;
}

/// Times claim C6's tests of single boxes and triangles, by Google Benchmark in several processes, between which times
/// vary. Keeps existing results of the same build and settings, which `made_by.txt` describes, and removes others.
/// @returns a sentence if a test is wrong
std::vector<std::string> time_elementary_tests(const std::filesystem::path& folder, bool quick) {
    constexpr std::size_t processes = 5;
    const std::string repetitions = quick ? "3" : "9";
    // Tests of leaves decide the claim; tests of two triangles are only in the table.
    const std::string filter = quick ? "^test/[^/]+(/frame:a)?$" : "^test/";
    const std::string description = build_description() + "repetitions " + repetitions + " of " + filter + "\n";
    const std::filesystem::path description_file = folder / "made_by.txt";
    const auto file_of = [&](std::size_t process) { return folder / ("process-" + std::to_string(process) + ".json"); };
    if (!std::filesystem::exists(description_file) || bytes_of_file(description_file) != description)
        for (std::size_t process = 0; std::filesystem::remove(file_of(process));) ++process;
    std::filesystem::create_directories(folder);
    std::ofstream(description_file, std::ios::binary) << description;
    for (std::size_t process = 0; process < processes; ++process) {
        if (std::filesystem::exists(file_of(process))) continue;
        // A process that is interrupted leaves no file that looks complete.
        const std::filesystem::path part = file_of(process).string() + ".part";
        const std::filesystem::path log = folder / "benchmarks.log";
        const ended_process ended = run_to_end(
            own_folder() / "aabblab_benchmarks",
            {"--benchmark_filter=" + filter, "--benchmark_out_format=json", "--benchmark_out=" + part.string(),
             "--benchmark_enable_random_interleaving=true", "--benchmark_repetitions=" + repetitions},
            log);
        if (ended.status != 0) return {"an elementary test of c6 is wrong; see " + log.string()};
        write_file(part, without_path_of_program(text_of_file(part)));
        std::filesystem::rename(part, file_of(process));
    }
    return {};
}

/// Errors are stored with the results, one sentence per line, because a later judgement must report them too.
constexpr const char* failures_name = "failures.txt";

/// Runs the suites of extreme and stiff scenes, which the report includes.
/// @returns the errors that they found
std::vector<std::string> run_suites(const std::filesystem::path& folder, bool quick) {
    // The report of an earlier version, if it were left, would have priority over the new rows.
    for (const char* suite : {"extreme", "stiff"}) std::filesystem::remove(folder / suite / "report.json");
    constexpr bool shown = false;
    note("the extreme scenes");
    std::vector<std::string> failures = run_extreme_suite(folder / "extreme", default_cases(), quick, shown).failures;
    note("the stiff scenes");
    std::ranges::move(run_stiff_suite(folder / "stiff", {}, quick, shown).failures, std::back_inserter(failures));
    return failures;
}

/// Removes the times of claim C6's elementary tests if the folder does not match its seal (checksums of a finished
/// run). A new run keeps the times that it finds, and would seal edited ones anew; experiments check their own results.
void remove_edited_test_times(const std::filesystem::path& folder) {
    try {
        verify_record(folder);
    } catch (const aabb::input_error& edited) {
        note(std::string(edited.what()) + "; the elementary tests of c6 are timed again");
        std::filesystem::remove_all(folder / "c6");
    }
}

/// Adds a study of triangle tests to the report's section, from its errors.csv alone.
void add_triangle_tests(report_section& section, const std::filesystem::path& results) {
    const std::vector<error_point> points = read_error_rows(results / "errors.csv");
    for (const pair_group group : groups_in(points)) {
        section.paragraphs.push_back(group_statement(points, group));
        if (auto f = group_figure(points, group)) section.figures.push_back(*std::move(f));
        const std::vector<std::string> scenes = scenes_by_number(points, group);
        std::string numbered;
        for (const std::string& scene : scenes) numbered += " " + scene + ".";
        section.tables.push_back(
            {fmt::format("errors_{}", group == pair_group::of_floats    ? "float"
                                      : group == pair_group::of_doubles ? "double"
                                                                        : "meshes"),
             fmt::format(
                 "In {}: time per pair, as in the figure; the share of wrong results among the pairs of the set in "
                 "which the method errs most, and there of false negatives among intersecting pairs and of "
                 "false positives among the others.{}",
                 title_of(group), numbered),
             error_summary(points, group)});
    }
}

/// Adds a study of compositions to the report's section, from what its folder says of curves and from its rows.
/// @throws aabb::input_error if a row is missing
void add_compositions(report_section& section, const std::filesystem::path& results) {
    const std::vector<row> rows = verified_rows(results);
    const study_record record = read_record(results);
    require_rows(record, rows, results);
    std::vector<std::string> shown;  // metrics of the plots
    for (const metric_plot& plot : record.plots)
        for (const std::string& name : {plot.x, plot.y})
            if (std::ranges::find(shown, name) == shown.end()) shown.push_back(name);
    std::ranges::move(metric_statements(record, rows), std::back_inserter(section.paragraphs));
    std::ranges::move(metric_figures(record, rows), std::back_inserter(section.figures));
    const std::vector<scene_summary> scenes = summarise(rows);
    for (const scene_summary& scene : scenes)
        section.tables.push_back({fmt::format("{}_{}", record.name, &scene - scenes.data() + 1),
                                  heading_of(scene) +
                                      "ms/frame and ratio leave out frame 0, the making of stages and that of a first "
                                      "list; whole_ms and whole_cpu_ms include them",
                                  table_of(scene, shown)});
}

/// The report's section on error against run time, of the studies that ran, on triangle pairs or whole scenes. It is
/// made of the folder's files, not of the program's configs, whose methods and defaults may be others.
report_section errors_section(const std::filesystem::path& folder) {
    report_section section{
        .id = "errors",
        .title = "Error against run time",
        .paragraphs = {"Beyond the paper: the errors of methods, and the run time that they save. Every result is "
                       "compared with the ground truth; a method without errors is drawn at one wrong result."},
        .figures = {},
        .tables = {}};
    for (const std::string& name : recorded_studies(folder)) {
        const std::filesystem::path results = folder / "errors" / name;
        if (std::filesystem::exists(results / "errors.csv"))
            add_triangle_tests(section, results);
        else if (std::filesystem::exists(results / "results.csv"))
            add_compositions(section, results);
        else
            section.paragraphs.push_back(fmt::format("The study {} has no results: the run was interrupted.", name));
    }
    return section;
}

/// Adds the report's section on a suite of `validate`, if the suite was run.
void add_suite(std::vector<report_section>& sections, const std::filesystem::path& folder, const std::string& suite,
               const std::string& title, const std::string& about) {
    const std::optional<suite_report> report = stored_report(folder / suite);
    if (!report) return;
    sections.push_back({suite, title, {about}, report->figures, report->tables});
    std::ranges::copy(report->paragraphs, std::back_inserter(sections.back().paragraphs));
}

/// The report's section on the small atlas: the fastest composition or engine of each scene, if they were measured.
std::optional<report_section> atlas_section(const std::filesystem::path& folder) {
    const std::vector<atlas_scene> atlas = measured_atlas(folder_of_atlas(folder));
    if (atlas.empty()) return std::nullopt;
    return report_section{
        "atlas",
        "Atlas of the broad phase",
        {fmt::format("Beyond the paper: which composition or engine is the fastest in each of {} small scenes. "
                     "`./aabblab atlas` runs the whole atlas, and judges published statements by it.",
                     atlas.size())},
        atlas_figures(atlas),
        {{"winners",
          "The fastest per frame after the first. Shown: the second is significantly slower. As fast: not "
          "significantly "
          "slower than the fastest.",
          winners_table(atlas)},
         {"regrets", "The cost of using one everywhere: time per frame over that of the fastest in each scene.",
          regrets_table(atlas, atlas_time::per_frame)},
         {"regrets_whole", "The same for the time of all frames, including the first and construction.",
          regrets_table(atlas, atlas_time::whole_run)}}};
}

/// The stored errors, one sentence each.
std::vector<std::string> read_failures(const std::filesystem::path& folder) {
    std::vector<std::string> failures;
    if (!std::filesystem::exists(folder / failures_name)) return failures;
    for (line_stream lines(folder / failures_name); lines.next();) failures.emplace_back(lines.line());
    return failures;
}

/// Moves results of studies that this version does not have out of the run's folder, whose report shows all studies.
void set_aside_other_studies(const std::filesystem::path& folder, std::span<const error_study> studies) {
    for (const std::string& name : recorded_studies(folder)) {
        if (std::ranges::find(studies, name, &error_study::name) != studies.end()) continue;
        const std::filesystem::path aside = folder / "errors.old" / name;
        std::filesystem::create_directories(aside.parent_path());
        std::filesystem::remove_all(aside);
        std::filesystem::rename(folder / "errors" / name, aside);
        note("the study " + name + " is of another version; its results are now in " + aside.string());
    }
}

/// Runs the paper's experiments, and the studies, suites and atlas of the report, keeping results of the same build and
/// size. Errors are stored as soon as they are found. Only a finished run is sealed with checksums.
void measure_reproduction(const std::filesystem::path& folder, bool quick) {
    remove_edited_test_times(folder);
    std::vector<experiment> experiments;
    for (const std::filesystem::path& config : configs_in(AABBLAB_CONFIGS))
        experiments.push_back(open_experiment(config.string(), quick));
    const std::vector<error_study> studies = studies_with_curves(quick);
    const std::size_t count = experiments.size() + 1 + studies.size();
    std::string failures;
    const auto add = [&](const std::vector<std::string>& added) {
        for (const std::string& failure : added) failures += failure + "\n";
        write_file(folder / failures_name, failures);
    };
    unseal_record(folder);
    std::filesystem::remove(folder / failures_name);
    write_file(folder / stated_name, std::string(stated_text()));
    set_aside_other_studies(folder, studies);
    for (const experiment& e : experiments) {
        note(fmt::format("experiment {} of {}: {}", &e - experiments.data() + 1, count, e.name));
        add(run_experiment(e, folder / e.name, existing_results::replace, "the same command", printed::nothing));
    }
    note(fmt::format("experiment {} of {}: c6, the elementary tests", experiments.size() + 1, count));
    add(time_elementary_tests(folder / "c6", quick));
    for (const error_study& study : studies) {
        note(fmt::format("experiment {} of {}: errors of {}", experiments.size() + 2 + (&study - studies.data()), count,
                         study.name));
        add(measure_study(study, folder / "errors" / study.name, printed::nothing));
    }
    add(run_suites(folder, quick));
    // Always the small atlas: the whole one takes half an hour.
    add(measure_atlas(folder_of_atlas(folder), /*quick=*/true));
    seal_record(folder);
}

/// The report's sections after the claims: errors against run time, extreme scenes, stiff scenes and the atlas.
std::vector<report_section> sections_of_reproduction(const std::filesystem::path& folder) {
    std::vector<report_section> sections;
    if (report_section errors = errors_section(folder); !recorded_studies(folder).empty())
        sections.push_back(std::move(errors));
    add_suite(sections, folder, "extreme", "Extreme scenes",
              "Beyond the paper: the scenes in which exactness is hardest, where every composition and engine is "
              "exact, rejects the input, or is wrong.");
    add_suite(sections, folder, "stiff", "Stiff scenes",
              "Beyond the paper: simulations of bodies with the forces of detected contacts, compared with closed "
              "forms and published results.");
    if (auto atlas = atlas_section(folder)) sections.push_back(*std::move(atlas));
    return sections;
}

std::filesystem::path output_folder_of(const reproduce_request& request) {
    if (request.out) return *request.out;
    if (!request.sources.empty()) return "results/reproduce-judged";
    return request.quick ? "results/reproduce-quick" : "results/reproduce";
}

void require_consistent(const reproduce_request& request) {
    if (!request.sources.empty() && !request.judge)
        throw aabb::input_error(request.sources.front() + " is given, but only --judge takes existing results");
    if (request.archive && request.sources.size() > 1)
        throw aabb::input_error("--archive takes the results of one run, but several are given");
}

/// Reads and verifies all results of one run at once, so that damage is found before any output.
/// @param name the user's name for it
measurements verified_measurements(const std::filesystem::path& folder, const std::string& name) {
    const std::vector<std::string> experiments = recorded_experiments(folder);
    if (experiments.empty()) throw aabb::input_error("there are no results of a reproduction in " + name);
    verify_record(folder);
    if (!is_sealed_record(folder)) note(name + ": " + unsealed_note);
    measurements results(folder, name);
    for (const std::string& experiment : experiments) (void)results.conditions_of(experiment);
    return results;
}

/// The verdicts in words for the terminal: a warning if the machine was not quiet, the headline, each claim's sentence.
std::string verdict_text(const reproduction& reproduced) {
    std::string text;
    if (!reproduced.disturbance.empty()) text += wrapped(reproduced.disturbance) + "\n\n";
    text += wrapped(reproduced.headline) + "\n\n";
    for (const claim_result& c : reproduced.claims)
        text += hanging(fmt::format("{:<4} ", c.id), c.claim, paragraph_width()) + "\n" +
                hanging("     ", text_of(c.verdict) + ". " + c.sentence, paragraph_width()) + "\n";
    return text;
}

/// Whether a run has the quick size of the experiments.
bool is_quick(const std::filesystem::path& folder) {
    return read_manifest(folder / recorded_experiments(folder).front()).quick;
}

/// Rejects copies of a run, which have the same seal: they would count as machines that agree.
void require_different(std::span<const measurements> runs) {
    std::map<std::string, std::string> names;  // by seal
    for (const measurements& run : runs) {
        if (!is_sealed_record(run.folder())) continue;
        const auto [known, is_new] = names.emplace(seal_of_record(run.folder()), run.name());
        if (!is_new) throw aabb::input_error(known->second + " and " + run.name() + " are the same run");
    }
}

/// The judgement of the published run of the same size, an archive, if there is one.
std::optional<published_run> published_run_beside(std::span<const measurements> runs) {
    const std::string name = is_quick(runs.front().folder()) ? "quick_run.tar.xz" : "full_run.tar.xz";
    const std::filesystem::path archive = std::filesystem::path(AABBLAB_ARCHIVES) / name;
    if (!std::filesystem::exists(archive)) return {};
    const std::string published = "the published run, paper/archive/" + name;
    try {
        const std::string file = archive.string();
        const results_sources unpacked({&file, 1});
        const results_source& source = unpacked.list().front();
        const measurements results = verified_measurements(source.folder, source.name);
        const auto is_published = [&](const measurements& run) {
            return is_sealed_record(run.folder()) && seal_of_record(run.folder()) == seal_of_record(source.folder);
        };
        if (std::ranges::all_of(runs, is_published)) return published_run{.name = published, .claims = {}};
        return published_run{.name = published, .claims = judged(results).claims};
    } catch (const aabb::input_error& error) {
        note("verdicts are not compared with the published ones: " + std::string(error.what()));
        return {};
    }
}

/// Judges the results of several runs together, each as one machine, writes the report and prints the verdicts.
/// @returns the exit status: 1 if validation had found wrong results
int judge(const std::filesystem::path& out, std::span<const measurements> runs) {
    std::vector<std::string> failures;
    for (const measurements& run : runs) std::ranges::copy(read_failures(run.folder()), std::back_inserter(failures));
    const measurements& first = runs.front();
    for (const measurements& run : runs)
        if (is_quick(run.folder()) != is_quick(first.folder()))
            throw aabb::input_error(first.name() + " and " + run.name() +
                                    " are of different sizes, quick and full, and cannot be judged together");
    require_different(runs);
    const reproduction reproduced = judged(runs);
    const std::optional<published_run> published = published_run_beside(runs);
    write_reproduction(out, runs, reproduced, sections_of_reproduction(first.folder()), failures, published);
    print(verdict_text(reproduced));
    if (!failures.empty())
        print(fmt::format("\n{} results are wrong; compositions with wrong results have no times:\n", failures.size()));
    for (const std::string& failure : failures) print("  " + failure + "\n");
    print("\nThe report is " + visible((out / "report.html").string()) + "\n");
    if (published) print_paragraph(agreement_of_verdicts(reproduced.claims, *published));
    return failures.empty() ? 0 : 1;
}

/// Archives the files that a judgement reads, with their licence and what describes them, and prints the archive's size
/// and checksum.
void archive_reproduction(const std::filesystem::path& folder, const std::filesystem::path& file) {
    write_archive(file, archive_folder, folder, archived_files(folder),
                  {{"LICENSE", std::string(embedded::license)},
                   {"README.md", std::string(embedded::archive_readme_md)},
                   {"FORMATS.md", std::string(embedded::formats_md)}});
    const std::string bytes = bytes_of_file(file);
    print(fmt::format("The archive is {} ({:.1f} MiB), SHA-256 {}\n", visible(file.string()),
                      static_cast<double>(bytes.size()) / (1 << 20), sha256_of(bytes)));
}

}  // namespace

std::string without_path_of_program(std::string times) {
    const std::size_t key = times.find("\"executable\":");
    if (key == std::string::npos) return times;
    const std::size_t begin = times.rfind('\n', key) + 1;
    return times.erase(begin, times.find('\n', key) + 1 - begin);
}

/// Measures, unless existing results are to be judged, and reports; the folder is locked against a second run.
int reproduce(const reproduce_request& request) {
    outlive_reader();
    require_consistent(request);
    const std::filesystem::path out = output_folder_of(request);
    if (request.judge && request.sources.empty() && recorded_experiments(out).empty())
        throw aabb::input_error("there are no results of a reproduction in " + out.string());
    results_sources sources(request.sources);
    const folder_lock lock(out);
    if (!request.judge) measure_reproduction(out, request.quick);
    if (request.sources.empty()) sources.add(out);
    return sources.run_with_source_names([&] {
        std::vector<measurements> runs;
        for (const results_source& source : sources.list())
            runs.push_back(verified_measurements(source.folder, source.name));
        const int status = judge(out, runs);
        if (request.archive) archive_reproduction(runs.front().folder(), *request.archive);
        return status;
    });
}

}  // namespace aabblab
