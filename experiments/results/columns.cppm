/// Comma-separated values as RFC 4180 says, except that lines end in a line feed alone: a field with a comma, a quote
/// or the end of a line stands in quotes, and a quote in it is doubled. Tables of rows of one type, written and read by
/// a function that calls `field(name, member)` for each column.
export module aabblab.results:columns;

import aabb.base;
import aabb.std;
import aabblab.files;

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

/// The inverse, also of lines that end in carriage return and line feed. A last record that was cut off is left out.
/// @param file for messages
/// @throws aabb::input_error with file and line where quotes are not as above.
[[nodiscard]] csv_text read_csv(std::string_view text, const std::string& file);

/// The same of a file that is complete.
/// @throws aabb::input_error on a last record that was cut off, too.
[[nodiscard]] std::vector<csv_record> whole_records_of(std::string_view text, const std::string& file);

/// A column of words, each for a value of an enumeration or of a flag, by number.
template <class Value>
struct one_of_words {
    Value& value;
    std::span<const std::string_view> words;
};

/// A column of numbers with all their digits; those that are read are above 0, as logarithmic axes have them.
template <class Number>
struct all_digits {
    Number& value;
};

// How a value stands in its field; types of a table's own add theirs beside them.

[[nodiscard]] inline std::string written(const std::string& text) {
    return text;
}
template <std::integral Number>
[[nodiscard]] std::string written(Number number) {
    return std::to_string(number);
}
[[nodiscard]] inline std::string written(double number) {
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, 6).ptr;
    return {text.data(), end};
}
template <class Value>
[[nodiscard]] std::string written(const one_of_words<Value>& word) {
    return std::string(word.words[static_cast<std::size_t>(word.value)]);
}
template <class Number>
[[nodiscard]] std::string written(const all_digits<Number>& number) {
    return aabb::shortest(number.value);
}
template <class T>
[[nodiscard]] std::string written(const std::optional<T>& value) {
    return value ? written(*value) : "";
}

/// @returns whether the field is such a value
[[nodiscard]] inline bool taken(std::string& to, const std::string& text) {
    to = text;
    return true;
}
template <class Number>
    requires std::is_arithmetic_v<Number>
[[nodiscard]] bool taken(Number& to, const std::string& text) {
    const char* end = text.data() + text.size();
    if (std::from_chars(text.data(), end, to) != std::from_chars_result{end, std::errc{}}) return false;
    if constexpr (std::is_floating_point_v<Number>) return std::isfinite(to);
    return true;
}
[[nodiscard]] inline double number_or_nan(const std::string& text) {
    double number = 0;
    return taken(number, text) ? number : std::nan("");
}
template <class Value>
[[nodiscard]] bool taken(const one_of_words<Value>& to, const std::string& text) {
    const auto found = std::ranges::find(to.words, text);
    if (found == to.words.end()) return false;
    to.value = static_cast<Value>(found - to.words.begin());
    return true;
}
template <class Number>
[[nodiscard]] bool taken(const all_digits<Number>& to, const std::string& text) {
    return taken(to.value, text) && to.value > 0;
}
template <class T>
[[nodiscard]] bool taken(std::optional<T>& to, const std::string& text) {
    to.reset();
    return text.empty() || taken(to.emplace(), text);
}

/// For messages.
[[nodiscard]] std::string expected_of(const auto&) {
    return "a number";
}
template <class Value>
[[nodiscard]] std::string expected_of(const one_of_words<Value>& word) {
    std::string text;
    for (const std::string_view one : word.words) text += (text.empty() ? "" : " or ") + std::string(one);
    return text;
}

template <class Row, class Columns>
[[nodiscard]] std::vector<std::string> names_of(Columns columns, std::span<const std::string> without = {}) {
    std::vector<std::string> names;
    Row any{};
    columns(any, [&](const std::string& name, const auto&) {
        if (std::ranges::find(without, name) == without.end()) names.push_back(name);
    });
    return names;
}

template <class Row, class Columns>
[[nodiscard]] std::vector<std::string> fields_of(const Row& r, Columns columns) {
    std::vector<std::string> fields;
    columns(r, [&](const std::string&, const auto& value) { fields.push_back(written(value)); });
    return fields;
}

/// The text of a table.
template <class Row, class Columns>
[[nodiscard]] std::string csv_of(std::span<const Row> rows, Columns columns) {
    std::string text = csv_line(names_of<Row>(columns));
    for (const Row& r : rows) text += csv_line(fields_of(r, columns));
    return text;
}

/// Refuses records that do not begin with the names of the columns.
void require_header(const std::string& file, const csv_record& found, const std::vector<std::string>& expected);

/// @param later columns that files of earlier versions do not have
/// @param seen sees each row and the line that it begins in
/// @throws aabb::input_error with file and line where the records are not such rows.
template <class Row, class Columns, class Seen>
[[nodiscard]] std::vector<Row> rows_in(std::span<const csv_record> records, const std::string& file, Columns columns,
                                       std::span<const std::string_view> later, Seen seen) {
    std::vector<Row> rows;
    if (records.empty()) return rows;
    std::vector<std::string> absent(later.begin(), later.end());
    std::erase_if(absent, [&](const std::string& name) {
        return std::ranges::find(records[0].fields, name) != records[0].fields.end();
    });
    require_header(file, records[0], names_of<Row>(columns, absent));
    for (const auto& [fields, line] : records.subspan(1)) {
        const std::string place = file + ":" + std::to_string(line) + ": ";
        std::size_t at = 0;
        columns(rows.emplace_back(), [&](const std::string& name, auto&& value) {
            if (std::ranges::find(absent, name) != absent.end()) return;
            if (at >= fields.size()) throw aabb::input_error(place + "the column " + name + " is missing");
            if (!taken(value, fields[at]))
                throw aabb::input_error(place + name + " must be " + expected_of(value) + ", not '" + fields[at] + "'");
            if (name.ends_with("_ms") && fields[at].starts_with('-'))
                throw aabb::input_error(place + name + " is a time, which is not below 0, as '" + fields[at] + "' is");
            ++at;
        });
        if (at != fields.size()) throw aabb::input_error(place + "there are more fields than columns");
        seen(rows.back(), line);
    }
    return rows;
}

/// Of a file that is complete, as `csv_of` writes it.
template <class Row, class Columns>
[[nodiscard]] std::vector<Row> rows_of_file(const std::filesystem::path& file, Columns columns,
                                            std::span<const std::string_view> later = {}) {
    const std::vector<csv_record> records = whole_records_of(text_of_file(file), file.string());
    if (records.empty()) require_header(file.string(), {}, names_of<Row>(columns));
    return rows_in<Row>(records, file.string(), columns, later, [](const Row&, std::size_t) {});
}

}  // namespace aabblab
