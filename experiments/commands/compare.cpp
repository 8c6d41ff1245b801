#include "command_parser.hpp"

import aabblab.comparison;
import aabblab.record;

namespace aabblab {

namespace {

int run(const compare_request& request) {
    for (const std::string& folder : {request.a, request.b}) verify_record(folder);
    return print_comparison(request);
}

}  // namespace

void add_compare(const command_parser& program) {
    const command_parser command = program.add_command(
        "compare", "Two results folders, of two commits or machines: which ratios, answers, counts and bytes changed");
    auto& request = command.calls(run);
    command.argument("A", &request.a, "Folder of results, of an experiment or of several");
    command.argument("B", &request.b, "Another, which is compared with it");
    command.flag("--times", &request.times, "Compare milliseconds too; of one machine only");
    command.flag("--all", &request.all, "List what is unchanged or undecided too");
}

}  // namespace aabblab
