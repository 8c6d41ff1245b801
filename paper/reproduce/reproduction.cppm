/// The reproduction as files: tables, figures, a page, and the numbers of the LaTeX report.
export module aabblab.reproduction;

import aabb.std;
import aabblab.claims;
import aabblab.conditions;
import aabblab.figures;
import aabblab.page;
import aabblab.statistics;
import aabblab.tables;

export namespace aabblab {

/// A section of the reports behind the claims.
struct report_section {
    std::string id;  ///< "errors", for links
    std::string title;
    std::vector<std::string> paragraphs;
    std::vector<figure> figures;
    std::vector<named_table> tables;
};

/// The published run of the same size, judged by the same rule.
struct published_run {
    std::string name;                  ///< "the published run, paper/archive/full_run.tar.xz"
    std::vector<claim_result> claims;  ///< empty if its results are those that are reported
};

/// Compares the verdicts with the published ones in a sentence: the number of equal ones, and the claims that differ.
[[nodiscard]] std::string agreement_of_verdicts(std::span<const claim_result> claims, const published_run& published);

/// Writes to the folder:
/// - verdicts.csv and endpoints.csv, all claims in one table each;
/// - tables/NAME.csv, .md, .tex, and figures/NAME.csv, .svg, .pdf;
/// - report.html, one page that needs no other file, and report.md;
/// - macros.tex, all numbers of the LaTeX report.
/// @param runs the judged runs; the report shows the figures of the first one
/// @param sections sections of the reports only
/// @param failures the errors that validation found, one sentence each
/// @param published a run that every claim and primary ratio is compared with, if there is one
/// @throws aabb::input_error if a file cannot be read or written.
void write_reproduction(const std::filesystem::path& folder, std::span<const measurements> runs,
                        const reproduction& reproduced, std::span<const report_section> sections,
                        const std::vector<std::string>& failures, const std::optional<published_run>& published = {});

}  // namespace aabblab

// Shared by the units of the module.
namespace aabblab {

/// The origin of the results, from the manifests and rows of all experiments, and how they agree with published ones.
struct provenance {
    std::string date, commit, compiler, flags, cpu;
    std::string size;  ///< "full" or "quick"
    std::size_t rows = 0, compositions = 0, scenes = 0, processes = 0, seeds = 0, repeats = 0;
    std::vector<std::string> notes;
    std::string agreement;                   ///< `agreement_of_verdicts`; empty without a published run
    std::optional<published_run> published;  ///< if it is another run

    struct config {
        std::string experiment;
        std::string text;
        std::string manifest;
    };
    std::vector<config> configs;
};

/// The kinds of verdicts, and when the decision rule gives each.
[[nodiscard]] table rule_table();

// The first two pages: a line per claim, and the ratios that decide. Comments are at the definitions.
[[nodiscard]] std::string verdict_class(verdict_kind verdict);
[[nodiscard]] table summary_table(const reproduction& reproduced, const std::optional<published_run>& published);
[[nodiscard]] table primaries_table(const reproduction& reproduced, const std::optional<published_run>& published);
[[nodiscard]] std::string summary_html(const reproduction& reproduced, const std::optional<published_run>& published);
[[nodiscard]] std::string primaries_html(std::span<const claim_result> claims,
                                         const std::optional<published_run>& published);
[[nodiscard]] std::string published_sentence(const claim_result& c, const std::optional<published_run>& published);

[[nodiscard]] std::string interval_picture(const endpoint& e);
[[nodiscard]] std::string interval_axis();
[[nodiscard]] std::string rule_picture();

[[nodiscard]] page report_of(const reproduction& reproduced, std::span<const report_section> sections,
                             const provenance& origin, const std::vector<std::string>& failures);

}  // namespace aabblab
