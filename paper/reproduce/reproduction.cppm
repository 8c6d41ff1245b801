module;
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// The reproduction as files: tables, figures, a page, and what the LaTeX report takes its numbers from.
export module aabblab.reproduction;

import aabblab.claims;
import aabblab.figures;
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

/// Writes into the folder, which holds the results of the paper's experiments:
/// - verdicts.csv and endpoints.csv, all claims in one table each;
/// - tables/NAME.csv, .md, .tex, and figures/NAME.csv, .gp, .svg, .pdf;
/// - report.html, one page that needs no other file, and report.md;
/// - macros.tex, every number that the LaTeX report names.
/// @param sections of the reports alone
/// @param failures what validation found, a sentence each
/// @throws aabb::input_error where a file cannot be read or written, or figures cannot be drawn.
void write_reproduction(const std::filesystem::path& folder, const reproduction& all,
                        std::span<const report_section> sections, const std::vector<std::string>& failures);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// How the results came to be, from the manifests and rows of all experiments.
struct provenance {
    std::string date, commit, compiler, flags, cpu;
    std::string size;  ///< "full" or "quick"
    std::size_t rows = 0, compositions = 0, scenes = 0, processes = 0, seeds = 0, repeats = 0;
    std::vector<std::string> notes;

    struct config {
        std::string experiment;
        std::string text;
        std::string manifest;
    };
    std::vector<config> configs;
};
[[nodiscard]] provenance provenance_of(const std::filesystem::path& folder, const reproduction& all);

/// How a verdict comes about, from rule.md: a paragraph each, without line breaks.
[[nodiscard]] std::vector<std::string> rule_paragraphs();

[[nodiscard]] std::string html_of(const std::filesystem::path& folder, const reproduction& all,
                                  std::span<const report_section> sections, const provenance& made,
                                  const std::vector<std::string>& failures);
[[nodiscard]] std::string markdown_of(const reproduction& all, std::span<const report_section> sections,
                                      const provenance& made, const std::vector<std::string>& failures);
/// As paper/tex takes it: a tabular with rules, long texts in columns that break lines.
[[nodiscard]] std::string paper_table(const table& t);
[[nodiscard]] std::string macros_of(const reproduction& all, const provenance& made,
                                    const std::vector<std::string>& failures);

}  // namespace aabblab
