/// The reproduction as files: tables, figures, a page, and what the LaTeX report takes its numbers from.
export module aabblab.reproduction;

import aabb.std;
import aabblab.claims;
import aabblab.conditions;
import aabblab.figures;
import aabblab.page;
import aabblab.statistics;
import aabblab.tables;

export namespace aabblab {

/// What stands in the reports behind the claims.
struct report_section {
    std::string id;  ///< "errors", as a link has it
    std::string title;
    std::vector<std::string> paragraphs;
    std::vector<figure> figures;
    std::vector<named_table> tables;
};

/// Writes into the folder:
/// - verdicts.csv and endpoints.csv, all claims in one table each;
/// - tables/NAME.csv, .md, .tex, and figures/NAME.csv, .svg, .pdf;
/// - report.html, one page that needs no other file, and report.md;
/// - macros.tex, every number that the LaTeX report names.
/// @param runs what was judged; the report shows the first one's figures
/// @param sections of the reports alone
/// @param failures what validation found, a sentence each
/// @param agreement how the verdicts compare with published ones; empty where they are compared with none
/// @throws aabb::input_error where a file cannot be read or written.
void write_reproduction(const std::filesystem::path& folder, std::span<const measurements> runs,
                        const reproduction& all, std::span<const report_section> sections,
                        const std::vector<std::string>& failures, const std::string& agreement = {});

/// Of two judgements: how many verdicts are the same, and each claim whose verdict differs, a sentence.
/// @param other what the other one is called: "the published run"
[[nodiscard]] std::string agreement_of(std::span<const claim_result> here, std::span<const claim_result> there,
                                       const std::string& other);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// How the results came to be, from the manifests and rows of all experiments.
struct provenance {
    std::string date, commit, compiler, flags, cpu;
    std::string size;  ///< "full" or "quick"
    std::size_t rows = 0, compositions = 0, scenes = 0, processes = 0, seeds = 0, repeats = 0;
    std::vector<std::string> notes;
    std::string agreement;  ///< as `write_reproduction` was given it

    struct config {
        std::string experiment;
        std::string text;
        std::string manifest;
    };
    std::vector<config> configs;
};

/// Verdicts in few words.
[[nodiscard]] table rule_table();
[[nodiscard]] page report_of(const reproduction& all, std::span<const report_section> sections, const provenance& made,
                             const std::vector<std::string>& failures);

}  // namespace aabblab
