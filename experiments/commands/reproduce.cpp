#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

#include "experiments.hpp"

import aabb;
import aabblab.config;
import aabblab.report;
import aabblab.results;

namespace aabblab {

namespace {

struct reproduce_request {
    std::optional<std::string> out;
    bool quick = false;
};

int reproduce(const reproduce_request& request) {
    const std::filesystem::path folder =
        request.out.value_or(request.quick ? "results/reproduce-quick" : "results/reproduce");
    if (folder.empty()) throw aabb::input_error("--out has no name of a folder");
    std::vector<experiment> experiments;
    for (const char* config : {"first.toml", "traditional_improved.toml", "global_search.toml",
                               "grid_against_world.toml", "local_detection.toml"})
        experiments.push_back(
            open_experiment((std::filesystem::path(AABBLAB_CONFIGS) / config).string(), request.quick));
    std::vector<report_part> parts;
    bool failed = false;
    for (const experiment& e : experiments) {
        results_folder results(folder / e.name, e, existing_results::replace);
        if (!results.replaced().empty()) note(results.replaced() + "; this run replaces them");
        parts.push_back({results.path(), play_experiment(e, results, "the same command")});
        failed = failed || !parts.back().failures.empty();
    }
    write_report(folder, parts);
    print("The report is " + (folder / "report.html").string() + " (and report.md)\n");
    return failed ? 1 : 0;
}

}  // namespace

void add_reproduce(CLI::App& program, int& status) {
    auto* command = program.add_subcommand("reproduce", "The experiments of the repository, validated, and a report");
    auto request = std::make_shared<reproduce_request>();
    command->add_flag("--quick", request->quick, "Small scenes and few repeats");
    command->add_option("--out", request->out, "Folder of results and report (default results/reproduce)")
        ->type_name("DIR");
    command->callback([request, &status] { status = reproduce(*request); });
}

}  // namespace aabblab
