#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

#include "validate.hpp"

import aabb.base;
import aabblab.figures;
import aabblab.files;
import aabblab.progress;
import aabblab.stepping;
import aabblab.stiff;
import aabblab.tables;

namespace aabblab {

namespace {

struct stiff_request {
    std::vector<std::string> studies;
    std::optional<std::string> out;
    bool quick = false;
};

std::string_view verdict_of(const stiff_row& r) {
    if (r.rule.empty()) return "";
    return r.holds ? "holds" : "FAILS";
}

table table_of(const stiff_result& result) {
    table t{{{"what", false}, {"quantity", false}, {"measured"}, {"expected", false}, {"verdict", false}}, {}};
    for (const stiff_row& r : result.rows)
        t.rows.push_back({r.subject, r.quantity, fmt::format("{:.4g}", r.measured), r.rule, std::string(verdict_of(r))});
    return t;
}

int validate_stiff(const stiff_request& request) {
    outlive_reader();
    const std::filesystem::path folder = request.out.value_or(request.quick ? "results/stiff-quick" : "results/stiff");
    std::filesystem::create_directories(folder);
    for (const std::string_view name : left_out_integrators())
        note("the integrator " + std::string(name) + " is left out of this build: its library was not found");
    table all{{{"study", false}, {"what", false}, {"quantity", false}, {"measured"}, {"expected", false}, {"verdict", false}},
              {}};
    std::size_t failed = 0;
    for (const stiff_study& study : stiff_studies()) {
        progress shown("playing " + std::string(study.name), 1000);
        const stiff_result result =
            study.play({request.quick, usual_contender(), [&](double share) {
                            shown.at(static_cast<std::size_t>(1000 * share));
                        }});
        shown.hide();
        print(fmt::format("{}: {}.\nExpected: {}.\n\n{}\n", study.name, study.about, study.reference,
                          to_text(table_of(result))));
        flush_output();
        for (const stiff_row& r : result.rows) {
            failed += r.holds ? 0 : 1;
            all.rows.push_back({std::string(study.name), r.subject, r.quantity, fmt::format("{}", r.measured), r.rule,
                                std::string(verdict_of(r))});
        }
        // What is finished stays, whatever happens afterwards.
        write_file(folder / "stiff.csv", to_csv(all));
        draw(folder / "figures", result.figures);
    }
    print(failed == 0 ? "Everything is as expected.\n" : std::to_string(failed) + " are not as expected.\n");
    print("Every number is in " + visible((folder / "stiff.csv").string()) + ",\nevery plot in " +
          visible((folder / "figures").string()) + "\n");
    return failed == 0 ? 0 : 1;
}

}  // namespace

void add_validate_stiff(CLI::App& validate, int& status) {
    auto* command = validate.add_subcommand(
        "stiff", "Bodies stepped in time through detection, held against closed forms and published results");
    auto request = std::make_shared<stiff_request>();
    command->add_option("--out", request->out, "Folder of table and plots (default results/stiff)")->type_name("DIR");
    command->add_flag("--quick", request->quick, "Fewer and shorter, for a first look");
    command->callback([request, &status] { status = validate_stiff(*request); });
}

}  // namespace aabblab
