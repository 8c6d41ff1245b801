#include "command_parser.hpp"

import aabblab.measuring;

namespace aabblab {

void add_reproduce(const command_parser& program) {
    const command_parser command =
        program.add_command("reproduce", "Every table, figure and claim of the paper, with a verdict");
    auto& request = command.calls(reproduce);
    command.flag("--quick", &request.quick, "Small scenes, few repeats: some minutes in place of most of an hour");
    command.flag("--judge", &request.judge,
                 "Measure nothing: judge results that are there, of whatever build or machine, and write the report "
                 "anew");
    command.optional_argument("RESULTS", &request.sources,
                              "With --judge: archives or folders of results, in place of the folder of --out");
    command.option("--out DIR", &request.out,
                   "Folder of results and report (default results/reproduce; of RESULTS results/reproduce-judged)");
    command.option("--archive FILE", &request.archive,
                   "Also pack all that --judge needs into one file, a tar compressed by xz");
}

}  // namespace aabblab
