#include "command_parser.hpp"
#include "filtering.hpp"

import aabblab.explain;
import aabblab.inputs;

namespace aabblab {

void add_explain(const command_parser& program) {
    const command_parser command = program.add_command(
        "explain", "Explain a scene: its measures, the selected composition, the reasons, memory and savings");
    auto& request = command.set_action(explain);
    command.argument("WHAT", &request.what,
                     std::string("Config of an experiment (.toml), to explain its compositions; or a scene, to explain "
                                 "what auto selects: ") +
                         scene_arguments_help);
    add_filter_options(command, &request.filter);
    command.option(
        "--seconds S", [&request](const std::string& text) { request.seconds = seconds_of(text, "run"); },
        "Seconds for each scene (default 60); what does not fit into them is listed as not finished");
}

}  // namespace aabblab
