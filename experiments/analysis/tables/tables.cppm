/// Results as tables, scene by scene.
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
    bool is_number = true;  ///< stands at the right
    /// Where a table is too wide, columns go from the greatest of these on; those of 0 stay.
    int spare = 0;
};

/// A table to be shown or written; each row has a cell for each column.
struct table {
    std::vector<column> columns;
    std::vector<std::vector<std::string>> rows;
};
/// Without rows: columns of words, then of numbers, then of words again.
[[nodiscard]] table empty_table(std::initializer_list<const char*> words,
                                std::initializer_list<const char*> numbers = {},
                                std::initializer_list<const char*> more_words = {});

/// A table of a report.
struct named_table {
    std::string name;  ///< of its files
    std::string caption;
    table content;
};

/// Columns lined up with spaces, for terminals.
[[nodiscard]] std::string to_text(const table& t);
/// The same in lines of at most `width` characters, as far as a name or a number is not longer. Spare columns are left
/// out, and a last line says which; where that does not help, numbers stand for names of more than half of the width,
/// which are explained below, and the columns are shared among several blocks.
[[nodiscard]] std::string to_text(table t, std::size_t width);
[[nodiscard]] std::string to_csv(const table& t);
[[nodiscard]] std::string to_markdown(const table& t);
/// As paper/tex takes it: a tabular with rules, long texts in columns that break lines.
[[nodiscard]] std::string to_tex(const table& t);
/// Text as it stands in LaTeX: what means something there is written so that it means itself.
[[nodiscard]] std::string tex_text(std::string_view text);

/// All repeats of one composition or engine in one scene, over all seeds.
struct summary_line {
    contender_name name;
    std::string label;        ///< the parts of the name that differ within the scene
    std::size_t repeats = 0;  ///< of all seeds
    std::uint64_t pairs = 0;  ///< sum over the seeds, as are contacts, missing and invented
    std::optional<std::uint64_t> contacts;
    std::string status;  ///< "exact", or "inexact" where it is so with any seed
    std::optional<std::uint64_t> missing, invented;
    std::optional<quartiles> ms_a_frame;  ///< of the frames after frame 0; of frame 0 where there is no other
    /// Of the time to that of the first composition in the same repeat: the geometric mean over processes and seeds of
    /// the median over repeats.
    std::optional<double> ratio;
    std::optional<interval> ratio_interval;  ///< of 95 %; empty where there are too few repeats
    std::optional<double> build_ms;          ///< median
    /// Of all parts, the most of any seed; empty for an engine that does not say.
    std::optional<std::uint64_t> bytes;
    /// Means a frame, over the seeds. Empty where they were not asked for, or for an engine, as are the bytes.
    std::array<std::optional<double>, aabb::work_names.size()> counts;
    std::array<std::optional<std::uint64_t>, byte_columns.size()> bytes_by_part;  ///< the most of any seed
    std::optional<double> bytes_a_triangle;  ///< of the trees; empty where there are none to be seen
    std::optional<double> box_inflation;
    std::vector<std::optional<double>> metrics;  ///< the median of each over seeds and repeats; of errors the mean
};

/// A scene, whatever its seeds.
struct scene_summary {
    std::string experiment;
    scene_choice scene;                ///< `whatever_seed`
    std::vector<std::uint64_t> seeds;  ///< in the order of the rows
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    std::string digest;  ///< of the exact answer, where there is one seed and a line that has it
    std::vector<aabb::strategy_kind> differing;  ///< kinds in which the compositions differ
    std::string common;                          ///< what all compositions share, "sweep one_axis, triangle exact"
    std::vector<summary_line> lines;             ///< in the order of the rows; ratios are to the first
};

/// Scene by scene, in the order of the rows.
[[nodiscard]] std::vector<scene_summary> summarise(std::span<const row> rows);

/// The lines from the least ratio to the greatest: exact ones first, then inexact ones, then those without times.
[[nodiscard]] std::vector<const summary_line*> ranking_of(const scene_summary& scene);

/// The lines of a scene by rank. What is the same in all of them stands in the heading in its place.
/// @param shown names of metrics that have columns beside the usual ones
[[nodiscard]] table table_of(const scene_summary& scene, std::span<const std::string> shown = {});
/// What stands above the table, some lines.
[[nodiscard]] std::string heading_of(const scene_summary& scene);

/// The work of each composition, per frame after frame 0, and the bytes of its parts, as far as any line has them, by
/// rank. Copies have their number per object beside them. Without columns where nothing was counted.
[[nodiscard]] table counts_table_of(const scene_summary& scene);

/// All scenes in one, which have the same first composition: those who play from the fastest to the slowest by the
/// geometric mean of their ratios. `regret` is the ratio over that of the fastest exact line of the scene, the median
/// and the worst over the scenes.
[[nodiscard]] table overall_table_of(std::span<const scene_summary> scenes);

/// The table of a summary.csv: every line of every scene with its rank, every number in full.
[[nodiscard]] table full_table_of(std::span<const scene_summary> scenes);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// Those in which some of these names of compositions differ.
[[nodiscard]] std::vector<aabb::strategy_kind> differing_kinds(std::span<const contender_name> names);
/// The columns that name the rows of a table, with the rank, and a row's cells in them. An engine stands in the first.
[[nodiscard]] std::vector<column> name_columns_of(std::span<const aabb::strategy_kind> differing);
[[nodiscard]] std::vector<std::string> name_cells_of(std::span<const aabb::strategy_kind> differing,
                                                     const contender_name& name, std::size_t rank);
/// Of a composition that is the only one: all its strategies, or "this composition" where a table has no room for them.
[[nodiscard]] std::string only_name_of(const contender_name& name);

}  // namespace aabblab
