#include "command_parser.hpp"

import aabblab.configs;
import aabblab.suites;

namespace aabblab {

namespace {

struct errors_request {
    std::string config = default_study();
    std::optional<std::string> out;
    bool quick = false;
};

/// Runs a study of how often methods are wrong and how fast they are, prints tables, and says where the results are.
/// @returns the exit status: 1 if a check failed
int run(const errors_request& request) {
    outlive_reader();  // a closed pipe does not stop the study
    const error_study study =
        read_error_study(request.config, request.quick ? experiment_size::quick : experiment_size::full);
    for (const std::string& sentence : study.notes) note(sentence);
    const std::filesystem::path folder =
        request.out.value_or("results/errors-" + study.name + (request.quick ? "-quick" : ""));
    const std::vector<std::string> failures = measure_study(study, folder, printed::tables);
    const auto say = [&](const char* file) { print("Every number is in " + visible((folder / file).string()) + "\n"); };
    if (!study.hits.empty()) say("intersections.csv");
    if (!study.curves.empty()) {
        say(study.scene_experiment ? "results.csv" : "errors.csv");
        print("A plot of each set is in " + visible((folder / "figures").string()) + "\n");
    }
    return failures.empty() ? 0 : 1;
}

}  // namespace

void add_errors(const command_parser& program) {
    const command_parser command =
        program.add_command("errors", "Compare the error rates of methods with their run times");
    auto& request = command.set_action(run);
    command.optional_argument(
        "CONFIG", &request.config,
        "Config of a study: its NAME, methods and input (default experiments/configs/errors/triangle_tests.toml)");
    command.option("--out DIR", &request.out, "Folder of tables and plots (default results/errors-NAME)");
    command.flag("--quick", &request.quick, "Use fewer pairs, for a first look");
}

}  // namespace aabblab
