#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

import aabb.base;
import aabb.policy;
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

/// In lines as wide as the terminal, at most 80.
std::string wrapped(const std::string& text) {
    const std::size_t most = std::min<std::size_t>(output_width(), 80);
    std::string lines;
    std::size_t width = 0;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        const std::string word = text.substr(from, to - from);
        const std::size_t wide = word.size();
        if (width > 0) lines += width + 1 + wide > most ? "\n" : " ";
        width = width > 0 && width + 1 + wide <= most ? width + 1 + wide : wide;
        lines += word;
        from = to + 1;
    }
    return lines;
}

/// A table for each quantity.
std::string tables_of(const stiff_result& result) {
    std::vector<std::string> quantities;
    for (const stiff_row& r : result.rows)
        if (std::ranges::find(quantities, r.quantity) == quantities.end()) quantities.push_back(r.quantity);
    std::string text;
    for (const std::string& quantity : quantities) {
        table t{{{quantity, false}, {"measured"}, {"expected", false}, {"", false}}, {}};
        for (const stiff_row& r : result.rows)
            if (r.quantity == quantity)
                t.rows.push_back({r.subject, fmt::format("{:.4g}", r.measured), r.rule, std::string(verdict_of(r))});
        text += to_text(t) + "\n";
    }
    return text;
}

/// Those of these names, all where none is given.
std::vector<stiff_study> chosen_studies(const std::vector<std::string>& names) {
    std::vector<stiff_study> chosen;
    std::vector<std::string> known;
    for (const stiff_study& study : stiff_studies()) {
        known.emplace_back(study.name);
        if (names.empty() || std::ranges::find(names, study.name) != names.end()) chosen.push_back(study);
    }
    for (const std::string& name : names)
        if (std::ranges::find(known, name) == known.end())
            throw aabb::input_error(aabb::unknown_name("study", name, known));
    return chosen;
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
    for (const stiff_study& study : chosen_studies(request.studies)) {
        progress shown("playing " + std::string(study.name), 1000);
        const stiff_result result =
            study.play({request.quick, usual_contender(), [&](double share) {
                            shown.at(static_cast<std::size_t>(1000 * share));
                        }});
        shown.hide();
        print(fmt::format("{}\n\n{}", wrapped(fmt::format("{}: {}. Expected: {}.", study.name, study.about,
                                                         study.reference)),
                          tables_of(result)));
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
    command->add_option("STUDY", request->studies, "Some of the studies by name; without, all of them")->type_name("");
    command->add_option("--out", request->out, "Folder of table and plots (default results/stiff)")->type_name("DIR");
    command->add_flag("--quick", request->quick, "Fewer and shorter, for a first look");
    command->callback([request, &status] { status = validate_stiff(*request); });
}

}  // namespace aabblab
