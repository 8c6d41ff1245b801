#include "command_parser.hpp"

import aabblab.explain;
import aabblab.inputs;

namespace aabblab {

namespace {

struct explain_request {
    std::vector<std::string> what;
    double seconds = 60;
};

int run(const explain_request& request) {
    return explain(request.what, request.seconds) ? 0 : 1;
}

}  // namespace

void add_explain(const command_parser& program) {
    const command_parser command = program.add_command(
        "explain", "What a scene is like, which composition it gets and why, its bytes, and what is left out");
    auto& request = command.calls(run);
    command.argument(
        "WHAT", &request.what,
        std::string("Config of an experiment (.toml), for what it composes; or, for auto: ") + scene_arguments_help);
    command.option(
        "--seconds S", [&request](const std::string& text) { request.seconds = seconds_of(text, "play"); },
        "How long to play each scene (default 60); it says what there was no time for");
}

}  // namespace aabblab
