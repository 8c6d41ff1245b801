#include "command_parser.hpp"

import aabblab.measuring;

namespace aabblab {

void add_reproduce(const command_parser& program) {
    const command_parser command = program.add_command(
        "reproduce", "Reproduce every table, figure and claim of the paper, with a verdict on each claim");
    auto& request = command.set_action(reproduce);
    command.flag("--quick", &request.quick, "Use small scenes and few repeats: minutes instead of most of an hour");
    command.flag("--judge", &request.judge,
                 "Measure nothing: judge existing results, of any build or machine, and write their report");
    command.optional_argument("RESULTS", &request.sources,
                              "With --judge: archives or folders of results, instead of the folder of --out");
    command.option("--out DIR", &request.out,
                   "Folder of results and report (default results/reproduce; with RESULTS results/reproduce-judged)");
    command.option("--archive FILE", &request.archive,
                   "Also pack everything that --judge needs into one file, a tar compressed by xz");
}

}  // namespace aabblab
