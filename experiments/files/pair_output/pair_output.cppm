module;
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

/// Pairs and contacts on their way out of the program.
export module aabblab.pair_output;

import aabb.geometry;
import aabblab.files;

export namespace aabblab {

/// An answer that cannot be right. The program says so and exits with status 1.
class defect : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Refuses what a stage reported twice. Both are sorted.
/// @param where what reported them, as the sentence begins: "std + none + one_axis, frame 3"
/// @throws defect where a pair is there more than once.
void require_each_once(std::span<const aabb::index_pair> pairs, std::string_view where);
void require_each_once(std::span<const aabb::contact> contacts, std::string_view where);

/// A CSV file of whole numbers. There only once it is committed.
class number_table {
public:
    /// @param header the names of the columns, "frame,a,b"
    /// @throws aabb::input_error when the file cannot be written, as do `add` and `commit`.
    number_table(const std::filesystem::path& file, std::string_view header);
    /// A row.
    void add(std::initializer_list<std::uint32_t> row);
    void commit();

private:
    output_file file_;
    std::string text_;  // rows not yet written
};

}  // namespace aabblab
