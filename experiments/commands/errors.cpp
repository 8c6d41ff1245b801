#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

import aabblab.configs;
import aabblab.errors;
import aabblab.figures;
import aabblab.files;
import aabblab.tables;

namespace aabblab {

namespace {

struct errors_request {
    std::string config = AABBLAB_ERROR_CONFIGS "/triangle_tests.toml";
    std::optional<std::string> out;
    bool quick = false;
};

void print_tables(std::span<const error_point> points) {
    for (const bool in_double : {false, true}) {
        if (std::ranges::none_of(points, [&](const error_point& p) { return p.in_double == in_double; })) continue;
        print(
            fmt::format("Triangles of {}s: shares of pairs with a wrong answer, of intersecting ones that were\n"
                        "missed, of others that were invented; fewest wrong first, then by time\n\n{}\n",
                        in_double ? "double" : "float", to_text(error_summary(points, in_double), output_width())));
        print(fmt::format("By set, missed + invented as shares of all pairs\n\n{}\n",
                          to_text(errors_by_set(points, in_double), output_width())));
    }
}

void run(const errors_request& request) {
    outlive_reader();
    const error_study study =
        read_error_study(request.config, request.quick ? experiment_size::quick : experiment_size::full);
    for (const std::string& sentence : study.notes) note(sentence);
    const std::filesystem::path folder =
        request.out.value_or("results/errors-" + study.name + (request.quick ? "-quick" : ""));
    std::filesystem::create_directories(folder);
    const std::vector<error_point> points = measure_errors(study);
    write_file(folder / "errors.csv", to_csv(error_rows(points)));
    write_file(folder / "config.toml", study.text);
    print_tables(points);
    draw(folder / "figures", error_figures(points));
    print("Every number is in " + visible((folder / "errors.csv").string()) + ", a plot for each set in " +
          visible((folder / "figures").string()) + "\n");
}

}  // namespace

void add_errors(CLI::App& program, int&) {
    auto* command = program.add_subcommand(
        "errors", "Error against run time: what triangle tests get wrong, and the time they take");
    auto request = std::make_shared<errors_request>();
    command
        ->add_option("CONFIG", request->config,
                     "Pairs and methods (default experiments/configs/errors/triangle_tests.toml)")
        ->type_name("");
    command->add_option("--out", request->out, "Folder of table and plots (default results/errors-NAME)")
        ->type_name("DIR");
    command->add_flag("--quick", request->quick, "Fewer pairs, for a first look");
    command->callback([request] { run(*request); });
}

}  // namespace aabblab
