#include "command_parser.hpp"

import aabblab.configs;
import aabblab.results;
import aabblab.suites;

namespace aabblab {

namespace {

struct run_request {
    std::string config;
    std::optional<std::string> out;
    std::optional<std::size_t> process;
    bool quick = false, resume = false, counts = false;
};

/// Runs the experiment of a config, perhaps in several processes with the hidden option --process, and says where its
/// results are.
/// @returns the exit status: 1 if a check failed
int run(const run_request& request) {
    outlive_reader();  // a closed pipe does not stop the experiment
    const experiment e = request.process ? read_experiment(request.config, request.quick ? experiment_size::quick
                                                                                         : experiment_size::full)
                                         : open_experiment(request.config, request.quick);
    // Quick runs have their own folder, so that they do not block the full run.
    const std::filesystem::path folder = request.out.value_or("results/" + e.name + (request.quick ? "-quick" : ""));
    if (request.process) return run_process(e, folder, *request.process) ? 0 : 1;
    const std::vector<std::string> failures =
        run_experiment(e, folder, request.resume ? existing_results::resume : existing_results::reject,
                       "the same command with --resume", request.counts ? printed::tables_and_counts : printed::tables);
    print("Every repeat is a row of " + visible((folder / "results.csv").string()) +
          ",\nevery composition of a scene a row of " + visible((folder / "summary.csv").string()) +
          "\naabblab list scenes explains the parameters of scenes, with their units\n");
    return failures.empty() ? 0 : 1;
}

}  // namespace

void add_run(const command_parser& program) {
    const command_parser command =
        program.add_command("run", "Run an experiment: validate, then time, every composition in every scene");
    auto& request = command.set_action(run);
    command.argument("CONFIG", &request.config, "Config of the experiment (.toml), which sets its NAME, used below");
    command.option("--out DIR", &request.out, "Folder of the results (default results/NAME, or results/NAME-quick)");
    command.flag("--quick", &request.quick, "Apply the quick settings of the config, for a first look");
    command.flag("--resume", &request.resume, "Skip runs whose results are in the folder already");
    command.flag("--counts", &request.counts, "Also print the work of each composition, and the bytes of its parts");
    // Internal: run starts itself with this option for each process of the config.
    command.option("--process", &request.process, "").hidden();
}

}  // namespace aabblab
