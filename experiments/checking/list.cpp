module aabblab.checking;

import aabb.base;
import aabblab.files;
import aabblab.fmt;

namespace aabblab {

namespace {

/// The places of frame and ids among the columns; without frames, that of the frame is empty.
struct list_columns {
    std::optional<std::size_t> frame;
    std::size_t a = 0, b = 1;
    std::size_t count = 2;
};

list_columns columns_by_place(std::size_t count) {
    if (count == 2) return {.frame = {}, .a = 0, .b = 1, .count = 2};
    return {.frame = 0, .a = 1, .b = 2, .count = 3};
}

constexpr bool separates(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';';
}

/// Splits a line at blanks, commas and semicolons into `words`, without the quotes that a header may have.
void split(std::string_view line, std::vector<std::string_view>& words) {
    words.clear();
    while (true) {
        while (!line.empty() && separates(line.front())) line.remove_prefix(1);
        if (line.empty()) return;
        const auto end = std::ranges::find_if(line, separates);
        std::string_view word(line.begin(), end);
        line = std::string_view(end, line.end());
        if (word.size() >= 2 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
        words.push_back(word);
    }
}

/// The integer of a word, which may be written as a floating-point number; empty if it is none. Those that no scene has
/// are `beyond_all`.
std::optional<std::uint32_t> id_of(std::string_view word) {
    const char* const last = word.data() + word.size();
    const auto parsed = [&word, last](auto number) -> std::optional<decltype(number)> {
        const auto [end, error] = std::from_chars(word.begin(), last, number);
        if (end != last || error == std::errc::invalid_argument) return std::nullopt;
        return error == std::errc{} ? number : std::numeric_limits<decltype(number)>::max();
    };
    if (const auto id = parsed(std::int64_t{0}))
        return *id >= 0 && *id < beyond_all ? static_cast<std::uint32_t>(*id) : beyond_all;
    const auto number = parsed(0.0);
    if (!number || *number != std::floor(*number)) return std::nullopt;
    return *number >= 0 && *number < beyond_all ? static_cast<std::uint32_t>(*number) : beyond_all;
}

/// Whether the words are names: a line with any number is no header.
bool is_header(std::span<const std::string_view> words) {
    return std::ranges::none_of(words, [](std::string_view word) {
        double number = 0;
        return std::from_chars(word.begin(), word.end(), number).ec == std::errc{};
    });
}

/// The columns that a header names, by any of the names that are usual for frames and for the two ids.
/// @throws aabb::input_error without file and line
list_columns columns_of_header(std::span<const std::string_view> names) {
    constexpr std::array<std::string_view, 6> frames{"frame", "step", "pose", "time_step", "timestep", "t"};
    constexpr std::array<std::array<std::string_view, 2>, 8> ids{{{"a", "b"},
                                                                  {"i", "j"},
                                                                  {"id_a", "id_b"},
                                                                  {"object_a", "object_b"},
                                                                  {"triangle_a", "triangle_b"},
                                                                  {"first", "second"},
                                                                  {"id1", "id2"},
                                                                  {"i1", "i2"}}};
    std::vector<std::string> lower;
    for (const std::string_view name : names) {
        lower.emplace_back(name);
        for (char& c : lower.back()) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    const auto place_of = [&](std::string_view name) -> std::optional<std::size_t> {
        const auto column = std::ranges::find(lower, name);
        if (column == lower.end()) return std::nullopt;
        return static_cast<std::size_t>(column - lower.begin());
    };
    list_columns columns{.frame = {}, .a = 0, .b = 0, .count = names.size()};
    for (const std::string_view name : frames)
        if (!columns.frame) columns.frame = place_of(name);
    for (const auto& [a, b] : ids)
        if (place_of(a) && place_of(b)) {
            columns.a = *place_of(a);
            columns.b = *place_of(b);
            return columns;
        }
    throw aabb::input_error("the header names no columns a and b, such as frame,a,b or i,j");
}

/// Reads a list of pairs as text, line by line.
pair_list read_text(const std::filesystem::path& file) {
    pair_list list;
    std::optional<list_columns> columns;
    std::vector<std::string_view> words;
    for (line_stream lines(file); lines.next();) {
        split(without_comment(lines.line()), words);
        if (words.empty()) continue;
        if (!columns) {
            const bool has_names = is_header(words);
            if (!has_names && words.size() != 2 && words.size() != 3)
                lines.fail(fmt::format(
                    "expected a,b or frame,a,b, or a header that names more columns, found {} columns", words.size()));
            try {
                columns = has_names ? columns_of_header(words) : columns_by_place(words.size());
            } catch (const aabb::input_error& error) {
                lines.fail(error.what());
            }
            list.has_frames = columns->frame.has_value();
            if (has_names) continue;
        }
        if (words.size() < columns->count)
            lines.fail(fmt::format("expected {} columns, found {}", columns->count, words.size()));
        const auto id = [&](std::size_t column) {
            const std::optional<std::uint32_t> value = id_of(words[column]);
            if (!value) lines.fail(fmt::format("expected an integer, found '{}'", words[column]));
            return *value;
        };
        list.rows.push_back({columns->frame ? id(*columns->frame) : 0, {id(columns->a), id(columns->b)}});
    }
    // A file without rows is a list without pairs, of any frame.
    if (!columns) list.has_frames = true;
    return list;
}

pair_list read_array(const std::filesystem::path& file) {
    const number_array<std::int64_t> array = read_npy_integers(file);
    if (array.shape.size() != 2 || (array.shape[1] != 2 && array.shape[1] != 3))
        throw aabb::input_error(file.string() + ": expected an array of two or three columns, a, b or frame, a, b");
    const list_columns columns = columns_by_place(array.shape[1]);
    const auto id = [&](std::size_t row, std::size_t column) {
        const std::int64_t value = array.values[row * columns.count + column];
        return value >= 0 && value < beyond_all ? static_cast<std::uint32_t>(value) : beyond_all;
    };
    pair_list list{.rows = {}, .has_frames = columns.frame.has_value()};
    list.rows.reserve(array.shape[0]);
    for (std::size_t row = 0; row < array.shape[0]; ++row)
        list.rows.push_back({columns.frame ? id(row, *columns.frame) : 0, {id(row, columns.a), id(row, columns.b)}});
    return list;
}

}  // namespace

pair_list read_pair_list(const std::filesystem::path& file) {
    return file.extension() == ".npy" ? read_array(file) : read_text(file);
}

}  // namespace aabblab
