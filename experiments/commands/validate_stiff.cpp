#include "command_parser.hpp"

import aabblab.stiff;
import aabblab.suites;

namespace aabblab {

namespace {

struct stiff_request {
    std::vector<std::string> studies;
    std::optional<std::string> out;
    bool quick = false;
    bool methods = false;
};

int validate_stiff(const stiff_request& request) {
    outlive_reader();
    const std::filesystem::path folder = request.out.value_or(request.quick ? "results/stiff-quick" : "results/stiff");
    if (request.methods) {
        compare_stiff_methods(folder, request.studies, request.quick);
        print("Every number is in " + visible((folder / "methods.csv").string()) + "\n");
        return 0;
    }
    const suite_report report = run_stiff_suite(folder, request.studies, request.quick, /*shown=*/true);
    print(report.failures.empty() ? "Everything is as expected.\n"
                                  : std::to_string(report.failures.size()) + " values are not as expected.\n");
    print("Every number is in " + visible(folder.string()) + ", in one file per study,\nevery plot in " +
          visible((folder / "figures").string()) + "\n");
    return report.failures.empty() ? 0 : 1;
}

}  // namespace

void add_validate_stiff(const command_parser& program) {
    const command_parser command =
        program.command("validate")
            .add_command("stiff",
                         "Simulate bodies in contact, and compare them with closed forms and published results");
    auto& request = command.set_action(validate_stiff);
    command.optional_argument("STUDY", &request.studies, "Studies to run, from the list below (default all)");
    command.option("--out DIR", &request.out,
                   "Folder of tables and plots (default results/stiff, with --quick results/stiff-quick)");
    command.flag("--methods", &request.methods,
                 "Compare what inexact, stale and lost contacts change in each study, instead");
    command.flag("--quick", &request.quick, "Run fewer and shorter simulations, for a first look");
    command.footer([] {
        std::string text = "Studies:\n";
        for (const stiff_study& study : stiff_studies())
            text += entry(study.name, study.about.substr(0, study.about.find(". ")));
        return text.substr(0, text.size() - 1);  // the parser prints the last line end
    });
}

}  // namespace aabblab
