#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output.hpp"
#include "process.hpp"

#include "experiments.hpp"

import aabb.validation;
import aabblab.config;
import aabblab.report;
import aabblab.results;
import aabblab.runner;
import aabblab.scenes;

namespace aabblab {

namespace {

/// Says how to go on when the program is interrupted; every finished row is in its file by then.
class interruption {
public:
    explicit interruption(const std::string& resume_with) {
        message() = "\naabblab: interrupted; what is finished is kept, and " + resume_with + " continues\n";
        std::signal(SIGINT, [](int signal) {
            // Only what a signal handler may call.
            if (write(STDERR_FILENO, message().data(), message().size()) < 0) _exit(1);
            std::signal(signal, SIG_DFL);
            std::raise(signal);
        });
    }
    interruption(const interruption&) = delete;
    interruption& operator=(const interruption&) = delete;
    ~interruption() { std::signal(SIGINT, SIG_DFL); }

private:
    static std::string& message() {
        static std::string text;
        return text;
    }
};

void note_idle_engines(const experiment& e, const scene_choice& scene) {
    for (const aabb::engine_info& engine : aabb::engines())
        if (std::ranges::find(e.engines, engine.name) != e.engines.end() && !contender_of(engine, has_meshes(scene)))
            note(engine.name + " has no part in " + scene.kind + ": it searches no boxes");
}

void print_tables(std::span<const row> rows) {
    for (const scene_summary& summary : summarise(rows)) {
        print(heading_of(summary) + "\n" + to_text(table_of(summary, number_style::grouped)) + "\n");
        if (const table counts = counts_table_of(summary, number_style::grouped); !counts.columns.empty())
            print("work a frame after the first one, and bytes\n" + to_text(counts) + "\n");
    }
    flush_output();
}

void print_tables(const scene_choice& scene, const results_folder& results) {
    std::vector<row> rows;
    for (const row& r : results.rows())
        if (r.scene == scene.kind && r.scene_parameters == parameters_text(scene)) rows.push_back(r);
    print_tables(rows);
}

std::vector<std::string> play_here(const experiment& e, results_folder& results, printed shown) {
    std::vector<std::string> failures;
    for (const scene_choice& scene : e.scenes) {
        for (const std::string& failure : run_scene(e, scene, contenders_for(e, scene), results)) {
            note(failure);
            failures.push_back(failure);
        }
        if (shown == printed::tables) print_tables(scene, results);
    }
    return failures;
}

std::vector<std::string> play_afresh(const experiment& e, const std::filesystem::path& folder) {
    std::vector<std::string> failures;
    for (std::size_t process = 0; process < e.processes; ++process) {
        std::vector<std::string> share{"run", e.file, "--out", folder.string(), "--process", std::to_string(process)};
        if (e.quick) share.emplace_back("--quick");
        for (const std::string& failure : lines_of_own_process(share)) {
            note(failure);
            failures.push_back(failure);
        }
    }
    return failures;
}

}  // namespace

experiment open_experiment(const std::string& config, bool quick) {
    experiment e = read_experiment(config, quick ? experiment_size::quick : experiment_size::full);
    for (const std::string& sentence : e.notes) note(sentence);
    return e;
}

std::vector<std::string> play_experiment(const experiment& e, const std::filesystem::path& folder,
                                         existing_results existing, const std::string& resume_with, printed shown) {
    const interruption said(resume_with);
    const folder_lock alone(folder);
    for (const scene_choice& scene : e.scenes) note_idle_engines(e, scene);
    {
        results_folder results(folder, e, existing);
        if (!results.replaced().empty()) note(results.replaced() + "; this run replaces them");
        if (e.processes == 1) return play_here(e, results, shown);
    }
    std::vector<std::string> failures = play_afresh(e, folder);
    if (shown == printed::tables) print_tables(read_rows(folder / "results.csv"));
    return failures;
}

bool play_share(const experiment& e, const std::filesystem::path& folder, std::size_t process) {
    results_folder results(folder, e, existing_results::resume);
    bool right = true;
    for (const scene_choice& scene : e.scenes)
        for (const std::string& failure : run_scene(e, scene, contenders_for(e, scene), results, process)) {
            print(failure + "\n");
            flush_output();
            right = false;
        }
    return right;
}

}  // namespace aabblab
