#include "command_parser.hpp"
#include "filtering.hpp"

import aabblab.inputs;
import aabblab.race;

namespace aabblab {

void add_recommend(const command_parser& program) {
    const command_parser command = program.add_command(
        "recommend", "Find the fastest composition or engine for a scene, with early stopping of slow candidates");
    auto& request = command.set_action(recommend);
    command.argument("WHAT", &request.what, scene_arguments_help);
    add_filter_options(command, &request.filter);
    command.option(
        "--seconds S", [&request](const std::string& text) { request.seconds = seconds_of(text, "run"); },
        "Seconds for the runs (default 60); the ground truth may take as long again");
    command.option("--report FILE.html", &request.report, "Also write the results as a page");
}

}  // namespace aabblab
