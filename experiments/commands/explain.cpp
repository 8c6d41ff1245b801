#include "command_parser.hpp"

import aabblab.explain;
import aabblab.inputs;

namespace aabblab {

void add_explain(const command_parser& program) {
    const command_parser command = program.add_command("explain",
                                                       "Explain a scene: its measures, the composition that is "
                                                       "selected and why, its memory, and what each choice saves");
    auto& request = command.set_action(explain);
    command.argument("WHAT", &request.what,
                     std::string("Config of an experiment (.toml), whose compositions are explained; or a scene, for "
                                 "which auto selects one: ") +
                         scene_arguments_help);
    command.option(
        "--seconds S", [&request](const std::string& text) { request.seconds = seconds_of(text, "run"); },
        "Time for each scene (default 60); what does not fit into it is listed as not finished");
}

}  // namespace aabblab
