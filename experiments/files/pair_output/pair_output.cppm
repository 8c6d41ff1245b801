/// Pairs and contacts on their way out of the program.
export module aabblab.pair_output;

import aabb.geometry;
import aabb.std;
import aabblab.files;

export namespace aabblab {

/// An answer that cannot be right. The program says so and exits with status 1.
class defect : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Brings pairs or contacts into ascending order, as digests and files take them: by their bits from the highest on, in
/// place (American flag sort; McIlroy, Bostic and McIlroy, Engineering Radix Sort, 1993).
void sort_rows(std::span<aabb::index_pair> pairs);
void sort_rows(std::span<aabb::contact> contacts);

/// Refuses what a stage reported twice. Both are sorted.
/// @param where what reported them, as the sentence begins: "std + none + one_axis, frame 3"
/// @throws defect where a pair is there more than once.
void require_each_once(std::span<const aabb::index_pair> pairs, std::string_view where);
void require_each_once(std::span<const aabb::contact> contacts, std::string_view where);

/// What two triangles have in common as a line: kind, number of corners, their coordinates, the error on each axis.
[[nodiscard]] std::string to_text(const aabb::triangle_intersection& common);

/// The same as cells of a row of CSV: those of corners that are not there are empty.
[[nodiscard]] std::string to_cells(const aabb::triangle_intersection& common);
/// The names of the columns of `to_cells`.
inline constexpr std::string_view intersection_columns =
    "kind,corners,error_x,error_y,error_z,"
    "x1,y1,z1,x2,y2,z2,x3,y3,z3,x4,y4,z4,x5,y5,z5,x6,y6,z6";

/// A CSV file of whole numbers. There only once it is committed.
class number_table {
public:
    /// @param header the names of the columns, "frame,a,b"
    /// @throws aabb::input_error when the file cannot be written, as do `add` and `commit`.
    number_table(const std::filesystem::path& file, std::string_view header);
    /// A row.
    /// @param further cells after the numbers, with commas between; empty where there are none
    void add(std::initializer_list<std::uint32_t> row, std::string_view further = {});
    void commit();

private:
    output_file file_;
    std::string text_;  // rows not yet written
};

}  // namespace aabblab
