#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include "output.hpp"

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

}  // namespace

experiment open_experiment(const std::string& config, bool quick) {
    experiment e = read_experiment(config, quick ? experiment_size::quick : experiment_size::full);
    for (const std::string& sentence : e.notes) note(sentence);
    return e;
}

std::vector<std::string> play_experiment(const experiment& e, results_folder& results, const std::string& resume_with) {
    const interruption said(resume_with);
    std::vector<std::string> failures;
    for (const scene_choice& scene : e.scenes) {
        note_idle_engines(e, scene);
        for (const std::string& failure : run_scene(e, scene, contenders_for(e, scene), results)) {
            note(failure);
            failures.push_back(failure);
        }
        std::vector<row> rows;
        for (const row& r : results.rows())
            if (r.scene == scene.kind && r.scene_parameters == parameters_text(scene)) rows.push_back(r);
        for (const scene_summary& summary : summarise(rows)) {
            print(heading_of(summary) + "\n" + to_text(table_of(summary, number_style::grouped)) + "\n");
            if (const table counts = counts_table_of(summary, number_style::grouped); !counts.columns.empty())
                print("work a frame after the first one, and bytes\n" + to_text(counts) + "\n");
        }
        flush_output();
    }
    return failures;
}

}  // namespace aabblab
