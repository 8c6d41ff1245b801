module;
#include <unistd.h>

#include <csignal>

module aabblab.suites;

import :wrong_lists;
import aabb.policy;
import aabb.registry;
import aabb.validation;
import aabblab.files;
import aabblab.fmt;
import aabblab.inputs;
import aabblab.metrics;
import aabblab.output;
import aabblab.trials;
import aabblab.processes;
import aabblab.processor;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Prints how to resume when the program is interrupted; all finished rows are in their file by then.
class interruption {
public:
    /// Handles Ctrl-C: prints how to resume, then ends the program by the default handler.
    /// @param resume_with the command or option that continues the run
    explicit interruption(const std::string& resume_with) {
        message = "\naabblab: interrupted; what is finished is kept, and " + resume_with + " continues\n";
        std::signal(SIGINT, [](int signal) {
            // Async-signal-safe functions only.
            if (write(STDERR_FILENO, message.data(), message.size()) < 0) _exit(1);
            std::signal(signal, SIG_DFL);
            std::raise(signal);
        });
    }
    interruption(const interruption&) = delete;
    interruption& operator=(const interruption&) = delete;
    ~interruption() { std::signal(SIGINT, SIG_DFL); }

private:
    static inline std::string message;
};

/// Notes each engine that cannot run, once per kind of scene.
void note_idle_engines(const experiment& e) {
    std::set<std::string> kinds;
    for (const scene_choice& scene : e.scenes)
        if (kinds.insert(scene.kind).second)
            for (const std::string& sentence : idle_engines(e, scene, scene.kind)) note(sentence);
}

std::vector<row> rows_of_all_seeds(const scene_choice& scene, std::span<const row> rows) {
    std::vector<row> matching(rows.begin(), rows.end());
    std::erase_if(matching, [&](const row& r) { return without_seed(r.scene) != without_seed(scene); });
    return matching;
}

/// Escapes control characters, which names of files may contain.
scene_choice visible_scene(scene_choice scene) {
    for (aabb::setting& s : scene.settings) s.value = visible(s.value);
    for (std::string& mesh : scene.meshes) mesh = visible(mesh);
    return scene;
}

/// Prints a heading and a table of times per scene, and a second one of work and memory if `shown` includes them.
void print_scenes(const experiment& e, std::vector<scene_summary> scenes, printed shown) {
    for (scene_summary& scene : scenes) {
        scene.scene = visible_scene(scene.scene);
        print(heading_of(scene) + "\n" + to_text(table_of(scene, e.shown), output_width()) + "\n");
        if (shown != printed::tables_and_counts) continue;
        if (const table counts = counts_table_of(scene); !counts.columns.empty())
            print("work per frame after frame 0, and memory\n" + to_text(counts, output_width()) + "\n");
    }
    flush_output();
}

/// Prints a table over all scenes with the same baseline: scenes of boxes and of meshes have different ones.
void print_overall(std::span<const scene_summary> scenes) {
    std::map<candidate_name, std::vector<scene_summary>> by_baseline;
    for (const scene_summary& scene : scenes) by_baseline[scene.candidates[0].name].push_back(scene);
    for (const auto& [baseline, group] : by_baseline)
        if (const table overall = overall_table_of(group); group.size() > 1 && !overall.rows.empty())
            print(fmt::format(
                "{} scenes with the baseline {},\nratio: the geometric mean of the ratios to it, fastest first; "
                "regret: the ratio\nover the least one of an exact result in each scene, the median and the "
                "worst\n\n{}\n",
                group.size(), text_of(baseline), to_text(overall, output_width())));
}

/// Whether any composition uses several threads, so that the process must not be pinned to one processor.
bool is_multi_threaded(const experiment& e) {
    return std::ranges::any_of(every_composition(e), [](const aabb::composition& c) {
        return std::ranges::any_of(aabb::strategy_kinds, [&](aabb::strategy_kind kind) {
            return std::ranges::any_of(c[kind].settings,
                                       [](const aabb::setting& s) { return s.name == "threads" && s.value != "1"; });
        });
    });
}

/// Runs the repeats of one process in every scene, timed single-threaded runs on the idlest processor.
/// @param process its number, from 0
/// @param report is called with a sentence per failure
/// @param finished is called with the index of each scene at its end
void run_scenes(
    const experiment& e, results_folder& results, std::size_t process,
    const std::function<void(const std::string&)>& report,
    const std::function<void(std::size_t)>& finished = [](std::size_t) {}) {
    std::optional<idlest_processor> pinned;
    if (e.records(metric_group::time) && !is_multi_threaded(e)) pinned.emplace();
    for (std::size_t i = 0; i < e.scenes.size(); ++i) {
        const scene_choice& scene = e.scenes[i];
        const std::vector<candidate> candidates = candidates_for(e, scene);
        std::ranges::for_each(run_scene(e, scene, candidates, results, process), report);
        report_wrong_lists(e, i, candidates, results.path());
        finished(i);
    }
}

