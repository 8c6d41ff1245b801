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

/// Writes to the folder:
/// - verdicts.csv and endpoints.csv, all claims in one table each;
/// - tables/NAME.csv, .md, .tex, and figures/NAME.csv, .svg, .pdf;
/// - report.html, one page that needs no other file, and report.md;
/// - macros.tex, all numbers of the LaTeX report.
/// @param runs the judged runs; the report shows the figures of the first one
/// @param sections sections of the reports only
/// @param failures the errors that validation found, one sentence each
/// @param verdict_agreement a sentence that compares the verdicts with published ones; empty without these
/// @throws aabb::input_error if a file cannot be read or written.
void write_reproduction(const std::filesystem::path& folder, std::span<const measurements> runs,
                        const reproduction& reproduced, std::span<const report_section> sections,
                        const std::vector<std::string>& failures, const std::string& verdict_agreement = {});

/// Compares two judgements in a sentence: the number of equal verdicts, and the claims whose verdicts differ.
/// @param other the name of the other judgement: "the published run"
[[nodiscard]] std::string agreement_of_verdicts(std::span<const claim_result> claims,
                                                std::span<const claim_result> other_claims, const std::string& other);

}  // namespace aabblab

// Shared by the units of the module.
namespace aabblab {

/// The origin of the results, from the manifests and rows of all experiments, and how they agree with published ones.
struct provenance {
    std::string date, commit, compiler, flags, cpu;
    std::string size;  ///< "full" or "quick"
    std::size_t rows = 0, compositions = 0, scenes = 0, processes = 0, seeds = 0, repeats = 0;
    std::vector<std::string> notes;
    std::string verdict_agreement;  ///< the parameter of `write_reproduction`

    struct config {
        std::string experiment;
        std::string text;
        std::string manifest;
    };
    std::vector<config> configs;
};

/// The kinds of verdicts, and when the decision rule gives each.
[[nodiscard]] table rule_table();
[[nodiscard]] page report_of(const reproduction& reproduced, std::span<const report_section> sections,
                             const provenance& origin, const std::vector<std::string>& failures);

}  // namespace aabblab
