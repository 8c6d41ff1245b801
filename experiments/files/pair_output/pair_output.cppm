/// Sorts, checks and writes pairs and contacts.
export module aabblab.pair_output;

import aabb.geometry;
import aabb.std;
import aabblab.files;

export namespace aabblab {

/// A result that cannot be correct. The program reports it and exits with status 1.
class defect : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Sorts in ascending order, as digests and files require, in place (Ross, "The Spreadsort High-performance
/// General-case Sorting Algorithm", 2002, from Boost).
void sort_rows(std::span<aabb::index_pair> pairs);
void sort_rows(std::span<aabb::contact> contacts);

/// Rejects duplicates in the sorted result of a stage.
/// @param where the origin of the rows, which begins the message: "std + none + one_axis, frame 3"
/// @throws defect if a row occurs more than once.
void require_each_once(std::span<const aabb::index_pair> pairs, std::string_view where);
void require_each_once(std::span<const aabb::contact> contacts, std::string_view where);

/// The intersection of two triangles as a line: kind, number of corners, their coordinates, the error per axis.
[[nodiscard]] std::string to_text(const aabb::triangle_intersection& common);

/// The same as CSV cells; the cells of absent corners are empty.
[[nodiscard]] std::string to_cells(const aabb::triangle_intersection& common);
/// The column names of `to_cells`.
inline constexpr std::string_view intersection_columns =
    "kind,corners,error_x,error_y,error_z,x1,y1,z1,x2,y2,z2,x3,y3,z3,x4,y4,z4,x5,y5,z5,x6,y6,z6";

/// A file of integers in the format of its ending: .npy, an array of unsigned integers of 32 bits; .json, an object
/// with columns and rows; otherwise CSV. It appears only when it is committed.
class number_table {
public:
    /// @param header the column names, such as "frame,a,b"
    /// @throws aabb::input_error if the file cannot be written, as do `add` and `commit`, or if an array cannot have
    /// the columns.
    number_table(const std::filesystem::path& file, std::string_view header);
    /// Appends a row.
    /// @param further comma-separated cells after the numbers, or empty
    void add(std::initializer_list<std::uint32_t> row, std::string_view further = {});
    void commit();

private:
    enum class format : std::uint8_t { csv, npy, json };

    [[nodiscard]] std::string array_header() const;

    output_file file_;
    format format_;
    std::size_t columns_;
    std::size_t rows_ = 0;
    std::string text_;  // rows not yet written
};

}  // namespace aabblab
