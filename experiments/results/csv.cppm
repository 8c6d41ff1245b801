/// Comma-separated values as RFC 4180 says, except that lines end in a line feed alone: a field with a comma, a quote
/// or the end of a line stands in quotes, and a quote in it is doubled.
export module aabblab.results:csv;

import aabb.std;

export namespace aabblab {

/// With the line feed.
[[nodiscard]] std::string csv_line(std::span<const std::string> fields);

struct csv_record {
    std::vector<std::string> fields;
    std::size_t line;  ///< in which it begins, from 1
};

struct csv_text {
    std::vector<csv_record> records;
    std::size_t bytes = 0;  ///< of the text up to the end of the last record
};

/// The inverse, also of lines that end in carriage return and line feed. A last record that was cut off in the middle
/// of being written is left out.
/// @param file for messages
/// @throws aabb::input_error with file and line where quotes are not as above.
[[nodiscard]] csv_text read_csv(std::string_view text, const std::string& file);

/// The same of a file that is complete.
/// @throws aabb::input_error on a last record that was cut off, too.
[[nodiscard]] std::vector<csv_record> whole_records_of(std::string_view text, const std::string& file);

}  // namespace aabblab
