/// Summarises results scene by scene, and lays them out as tables.
export module aabblab.tables;

import aabb.counters;
import aabb.registry;
import aabb.std;
import aabblab.metrics;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// The name of a first column that numbers the rows.
inline constexpr const char* row_number = "#";

struct column {
    std::string name;
    bool is_number = true;  ///< aligned to the right
    /// The order in which columns are dropped from too wide a table: the greatest first; columns with 0 stay.
    int spare = 0;
};

/// A table to print or write; each row has one cell per column.
struct table {
    std::vector<column> columns;
    std::vector<std::vector<std::string>> rows;
};
/// A table without rows: columns of words, then of numbers, then of words again.
[[nodiscard]] table empty_table(std::initializer_list<const char*> words,
                                std::initializer_list<const char*> numbers = {},
                                std::initializer_list<const char*> more_words = {});

struct named_table {
    std::string name;  ///< the stem of its files
    std::string caption;
    table content;
};

/// Aligns the columns with spaces, for terminals.
[[nodiscard]] std::string to_text(const table& t);
/// Limits lines to `width` characters unless a single name or number is longer: leaves out spare columns, which a last
/// line lists, then replaces names longer than half of the width by numbers, and splits the columns into blocks.
[[nodiscard]] std::string to_text(table t, std::size_t width);
[[nodiscard]] std::string to_csv(const table& t);
[[nodiscard]] std::string to_markdown(const table& t);
/// A tabular for paper/tex with rules; columns of long texts break lines.
[[nodiscard]] std::string to_tex(const table& t);
/// Escapes the special characters of LaTeX.
[[nodiscard]] std::string tex_text(std::string_view text);

/// All repeats of one composition or engine in one scene, over all seeds.
struct candidate_summary {
    candidate_name name;
    std::string label;        ///< the parts of the name that differ within the scene
    std::size_t repeats = 0;  ///< over all seeds
    std::uint64_t pairs = 0;  ///< summed over the seeds, as are contacts and errors
    std::optional<std::uint64_t> contacts;
    std::string status;  ///< "exact", or "inexact" if it is inexact for any seed
    std::optional<std::uint64_t> false_negatives, false_positives;
    std::optional<quartiles> ms_per_frame;  ///< frames after frame 0, or frame 0 if there is no other
    /// Time over that of the first composition, the baseline, in the same repeat: the geometric mean over processes and
    /// seeds of the median over repeats.
    std::optional<double> ratio;
    std::optional<interval> ratio_interval;  ///< 95 %; empty if there are too few repeats
    std::optional<double> build_ms;          ///< median
    /// The sum of all parts, the maximum over seeds; empty for an engine that does not report it.
    std::optional<std::uint64_t> bytes;
    /// Means per frame over the seeds. Like the bytes, empty for engines and if not recorded.
    std::array<std::optional<double>, aabb::work_names.size()> counts;
    std::array<std::optional<std::uint64_t>, byte_columns.size()> bytes_by_part;  ///< the maximum over seeds
    std::optional<double> bytes_per_triangle;  ///< of the trees; empty if there are none or their size is unknown
    std::optional<double> box_inflation;
    std::vector<std::optional<double>> metrics;  ///< medians over seeds and repeats; means for errors
};

/// A scene over all its seeds.
struct scene_summary {
    std::string experiment;
    scene_choice scene;                ///< `without_seed`
    std::vector<std::uint64_t> seeds;  ///< in the order of the rows
    std::uint64_t objects = 0, frames = 0;
    std::string digest;                          ///< of the ground truth, if there is one seed and an exact candidate
    std::vector<aabb::strategy_kind> differing;  ///< kinds in which the compositions differ
    std::string common;  ///< the strategies that all compositions share, "prepare none, triangle exact"
    std::vector<candidate_summary> candidates;  ///< in the order of the rows; the first is the baseline
};

/// Groups the rows by scene, in their order.
[[nodiscard]] std::vector<scene_summary> summarise(std::span<const row> rows);

/// Exact candidates before inexact ones, then those without times; each in ascending order of ratio, or else of time.
[[nodiscard]] std::vector<const candidate_summary*> ranking_of(const scene_summary& scene);

/// The candidates of a scene by rank. Columns that are constant move to the heading.
/// @param shown the names of metrics that get additional columns
[[nodiscard]] table table_of(const scene_summary& scene, std::span<const std::string> shown = {});
[[nodiscard]] std::string heading_of(const scene_summary& scene);

/// The work of each composition per frame after frame 0, and the bytes of its parts, by rank; columns without a value
/// are omitted. Copies are also given per object. The table has no columns if nothing was counted.
[[nodiscard]] table counts_table_of(const scene_summary& scene);

/// One table over scenes that share a baseline: candidates in ascending order of the geometric mean of their ratios.
/// `regret` is the time relative to the fastest exact one of the scene: median and maximum over the scenes.
[[nodiscard]] table overall_table_of(std::span<const scene_summary> scenes);

/// The table of a summary.csv: every candidate of every scene with its rank, with all digits.
[[nodiscard]] table full_table_of(std::span<const scene_summary> scenes);

}  // namespace aabblab

// Shared by the units of the module.
namespace aabblab {

/// The kinds in which these compositions differ: tables name only these in each row. Engines have none.
[[nodiscard]] std::vector<aabb::strategy_kind> differing_kinds(std::span<const candidate_name> names);
/// The rank and the columns that name the rows, and the cells of a row in them. An engine occupies the first.
[[nodiscard]] std::vector<column> name_columns_of(std::span<const aabb::strategy_kind> differing);
[[nodiscard]] std::vector<std::string> name_cells_of(std::span<const aabb::strategy_kind> differing,
                                                     const candidate_name& name, std::size_t rank);
/// The name of the only composition: all its strategies, or "this composition" if they do not fit in a table.
[[nodiscard]] std::string only_name_of(const candidate_name& name);

}  // namespace aabblab