/// Runs each share in a new process, one after the other.
void run_shares(const experiment& e, const std::filesystem::path& folder,
                const std::function<void(const std::string&)>& report) {
    for (std::size_t process = 0; process < e.processes; ++process) {
        std::vector<std::string> share{"run", e.file, "--out", folder.string(), "--process", std::to_string(process)};
        if (e.quick) share.emplace_back("--quick");
        std::ranges::for_each(lines_of_own_process(share), report);
    }
}

}  // namespace

/// Reads a config, and notes on standard error which meshes are missing and how they are replaced.
/// @param quick applies the settings of the config for a short trial run
experiment open_experiment(const std::string& config, bool quick) {
    experiment e = read_experiment(config, quick ? experiment_size::quick : experiment_size::full);
    for (const std::string& sentence : e.notes) note(sentence);
    std::vector<std::string> meshes;
    for (const scene_choice& scene : e.scenes) meshes.insert(meshes.end(), scene.meshes.begin(), scene.meshes.end());
    // All scenes share the folder of the config.
    note_left_out(meshes, e.scenes.front().folder);
    return e;
}

/// A sentence for each engine that cannot run on the scene. On meshes every engine can, with default strategies for the
/// other stage; on boxes it must search boxes. External engines, other programs, take only boxes.
std::vector<std::string> idle_engines(const experiment& e, const scene_choice& scene, const std::string& scene_name) {
    std::vector<std::string> sentences;
    for (const aabb::engine_info& engine : aabb::engines())
        if (std::ranges::find(e.engines, engine.name) != e.engines.end() && !has_meshes(scene) &&
            !engine.searches_boxes)
            sentences.push_back(engine.name + " does not run on " + scene_name + ": it does not search boxes");
    for (const external_engine& engine : e.externals)
        if (has_meshes(scene))
            sentences.push_back(engine.name + " does not run on " + scene_name + ": it takes only boxes");
    return sentences;
}

/// Runs an experiment, in this process or in several new ones one after the other, seals its results (adds checksums),
/// writes their summary and prints tables. The folder is locked meanwhile.
/// @param resume_with the command or option that continues the run, for the message on Ctrl-C
/// @returns a sentence per failure
std::vector<std::string> run_experiment(const experiment& e, const std::filesystem::path& folder,
                                        existing_results existing, const std::string& resume_with, printed shown) {
    if (e.records(metric_group::time)) require_fine_clock();
    const interruption handler(resume_with);
    const folder_lock lock(folder);
    std::vector<std::string> failures;
    const auto report = [&](const std::string& failure) {
        note(failure);
        failures.push_back(failure);
    };
    {  // closes the results, which other processes open below
        results_folder results(folder, record_of(e), existing);
        note_idle_engines(e);
        if (!results.replaced().empty()) note(results.replaced() + "; this run replaces them");
        // A summary of an earlier run would be out of date.
        std::error_code ignored;
        std::filesystem::remove(folder / "summary.csv", ignored);
        if (e.processes == 1) {
            // Print a scene as soon as its last seed is finished.
            run_scenes(e, results, /*process=*/0, report, [&](std::size_t i) {
                const scene_choice& scene = e.scenes[i];
                const bool is_last_seed =
                    i + 1 == e.scenes.size() || without_seed(scene) != without_seed(e.scenes[i + 1]);
                if (shown != printed::nothing && is_last_seed)
                    print_scenes(e, summarise(rows_of_all_seeds(scene, results.rows())), shown);
            });
            results.seal();
        }
    }
    if (e.processes > 1) {
        run_shares(e, folder, report);
        results_folder(folder, record_of(e), existing_results::resume).seal();
    }
    const std::vector<scene_summary> scenes = summarise(read_rows(folder / "results.csv"));
    write_file(folder / "summary.csv", to_csv(full_table_of(scenes)));
    if (shown == printed::nothing) return failures;
    if (e.processes > 1) print_scenes(e, scenes, shown);
    print_overall(scenes);
    return failures;
}

/// Runs one process's repeats, prints failures for the process that started it, and returns whether none occurred.
bool run_process(const experiment& e, const std::filesystem::path& folder, std::size_t process) {
    results_folder results(folder, record_of(e), existing_results::resume);
    bool succeeded = true;
    run_scenes(e, results, process, [&](const std::string& failure) {
        print(failure + "\n");
        flush_output();
        succeeded = false;
    });
    return succeeded;
}

}  // namespace aabblab
