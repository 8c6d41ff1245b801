#include "command_parser.hpp"

import aabblab.explain;
import aabblab.inputs;

namespace aabblab {

void add_explain(const command_parser& program) {
    const command_parser command = program.add_command(
        "explain", "What a scene is like, which composition it gets and why, its bytes, and what is left out");
    auto& request = command.calls(explain);
    command.argument(
        "WHAT", &request.what,
        std::string("Config of an experiment (.toml), for what it composes; or, for auto: ") + scene_arguments_help);
    command.option(
        "--seconds S", [&request](const std::string& text) { request.seconds = seconds_of(text, "play"); },
        "How long to play each scene (default 60); it says what there was no time for");
}

}  // namespace aabblab
