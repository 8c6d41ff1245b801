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
[[nodiscard]] provenance provenance_of(const measurements& results, const reproduction& all);

inline constexpr std::string_view paper_title = "Research on Collision Detection Algorithm Based on AABB";

inline constexpr std::string_view verdict_figure_name = "verdicts";

/// Ratios with their intervals, below each other, against the band of no difference, as SVG for the page. All claims
/// have the same scale; what lies beyond it is an arrow with its number.
[[nodiscard]] std::string interval_picture(std::span<const endpoint> all);

/// The rule as SVG for the page: where an interval may lie, and what that means.
[[nodiscard]] std::string rule_picture();

/// A verdict in few words.
struct verdict_word {
    verdict_kind kind;
    std::string_view word;
    std::string_view meaning;
};
[[nodiscard]] std::vector<verdict_word> verdict_words();
[[nodiscard]] table rule_table();

/// How a verdict comes about, from rule.md: a paragraph each, without line breaks.
[[nodiscard]] std::vector<std::string> rule_paragraphs();

[[nodiscard]] page report_of(const reproduction& all, std::span<const report_section> sections, const provenance& made,
                             const std::vector<std::string>& failures);
[[nodiscard]] std::string macros_of(const reproduction& all, const provenance& made,
                                    const std::vector<std::string>& failures);

}  // namespace aabblab
