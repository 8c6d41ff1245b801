module aabblab.reproduction;

import aabblab.files;
import aabblab.fmt;
import aabblab.record;

namespace aabblab {

namespace {

class macros {
public:
    /// Sets text that is already TeX.
    void set_tex(const std::string& key, const std::string& tex) { text_ += "\\aabbset{" + key + "}{" + tex + "}\n"; }
    void set(const std::string& key, std::string_view text) { set_tex(key, tex_text(text)); }
    void set(const std::string& key, std::size_t number) { set(key, std::to_string(number)); }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_ = "% Written by ./aabblab reproduce: every number of the report.\n";
};

/// The values of each factor over the scenes of a claim, ascending: "scene brownian, still; objects 100, 1000."
std::string setup_of(const claim_result& c) {
    std::vector<std::pair<std::string, std::vector<std::string>>> values;
    for (const factors& scene : c.scenes)
        for (const auto& [name, value] : scene) {
            auto factor = std::ranges::find(values, name, &std::pair<std::string, std::vector<std::string>>::first);
            if (factor == values.end()) factor = values.insert(factor, {name, {}});
            if (std::ranges::find(factor->second, value) == factor->second.end()) factor->second.push_back(value);
        }
    std::string text;
    const auto number = [](const std::string& value) { return number_of({{"", value}}, ""); };  // NaN for words
    for (auto& [name, seen] : values) {
        if (std::ranges::none_of(seen, [&](const std::string& value) { return std::isnan(number(value)); }))
            std::ranges::sort(seen, {}, number);
        text += (text.empty() ? "" : "; ") + name + " ";
        for (const std::string& value : seen) text += (&value == seen.data() ? "" : ", ") + value;
    }
    return text.empty() ? "none were measured." : text + ".";
}

/// The names, separated by commas, as TeX expects them.
template <class Named>
std::string list_of(const std::vector<Named>& entries, std::size_t from = 0) {
    std::string text;
    for (std::size_t i = from; i < entries.size(); ++i) text += (text.empty() ? "" : ",") + entries[i].name;
    return text;
}

/// Sets the macros of a claim, such as `C1.verdict`, which the LaTeX report expands.
void add_claim(macros& tex, const claim_result& c, const std::optional<published_run>& published) {
    const auto set = [&](const char* key, std::string_view text) { tex.set(c.id + "." + key, text); };
    set("claim", c.claim);
    set("measured", c.measured);
    set("verdict", text_of(c.verdict));
    set("sentence", c.sentence);
    set("because", c.evidence == c.sentence ? "" : c.evidence);
    set("published", published_sentence(c, published));
    tex.set_tex(c.id + ".figures", list_of(c.figures));
    // The first table, which `judged` inserted, has all ratios and belongs to the appendix.
    tex.set_tex(c.id + ".tables", list_of(c.tables, /*from=*/1));
    set("setup", setup_of(c));
    set("favourable", fmt::format("below {:.3g}",
                                  c.expected == expectation::less ? 1 / (1 + equivalence_band) : 1 + equivalence_band));
    const endpoint* const primary = c.primaries.empty() ? nullptr : &c.primaries.front();
    set("condition", primary ? text_of(primary->where) : "-");
    set("ratio", primary ? ratio_digits_of(primary->ratio) : "-");
    set("low", primary ? ratio_digits_of(primary->range.low) : "-");
    set("high", primary ? ratio_digits_of(primary->range.high) : "-");
    tex.set(c.id + ".endpoints", c.secondaries.size());
    for (const auto& [key, what] : {std::pair{"for", support::favours},
                                    {"against", support::contradicts},
                                    {"same", support::no_difference},
                                    {"undecided", support::undecided}})
        tex.set(c.id + "." + key,
                static_cast<std::size_t>(std::ranges::count(c.secondaries, what, &endpoint::corrected)));
}

/// Every endpoint (ratio) of every claim with its outcome, as a table for programs that check or continue the analysis.
table endpoints_of(const reproduction& reproduced) {
    table t = empty_table({"claim", "endpoint", "where", "source", "expected"}, {"ratio", "low", "high"},
                          {"direction", "outcome"});
    constexpr std::array directions{"less", "same", "more", "open"};  // in the order of `outcome`
    const auto add = [&](const claim_result& c, const endpoint& e) {
        std::string where;
        for (const auto& [name, value] : e.where) where += (where.empty() ? "" : "; ") + name + "=" + value;
        const auto digits = [](double ratio) { return fmt::format("{:.9g}", ratio); };
        t.rows.push_back({c.id,
                          e.is_primary   ? "primary"
                          : e.is_earlier ? "earlier"
                                         : "secondary",
                          where, e.source, e.expected == expectation::less ? "less" : "not more", digits(e.ratio),
                          digits(e.range.low), digits(e.range.high), directions[static_cast<std::size_t>(e.direction)],
                          text_of(e.corrected)});
    };
    for (const claim_result& c : reproduced.claims)
        for (const std::vector<endpoint>* const endpoints : {&c.primaries, &c.secondaries})
            for (const endpoint& e : *endpoints) add(c, e);
    return t;
}

/// A figure of all primary ratios of every claim with their intervals, against the band of no difference.
figure verdict_figure(const reproduction& reproduced) {
    figure f{.name = "verdicts",
             .caption =
                 "The primary ratios of every claim with their 95 % intervals, and the band of no difference. "
                 "Ratios below 1 favour the claim; where a claim only asks that something costs no more, so do "
                 "those in the band.",
             .x = {"claim"},
             .y = {"ratio", /*logarithmic=*/true}};
    const std::pair<support, const char*> outcomes[] = {{support::favours, "for the claim"},
                                                        {support::contradicts, "against it"},
                                                        {support::no_difference, "no difference"},
                                                        {support::undecided, "undecided"}};
    for (const auto& [outcome, label] : outcomes) f.lines.push_back({label, series_style::points});
    for (std::size_t i = 0; i < reproduced.claims.size(); ++i) {
        f.x.names.emplace_back(static_cast<double>(i), reproduced.claims[i].id);
        for (const endpoint& e : reproduced.claims[i].primaries) {
            const auto* const known = std::ranges::find(outcomes, e.corrected, &std::pair<support, const char*>::first);
            f.lines[static_cast<std::size_t>(known - outcomes)].points.push_back(
                {static_cast<double>(i), e.ratio, e.range.low, e.range.high});
        }
    }
    f.lines.push_back({"band of no difference",
                       series_style::level,
                       {{.x = 0, .y = 1, .low = 1 / (1 + equivalence_band), .high = 1 + equivalence_band}}});
    return f;
}

void write_table(const std::filesystem::path& folder, const named_table& t) {
    write_file(folder / (t.name + ".csv"), to_csv(t.content));
    write_file(folder / (t.name + ".md"), to_markdown(t.content));
    write_file(folder / (t.name + ".tex"), to_tex(t.content));
}

/// The macros of the LaTeX report. A missing key ends its build, so keys of values not measured are set, too.
std::string macros_of(const reproduction& reproduced, const provenance& origin,
                      const std::vector<std::string>& failures) {
    macros tex;
    // A layout that was wrong has no row in table 1.
    for (const char* tree : {"canonical", "leafless", "shared_planes", "compressed", "compressed_literal"})
        for (const char* bytes : {"paper", "allocated"}) tex.set(std::string("table1.") + tree + "." + bytes, "-");
    for (const char* name : {"table1", "table1_builds"})
        tex.set(std::string("table.") + name + ".caption", "There are no measurements.");
    tex.set("date", origin.date);
    tex.set("commit", origin.commit);
    tex.set("compiler", origin.compiler);
    tex.set("flags", origin.flags);
    tex.set("cpu", origin.cpu);
    tex.set("size", origin.size);
    tex.set("rows", origin.rows);
    tex.set("compositions", origin.compositions);
    tex.set("scenes", origin.scenes);
    tex.set("processes", origin.processes);
    tex.set("seeds", origin.seeds);
    tex.set("repeats", origin.repeats);
    tex.set_tex("confidence", "95\\,\\%");
    tex.set_tex("band", fmt::format("{:.0f}\\,\\%", 100 * equivalence_band));
    tex.set("band.low", fmt::format("{:.3f}", 1 / (1 + equivalence_band)));
    tex.set("band.high", fmt::format("{:.2f}", 1 + equivalence_band));
    tex.set("draws", draws_per_level);
    tex.set("failures",
            failures.empty() ? std::string("none") : std::to_string(failures.size()) + ", " + failures.front());
    std::string ids;
    for (const claim_result& c : reproduced.claims) ids += (ids.empty() ? "" : ",") + c.id;
    tex.set_tex("claims", ids);
    tex.set("claims.count", reproduced.claims.size());
    tex.set("headline", reproduced.headline);
    tex.set("disturbance", reproduced.disturbance);
    tex.set("agreement", origin.agreement);
    tex.set("table.bands.caption", reproduced.bands.caption);
    for (const claim_result& c : reproduced.claims) {
        add_claim(tex, c, origin.published);
        for (const figure& f : c.figures) tex.set("figure." + f.name + ".caption", f.caption);
        for (const named_table& t : c.tables) tex.set("table." + t.name + ".caption", t.caption);
    }
    tex.set("table.null_control.caption", reproduced.null_control.caption);
    for (const figure& f : reproduced.figures) tex.set("figure." + f.name + ".caption", f.caption);
    for (const named_table& t : reproduced.tables) {
        tex.set("table." + t.name + ".caption", t.caption);
        if (t.name != "table1") continue;
        for (const std::vector<std::string>& cells : t.content.rows) {
            constexpr std::size_t nominal = 3, allocated = 4;  // columns, after the tree and the sizes of its nodes
            tex.set("table1." + cells[0] + ".paper", cells[nominal]);
            tex.set("table1." + cells[0] + ".allocated", cells[allocated]);
        }
    }
    return tex.text();
}

/// Collects the origin of the results (commit, compiler, processor, …) from the manifests of all experiments used.
provenance provenance_of(const measurements& results, const reproduction& reproduced) {
    provenance origin;
    const std::filesystem::path& folder = results.folder();
    if (!is_sealed_record(folder)) origin.notes.emplace_back(unsealed_note);
    const auto text_without_returns = [](const std::filesystem::path& file) {
        std::string text = text_of_file(file);
        std::erase(text, '\r');  // copying may have changed the ends of lines
        return text;
    };
    if (const auto file = folder / stated_name; !std::filesystem::exists(file))
        origin.notes.emplace_back(
            "exploratory: the run is older than paper/claims/endpoints.toml, which states what decides each claim");
    else if (text_without_returns(file) != stated_text())
        origin.notes.emplace_back(
            "exploratory: what decides each claim has changed since the run, whose endpoints.toml differs");
    std::vector<std::string> experiments;
    for (const claim_result& c : reproduced.claims)
        for (const std::string& experiment : c.experiments)
            if (std::ranges::find(experiments, experiment) == experiments.end() &&
                std::filesystem::exists(folder / experiment / "manifest.json"))
                experiments.push_back(experiment);
    for (const char* experiment : {"choices", "null_control"})
        if (std::filesystem::exists(folder / experiment / "manifest.json")) experiments.emplace_back(experiment);
    for (const std::string& experiment : experiments) {
        const auto manifest = results.manifest(experiment);
        origin.configs.push_back({experiment, manifest.config, manifest.text});
        origin.size = manifest.quick ? "quick" : "full";
        origin.date = std::max(origin.date, manifest.date.substr(0, 10));
        origin.commit = manifest.commit;
        origin.compiler = manifest.compiler;
        origin.flags = manifest.flags;
        origin.cpu = manifest.cpu;
        for (const std::string& note : manifest.notes)
            if (std::ranges::find(origin.notes, note) == origin.notes.end()) origin.notes.push_back(note);
        const extent_of_results extent = results.extent(experiment);
        origin.rows += extent.rows;
        origin.compositions += extent.compositions;
        origin.scenes += extent.scenes;
        origin.processes = std::max(origin.processes, extent.processes);
        origin.seeds = std::max(origin.seeds, extent.seeds);
        origin.repeats = std::max(origin.repeats, extent.repeats);
    }
    return origin;
}

}  // namespace

/// Writes the judged claims with their origin as tables, figures, macros for the LaTeX report, and a page.
/// @param runs of several machines: ratios and verdicts are of all of them, figures and tables of the first
void write_reproduction(const std::filesystem::path& folder, std::span<const measurements> runs,
                        const reproduction& judged_claims, std::span<const report_section> sections,
                        const std::vector<std::string>& failures, const std::optional<published_run>& published) {
    reproduction reproduced = judged_claims;
    reproduced.figures.push_back(verdict_figure(reproduced));
    provenance origin = provenance_of(runs.front(), reproduced);
    if (published) {
        origin.agreement = agreement_of_verdicts(reproduced.claims, *published);
        if (!published->claims.empty()) origin.published = published;
    }
    for (const measurements& other : runs.subspan(1)) {
        const provenance other_origin = provenance_of(other, reproduced);
        origin.notes.push_back("ratios and verdicts are of this run and of " + other.name() + " together (" +
                               other_origin.date + ", commit " + other_origin.commit + ", " + other_origin.cpu +
                               "); figures, tables of times, the null control and open choices are of this one");
        for (const std::string& note : other_origin.notes) origin.notes.push_back(other.name() + ": " + note);
    }
    std::filesystem::create_directories(folder / "tables");
    std::vector<named_table> tables = reproduced.tables;
    tables.push_back(
        {"summary", "What is claimed, what holds, and by how much.", summary_table(reproduced, origin.published)});
    tables.push_back({"primary_ratios", "The ratios that decide.", primaries_table(reproduced, origin.published)});
    tables.push_back({"verdicts", "The verdicts.", verdict_table(reproduced)});
    tables.push_back(reproduced.bands);
    tables.push_back({"rule", "From ratios to the verdict.", rule_table()});
    tables.push_back(reproduced.null_control);
    tables.push_back({"open", "What the paper leaves open.", choice_table(reproduced)});
    std::vector<figure> figures = reproduced.figures;
    for (const claim_result& c : reproduced.claims) {
        tables.insert(tables.end(), c.tables.begin(), c.tables.end());
        figures.insert(figures.end(), c.figures.begin(), c.figures.end());
    }
    for (const report_section& section : sections) {
        tables.insert(tables.end(), section.tables.begin(), section.tables.end());
        figures.insert(figures.end(), section.figures.begin(), section.figures.end());
    }
    for (const named_table& t : tables) write_table(folder / "tables", t);
    draw(folder / "figures", figures);
    write_file(folder / "verdicts.csv", to_csv(verdict_table(reproduced)));
    write_file(folder / "endpoints.csv", to_csv(endpoints_of(reproduced)));
    write_file(folder / "macros.tex", macros_of(reproduced, origin, failures));
    const page report = report_of(reproduced, sections, origin, failures);
    write_file(folder / "report.md", report.markdown());
    write_file(folder / "report.html", report.html());
}

/// "12 of 13 verdicts agree with the published run: C5: here holds, there holds in part.", or that it is the same run.
std::string agreement_of_verdicts(std::span<const claim_result> claims, const published_run& published) {
    if (published.claims.empty()) return "The results are those of " + published.name + ".";
    std::string differing;
    std::size_t agreeing = 0;
    for (const claim_result& c : claims) {
        const auto counterpart = std::ranges::find(published.claims, c.id, &claim_result::id);
        const std::string verdict = counterpart == published.claims.end() ? "none" : text_of(counterpart->verdict);
        if (verdict == text_of(c.verdict))
            ++agreeing;
        else
            differing += fmt::format("{} {}: here {}, there {}", differing.empty() ? ":" : ";", c.id,
                                     text_of(c.verdict), verdict);
    }
    return fmt::format("{} of {} verdicts agree with {}{}.", agreeing, claims.size(), published.name, differing);
}

}  // namespace aabblab
