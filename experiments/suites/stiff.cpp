module;
#include <fmt/format.h>

module aabblab.suites;

import aabb.base;
import aabb.policy;
import aabblab.digits;
import aabblab.files;
import aabblab.output;
import aabblab.progress;
import aabblab.stepping;
import aabblab.stiff;

namespace aabblab {

namespace {

std::string_view verdict_of(const stiff_row& r) {
    if (r.rule.empty()) return "";
    return r.holds ? "holds" : "FAILS";
}

/// A table for each quantity.
std::vector<named_table> tables_of(const stiff_study& study, const stiff_result& result) {
    std::vector<named_table> all;
    for (const stiff_row& r : result.rows) {
        const std::string caption = fmt::format("{}: {}", study.name, r.quantity);
        auto found = std::ranges::find(all, caption, &named_table::caption);
        if (found == all.end()) {
            const std::string name = fmt::format("{}_{}", study.name, all.size() + 1);
            all.push_back({name, caption, {{{r.quantity, false}, {"measured"}, {"expected", false}, {"", false}}, {}}});
            found = all.end() - 1;
        }
        found->content.rows.push_back(
            {r.subject, fmt::format("{:.4g}", r.measured), r.rule, std::string(verdict_of(r))});
    }
    return all;
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

}  // namespace

suite_report play_stiff_suite(const std::filesystem::path& folder, const std::vector<std::string>& studies, bool quick,
                              bool shown) {
    const std::vector<stiff_study> chosen = chosen_studies(studies);
    std::filesystem::create_directories(folder);
    for (const std::string_view name : left_out_integrators())
        note("the integrator " + std::string(name) +
             " is left out of this build: its library was not found; ./aabblab validate stiff installs it");
    suite_report report;
    for (const stiff_study& study : chosen) {
        stiff_result result;
        {
            progress done("playing " + std::string(study.name), 1000);
            result = study.play(
                {quick, usual_contender(), [&](double share) { done.at(static_cast<std::size_t>(1000 * share)); }});
        }
        report.paragraphs.push_back(fmt::format("{}: {}. Expected: {}.", study.name, study.about, study.reference));
        const std::vector<named_table> tables = tables_of(study, result);
        if (shown) {
            print(wrapped(report.paragraphs.back()) + "\n\n");
            for (const named_table& t : tables) print(to_text(t.content, output_width()) + "\n");
            flush_output();
        }
        table rows{{{"subject", false}, {"quantity", false}, {"measured"}, {"expected", false}, {"verdict", false}},
                   {}};
        for (const stiff_row& r : result.rows) {
            rows.rows.push_back(
                {r.subject, r.quantity, fifteen_digits(r.measured), r.rule, std::string(verdict_of(r))});
            if (!r.holds)
                report.failures.push_back(
                    fmt::format("{}: {}: {} is {:.4g}, not {}", study.name, r.subject, r.quantity, r.measured, r.rule));
        }
        // What is finished stays, whatever happens afterwards; other studies' files do too.
        write_file(folder / (std::string(study.name) + ".csv"), to_csv(rows));
        draw(folder / "figures", result.figures);
        std::ranges::copy(tables, std::back_inserter(report.tables));
        std::ranges::copy(result.figures, std::back_inserter(report.figures));
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

}  // namespace aabblab
