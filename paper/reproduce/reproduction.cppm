module;
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The reproduction as files: tables, figures, a page, and what the LaTeX report takes its numbers from.
export module aabblab.reproduction;

import aabblab.claims;
import aabblab.tables;

export namespace aabblab {

/// Writes into the folder, which holds the results of the paper's experiments:
/// - verdicts.csv and endpoints.csv, all claims in one table each;
/// - tables/NAME.csv, .md, .tex, and figures/NAME.csv, .gp, .svg, .pdf;
/// - report.html, one page that needs no other file, and report.md;
/// - macros.tex, every number that the LaTeX report names.
/// @param failures what validation found, a sentence each
/// @throws aabb::input_error where a file cannot be read or written, or figures cannot be drawn.
void write_reproduction(const std::filesystem::path& folder, const reproduction& all,
                        const std::vector<std::string>& failures);

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

/// How a verdict comes about, a paragraph each.
inline constexpr std::array<std::string_view, 2> rule_text = {
    "Each claim has one primary endpoint, fixed in the program for full runs and for quick ones: the ratio of two "
    "compositions, or builds, or counts. Ratios of times are formed within a repeat, so that what slows the machine "
    "slows both, except those of C6, whose elementary tests Google Benchmark interleaves. Every composition is "
    "compared with the exact answer, pair by pair and frame by frame, before it is timed. The ratio is the mean "
    "logarithm over processes and seeds of the median repeat; C2 has the slope of a regression, C5 the worst of "
    "several scenes. Its 95 % interval comes from a bootstrap: processes, seeds and repeats are drawn anew in turn, "
    "and what each level adds counts with as many degrees of freedom as it has, so that processes that disagree make "
    "a wide interval. A ratio favours the claim when its interval lies below 0.952, which is 1/1.05, contradicts it "
    "above 1.05, and shows no difference within; what is left is open. Secondary endpoints are decided together, with "
    "Holm's correction, so that some are open whose own interval is not. Where \"not more\" is claimed (C2, C6, C10, "
    "and parts of C4 and C5) an interval below 1.05 favours it.",
    "A claim whose primary endpoint is open is undecided, whatever the others say. It holds when all endpoints favour "
    "it. Where some do and others not, it holds when a condition is met, the simplest that tells those that favour it "
    "from those decided otherwise, together or alone: on one factor, or on two where no single one is right in four "
    "of five of both kinds. Where one is, the verdict says in how many conditions the claim holds, and that it is "
    "mostly there. Endpoints that are open are counted beside the verdict, and a condition promises nothing of them. "
    "Where none favours it, the claim does not hold or makes no difference, as the primary endpoint says. Times are "
    "compared within a table only, never between runs or machines."};

[[nodiscard]] std::string text_of_file(const std::filesystem::path& file);

[[nodiscard]] std::string html_of(const std::filesystem::path& folder, const reproduction& all, const provenance& made,
                                  const std::vector<std::string>& failures);
[[nodiscard]] std::string markdown_of(const reproduction& all, const provenance& made,
                                      const std::vector<std::string>& failures);
/// As paper/tex takes it: a tabular with rules, long texts in columns that break lines.
[[nodiscard]] std::string paper_table(const table& t);
[[nodiscard]] std::string macros_of(const reproduction& all, const provenance& made,
                                    const std::vector<std::string>& failures);

}  // namespace aabblab
