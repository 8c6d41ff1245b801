module;
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Results as tables, scene by scene.
export module aabblab.report;

import aabb;
import aabblab.results;
import aabblab.statistics;

export namespace aabblab {

struct column {
    std::string name;
    bool is_number = true;  ///< stands at the right
};

/// A table to be shown or written; each row has a cell for each column.
struct table {
    std::vector<column> columns;
    std::vector<std::vector<std::string>> rows;
};
/// Columns lined up with spaces, for terminals.
[[nodiscard]] std::string to_text(const table& t);
[[nodiscard]] std::string to_csv(const table& t);
[[nodiscard]] std::string to_markdown(const table& t);
[[nodiscard]] std::string to_tex(const table& t);
[[nodiscard]] std::string to_html(const table& t);
/// Text as it stands in LaTeX and in HTML: what means something there is written so that it means itself.
[[nodiscard]] std::string tex_text(std::string_view text);
[[nodiscard]] std::string html_text(std::string_view text);

/// All repeats of one composition or engine in one scene.
struct summary_line {
    contender_name name;
    std::string label;  ///< the parts of the name that differ within the scene
    std::uint64_t pairs = 0;
    std::optional<std::uint64_t> contacts;
    std::string answer;                   ///< "exact", or "-3 +5": 3 are missing and 5 invented
    std::optional<quartiles> ms_a_frame;  ///< of the frames after frame 0; of frame 0 where there is no other
    /// Of the time to the first line's in the same repeat, median over the repeats.
    std::optional<double> ratio;
    std::optional<interval> ratio_interval;
    std::optional<double> build_ms;      ///< median
    std::optional<std::uint64_t> bytes;  ///< of all parts; empty for an engine, which does not say
    /// Empty where they were not asked for, or for an engine.
    std::array<std::optional<std::uint64_t>, aabb::work_names.size()> counts;
    std::array<std::optional<std::uint64_t>, byte_columns.size()> bytes_by_part;
    std::optional<double> bytes_a_triangle;  ///< of the trees; empty where there are none to be seen
    std::optional<double> box_inflation;
};

/// One of the kinds of strategy, and where it stands in a name.
struct name_part {
    std::string_view kind;
    std::string contender_name::* field;
};

struct scene_summary {
    std::string experiment;
    std::string scene;
    std::string parameters;
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    std::string digest;                ///< of the exact answer; empty where no line has it
    std::vector<name_part> differing;  ///< parts in which the compositions differ
    std::string common;                ///< what all compositions share, "sweep one_axis, triangle exact"
    std::vector<summary_line> lines;
};

/// Scene by scene, in the order of the rows.
[[nodiscard]] std::vector<scene_summary> summarise(std::span<const row> rows);

/// Grouped numbers are for reading ("12,345"), plain ones for programs.
enum class number_style { grouped, plain };
[[nodiscard]] table table_of(const scene_summary& scene, number_style style);

/// The work of each composition, per frame after frame 0, and the bytes of its parts, as far as any line has them.
/// Copies have their number per object beside them. Without columns where nothing was counted.
[[nodiscard]] table counts_table_of(const scene_summary& scene, number_style style);

/// What stands above the table, some lines.
[[nodiscard]] std::string heading_of(const scene_summary& scene);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

[[nodiscard]] std::string number_text(std::uint64_t n, number_style style);
/// The columns that name a line of a scene's tables, and a line's cells in them.
[[nodiscard]] std::vector<column> name_columns_of(const scene_summary& scene);
[[nodiscard]] std::vector<std::string> name_cells_of(const scene_summary& scene, const summary_line& line);

}  // namespace aabblab
