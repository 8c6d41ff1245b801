module;
#include <fmt/format.h>

module aabblab.measuring;

import aabb.base;
import aabblab.files;
import aabblab.output;
import aabblab.processes;
import aabblab.record;
import aabblab.results;
import aabblab.suites;

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

/// The elementary tests of claim C6, timed by Google Benchmark in processes of their own. What is there of the same
/// build and size stays.
/// @returns a sentence where they are wrong
std::vector<std::string> time_tests(const std::filesystem::path& folder, bool quick) {
    constexpr std::size_t processes = 5;
    const std::string repetitions = quick ? "3" : "9";
    // Tests of leaves decide the claim; those of two triangles stand beside them in the table.
    const std::string filter = quick ? "^test/[^/]+(/frame:a)?$" : "^test/";
    const std::string made = build_description() + "repetitions " + repetitions + " of " + filter + "\n";
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
        const ended_process ended = run_to_end(
            own_folder() / "aabblab_benchmarks",
            {"--benchmark_filter=" + filter, "--benchmark_out_format=json", "--benchmark_out=" + part.string(),
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

/// What was finished is not measured again, so it must be what was measured then. Experiments see to that themselves.
void forget_altered_tests(const std::filesystem::path& folder) {
    try {
        verify_record(folder);
    } catch (const aabb::input_error& altered) {
        note(std::string(altered.what()) + "; the elementary tests of c6 are timed again");
        std::filesystem::remove_all(folder / "c6");
    }
}

}  // namespace

std::vector<std::string> kept_failures(const std::filesystem::path& folder) {
    std::vector<std::string> failures;
    if (!std::filesystem::exists(file_of_failures(folder))) return failures;
    for (line_stream lines(file_of_failures(folder)); lines.next();) failures.emplace_back(lines.line());
    return failures;
}

std::vector<error_study> studies_with_curves(bool quick) {
    std::vector<error_study> studies;
    for (const std::filesystem::path& config : error_configs()) {
        error_study study = read_error_study(config, quick ? experiment_size::quick : experiment_size::full);
        if (!study.curves.empty()) studies.push_back(std::move(study));
    }
    return studies;
}

void measure_reproduction(const std::filesystem::path& folder, bool quick) {
    forget_altered_tests(folder);
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
    unseal_record(folder);
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
    // Whatever the size of the run: the whole atlas takes half an hour by itself.
    add(measure_atlas(folder_of_atlas(folder), true));
    seal_record(folder);
}

}  // namespace aabblab
