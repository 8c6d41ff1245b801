/// Comma-separated values after RFC 4180, but with lines that end in a line feed alone: a field with a comma, a quote
/// or a line break is quoted, and quotes in it are doubled. A table of rows of one type is defined by a function that
/// calls `field(name, member)` for each column, both for writing and for reading.
export module aabblab.results:columns;

import aabb.base;
import aabb.std;
import aabblab.files;

export namespace aabblab {

/// One record, including the line feed.
[[nodiscard]] std::string csv_line(std::span<const std::string> fields);

struct csv_record {
    std::vector<std::string> fields;
    std::size_t line;  ///< the line at which it begins, from 1
};

struct csv_text {
    std::vector<csv_record> records;
    std::size_t bytes = 0;  ///< of the text up to the end of the last record
};

/// Parses records; lines may also end in carriage return and line feed. A truncated last record is dropped.
/// @param file the name in messages
/// @throws aabb::input_error with file and line if quoting is invalid.
[[nodiscard]] csv_text read_csv(std::string_view text, const std::string& file);

/// Parses a file that must be complete.
/// @throws aabb::input_error also if the last record is truncated.
[[nodiscard]] std::vector<csv_record> whole_records_of(std::string_view text, const std::string& file);

/// A column of words that represent the values of an enumeration or a flag, indexed by value.
template <class Value>
struct one_of_words {
    Value& value;
    std::span<const std::string_view> words;
};

/// A column of numbers with all digits; reading accepts positive ones only, because they go on logarithmic axes.
template <class Number>
struct all_digits {
    Number& value;
};

// Formatting of fields; a table adds overloads for types of its own.

[[nodiscard]] inline std::string field_text(const std::string& text) {
    return text;
}
template <std::integral Number>
[[nodiscard]] std::string field_text(Number number) {
    return std::to_string(number);
}
[[nodiscard]] inline std::string field_text(double number) {
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, 6).ptr;
    return {text.data(), end};
}
template <class Value>
[[nodiscard]] std::string field_text(const one_of_words<Value>& word) {
    return std::string(word.words[static_cast<std::size_t>(word.value)]);
}
template <class Number>
[[nodiscard]] std::string field_text(const all_digits<Number>& number) {
    return aabb::shortest(number.value);
}
template <class T>
[[nodiscard]] std::string field_text(const std::optional<T>& value) {
    return value ? field_text(*value) : "";
}

/// @returns false if the field is not a valid value
[[nodiscard]] inline bool parse_field(std::string& value, const std::string& text) {
    value = text;
    return true;
}
template <class Number>
    requires std::is_arithmetic_v<Number>
[[nodiscard]] bool parse_field(Number& value, const std::string& text) {
    const char* end = text.data() + text.size();
    if (std::from_chars(text.data(), end, value) != std::from_chars_result{end, std::errc{}}) return false;
    if constexpr (std::is_floating_point_v<Number>) return std::isfinite(value);
    return true;
}
[[nodiscard]] inline double number_or_nan(const std::string& text) {
    double number = 0;
    return parse_field(number, text) ? number : std::nan("");
}
template <class Value>
[[nodiscard]] bool parse_field(const one_of_words<Value>& word, const std::string& text) {
    const auto match = std::ranges::find(word.words, text);
    if (match == word.words.end()) return false;
    word.value = static_cast<Value>(match - word.words.begin());
    return true;
}
template <class Number>
[[nodiscard]] bool parse_field(const all_digits<Number>& number, const std::string& text) {
    return parse_field(number.value, text) && number.value > 0;
}
template <class T>
[[nodiscard]] bool parse_field(std::optional<T>& value, const std::string& text) {
    value.reset();
    return text.empty() || parse_field(value.emplace(), text);
}

/// The description of valid values in messages.
[[nodiscard]] std::string expected_of(const auto&) {
    return "a number";
}
template <class Value>
[[nodiscard]] std::string expected_of(const one_of_words<Value>& word) {
    std::string text;
    for (const std::string_view option : word.words) text += (text.empty() ? "" : " or ") + std::string(option);
    return text;
}

/// The names of a table's columns, except those in `without`.
/// @param columns defines the table: `columns(row, field)` calls `field(name, member)` for each column
template <class Row, class Columns>
[[nodiscard]] std::vector<std::string> names_of(Columns columns, std::span<const std::string> without = {}) {
    std::vector<std::string> names;
    Row any{};  // its values do not matter
    columns(any, [&](const std::string& name, const auto&) {
        if (std::ranges::find(without, name) == without.end()) names.push_back(name);
    });
    return names;
}

template <class Row, class Columns>
[[nodiscard]] std::vector<std::string> fields_of(const Row& r, Columns columns) {
    std::vector<std::string> fields;
    columns(r, [&](const std::string&, const auto& value) { fields.push_back(field_text(value)); });
    return fields;
}

/// The text of a table.
template <class Row, class Columns>
[[nodiscard]] std::string csv_of(std::span<const Row> rows, Columns columns) {
    std::string text = csv_line(names_of<Row>(columns));
    for (const Row& r : rows) text += csv_line(fields_of(r, columns));
    return text;
}

/// Rejects tables whose header differs from the names of the columns.
void require_header(const std::string& file, const csv_record& header, const std::vector<std::string>& expected);

/// Reads the rows of a table from its records; the first is the header.
/// @param columns defines the table: `columns(row, field)` calls `field(name, member)` for each column
/// @param later columns that may be absent, since files of earlier versions lack them
/// @param on_row is called with each row and the line at which it begins
/// @throws aabb::input_error with file and line if the records are not valid rows.
template <class Row, class Columns, class OnRow>
[[nodiscard]] std::vector<Row> rows_in(std::span<const csv_record> records, const std::string& file, Columns columns,
                                       std::span<const std::string_view> later, OnRow on_row) {
    std::vector<Row> rows;
    if (records.empty()) return rows;
    std::vector<std::string> absent(later.begin(), later.end());  // the later columns that this table lacks
    std::erase_if(absent, [&](const std::string& name) {
        return std::ranges::find(records[0].fields, name) != records[0].fields.end();
    });
    require_header(file, records[0], names_of<Row>(columns, absent));
    for (const auto& [fields, line] : records.subspan(1)) {
        const std::string place = file + ":" + std::to_string(line) + ": ";
        std::size_t next = 0;  // index of the field
        columns(rows.emplace_back(), [&](const std::string& name, auto&& value) {
            if (std::ranges::find(absent, name) != absent.end()) return;
            if (next >= fields.size()) throw aabb::input_error(place + "the column " + name + " is missing");
            if (!parse_field(value, fields[next]))
                throw aabb::input_error(place + name + " must be " + expected_of(value) + ", not '" + fields[next] +
                                        "'");
            if (name.ends_with("_ms") && fields[next].starts_with('-'))
                throw aabb::input_error(place + name + " is a time, which is not below 0, as '" + fields[next] +
                                        "' is");
            ++next;
        });
        if (next != fields.size()) throw aabb::input_error(place + "there are more fields than columns");
        on_row(rows.back(), line);
    }
    return rows;
}

/// The rows of a complete file, as `csv_of` writes it.
template <class Row, class Columns>
[[nodiscard]] std::vector<Row> rows_of_file(const std::filesystem::path& file, Columns columns,
                                            std::span<const std::string_view> later = {}) {
    const std::vector<csv_record> records = whole_records_of(text_of_file(file), file.string());
    if (records.empty()) require_header(file.string(), {}, names_of<Row>(columns));
    return rows_in<Row>(records, file.string(), columns, later, [](const Row&, std::size_t) {});
}

}  // namespace aabblab
