module;
#include <fmt/format.h>

module aabblab.reproduction;

import aabblab.files;
import aabblab.record;

namespace aabblab {

namespace {

std::string_view text_of(outcome direction) {
    switch (direction) {
        case outcome::less: return "less";
        case outcome::same: return "same";
        case outcome::more: return "more";
        case outcome::undecided: break;
    }
    return "open";
}

/// Every endpoint of every claim, for programs.
table endpoints_of(const reproduction& all) {
    table t{{{"claim", false},
             {"endpoint", false},
             {"where", false},
             {"source", false},
             {"expected", false},
             {"ratio"},
             {"low"},
             {"high"},
             {"direction", false},
             {"outcome", false}},
            {}};
    const auto add = [&](const claim_result& c, const endpoint& e) {
        std::string where;
        for (const auto& [name, value] : e.where) where += (where.empty() ? "" : "; ") + name + "=" + value;
        const auto digits = [](double ratio) { return fmt::format("{:.9g}", ratio); };
        t.rows.push_back({c.id, e.is_primary ? "primary" : "secondary", where, e.source,
                          e.expected == expectation::less ? "less" : "not more", digits(e.ratio), digits(e.range.low),
                          digits(e.range.high), std::string(text_of(e.direction)), text_of(e.found)});
    };
    for (const claim_result& c : all.claims) {
        if (c.has_primary) add(c, c.primary);
        for (const endpoint& e : c.secondary) add(c, e);
    }
    return t;
}

/// The primary ratio of every claim against the band of no difference.
figure verdict_figure(const reproduction& all) {
    figure f{
        std::string(verdict_figure_name),
        "The primary ratio of every claim with its 95 % interval, and the band in which there is no difference. Ratios "
        "below 0.2 are left out.",
        {"claim", false, {}},
        {"ratio", true, {}},
        {},
        {}};
    series ratios{"primary ratio, 95 % interval", series_style::points, {}};
    for (std::size_t i = 0; i < all.claims.size(); ++i) {
        f.x.names.emplace_back(static_cast<double>(i), all.claims[i].id);
        if (!all.claims[i].has_primary || all.claims[i].primary.ratio < 0.2) continue;
        const endpoint& e = all.claims[i].primary;
        ratios.points.push_back({static_cast<double>(i), e.ratio, e.range.low, e.range.high});
    }
    f.lines = {ratios,
               {"no difference", series_style::level, {{0, 1, 1 / (1 + equivalence_band), 1 + equivalence_band}}}};
    return f;
}

void write_table(const std::filesystem::path& folder, const named_table& t) {
    write_file(folder / (t.name + ".csv"), to_csv(t.content));
    write_file(folder / (t.name + ".md"), to_markdown(t.content));
    write_file(folder / (t.name + ".tex"), to_tex(t.content));
}

}  // namespace

provenance provenance_of(const measurements& results, const reproduction& all) {
    provenance made;
    const std::filesystem::path& folder = results.folder();
    if (!is_sealed_record(folder)) made.notes.emplace_back(unsealed_note);
    std::vector<std::string> experiments;
    for (const claim_result& c : all.claims)
        for (const std::string& experiment : c.experiments)
            if (std::ranges::find(experiments, experiment) == experiments.end() &&
                std::filesystem::exists(folder / experiment / "manifest.json"))
                experiments.push_back(experiment);
    for (const char* experiment : {"choices", "null_control"})
        if (std::filesystem::exists(folder / experiment / "manifest.json")) experiments.emplace_back(experiment);
    for (const std::string& experiment : experiments) {
        const auto manifest = results.manifest(experiment);
        made.configs.push_back({experiment, manifest.config, manifest.text});
        made.size = manifest.quick ? "quick" : "full";
        made.date = std::max(made.date, manifest.date.substr(0, 10));
        made.commit = manifest.commit;
        made.compiler = manifest.compiler;
        made.flags = manifest.flags;
        made.cpu = manifest.cpu;
        for (const std::string& note : manifest.notes)
            if (std::ranges::find(made.notes, note) == made.notes.end()) made.notes.push_back(note);
        const extent_of_results extent = results.extent(experiment);
        made.rows += extent.rows;
        made.compositions += extent.compositions;
        made.scenes += extent.scenes;
        made.processes = std::max(made.processes, extent.processes);
        made.seeds = std::max(made.seeds, extent.seeds);
        made.repeats = std::max(made.repeats, extent.repeats);
    }
    return made;
}

void write_reproduction(const std::filesystem::path& folder, std::span<const measurements> runs,
                        const reproduction& judged_claims, std::span<const report_section> sections,
                        const std::vector<std::string>& failures, const std::string& agreement) {
    reproduction all = judged_claims;
    all.figures.push_back(verdict_figure(all));
    provenance made = provenance_of(runs.front(), all);
    made.agreement = agreement;
    for (const measurements& other : runs.subspan(1)) {
        const provenance its = provenance_of(other, all);
        made.notes.push_back("ratios and verdicts are of this run and of " + other.name() + " together (" + its.date +
                             ", commit " + its.commit + ", " + its.cpu +
                             "); figures, tables of times, the null control and open choices are of this one");
        for (const std::string& note : its.notes) made.notes.push_back(other.name() + ": " + note);
    }
    std::filesystem::create_directories(folder / "tables");
    std::vector<named_table> tables = all.tables;
    tables.push_back({"verdicts", "The verdicts.", verdict_table(all)});
    tables.push_back(all.bands);
    tables.push_back({"rule", "From endpoints to the verdict.", rule_table()});
    tables.push_back(all.null_control);
    tables.push_back({"open", "What the paper leaves open.", choice_table(all)});
    std::vector<figure> figures = all.figures;
    for (const claim_result& c : all.claims) {
        tables.insert(tables.end(), c.tables.begin(), c.tables.end());
        figures.insert(figures.end(), c.figures.begin(), c.figures.end());
    }
    for (const report_section& section : sections) {
        tables.insert(tables.end(), section.tables.begin(), section.tables.end());
        figures.insert(figures.end(), section.figures.begin(), section.figures.end());
    }
    for (const named_table& t : tables) write_table(folder / "tables", t);
    draw(folder / "figures", figures);
    write_file(folder / "verdicts.csv", to_csv(verdict_table(all)));
    write_file(folder / "endpoints.csv", to_csv(endpoints_of(all)));
    write_file(folder / "macros.tex", macros_of(all, made, failures));
    const page report = report_of(all, sections, made, failures);
    write_file(folder / "report.md", report.markdown());
    write_file(folder / "report.html", report.html());
}

}  // namespace aabblab
