#include "command_parser.hpp"

import aabblab.inputs;
import aabblab.race;

namespace aabblab {

void add_recommend(const command_parser& program) {
    const command_parser command = program.add_command(
        "recommend",
        "Which composition or engine is the fastest in a scene, from a race that drops the hopeless early");
    auto& request = command.calls(recommend);
    command.argument("WHAT", &request.what, scene_arguments_help);
    command.option(
        "--seconds S", [&request](const std::string& text) { request.seconds = seconds_of(text, "race"); },
        "How long to race (default 60): it ends within twice that, or 2 s after the scene is read where that is "
        "later; who takes longer is stopped");
    command.option("--report FILE.html", &request.report, "Write all of it as a page, too");
}

}  // namespace aabblab
