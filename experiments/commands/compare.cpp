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
    const command_parser command = program.add_command("compare",
                                                       "Compare two results folders, of two commits or machines: times "
                                                       "relative to the baseline, digests, work, bytes");
    auto& request = command.set_action(run);
    command.argument("A", &request.a, "Results folder of one experiment or several");
    command.argument("B", &request.b, "Results folder to compare with A; the column B/A has B's value over A's");
    command.flag("--times", &request.times,
                 "Also compare milliseconds per frame, if both folders come from one machine");
    command.flag("--all", &request.list_all, "Also list what is unchanged or undecided");
}

}  // namespace aabblab
