module aabblab.checking;

import aabb.base;
import aabblab.files;
import aabblab.fmt;
import aabblab.json;

namespace aabblab {

namespace {

/// What the rows of a list may have.
struct list_form {
    std::size_t ids;       ///< of a row
    bool may_have_frames;  ///< before them
    std::string_view expected;
    std::span<const std::string_view> names;  ///< of the ids of a row, then others that are usual, and so on
};

constexpr std::array<std::string_view, 16> names_of_pairs{
    "a",          "b",          "i",     "j",      "id_a", "id_b", "object_a", "object_b",
    "triangle_a", "triangle_b", "first", "second", "id1",  "id2",  "i1",       "i2"};
constexpr std::array<std::string_view, 4> names_of_contacts{"object_a", "object_b", "triangle_a", "triangle_b"};

list_form form_of_pairs(bool may_have_frames) {
    return {.ids = 2,
            .may_have_frames = may_have_frames,
            .expected = may_have_frames ? "a,b or frame,a,b" : "a,b",
            .names = names_of_pairs};
}

constexpr std::string_view columns_of_contacts = "object_a,object_b,triangle_a,triangle_b, perhaps after frame";
list_form form_of_contacts() {
    return {.ids = 4, .may_have_frames = true, .expected = columns_of_contacts, .names = names_of_contacts};
}

/// The places of frame and ids among the columns; without frames, that of the frame is empty.
struct list_columns {
    std::optional<std::size_t> frame = {};
    std::vector<std::size_t> ids = {};
    std::size_t count = 0;
};

/// The columns of rows without a header; empty if rows have another number of them.
std::optional<list_columns> columns_by_place(std::size_t count, const list_form& form) {
    if (count != form.ids && count != form.ids + 1) return std::nullopt;
    list_columns columns{.count = count};
    if (form.may_have_frames && count > form.ids) columns.frame = 0;
    for (std::size_t i = 0; i < form.ids; ++i) columns.ids.push_back(columns.frame ? i + 1 : i);
    return columns;
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

std::uint32_t id_of(std::int64_t number) {
    if (number == -1) return beyond_all;
    return number >= 0 && number < beyond_all ? static_cast<std::uint32_t>(number) : beyond_all - 1;
}

/// Empty if the number is no integer.
std::optional<std::uint32_t> id_of(double number) {
    if (number != std::floor(number)) return std::nullopt;
    if (number == -1) return beyond_all;
    return number >= 0 && number < beyond_all ? static_cast<std::uint32_t>(number) : beyond_all - 1;
}

/// The integer of a word, which may be written as a floating-point number; empty if it is none.
std::optional<std::uint32_t> id_of(std::string_view word) {
    const char* const last = word.data() + word.size();
    const auto parsed = [&word, last](auto number) -> std::optional<decltype(number)> {
        const auto [end, error] = std::from_chars(word.begin(), last, number);
        if (end != last || error == std::errc::invalid_argument) return std::nullopt;
        return error == std::errc{} ? number : std::numeric_limits<decltype(number)>::max();
    };
    if (const auto id = parsed(std::int64_t{0})) return id_of(*id);
    const auto number = parsed(0.0);
    return number ? id_of(*number) : std::nullopt;
}

/// Whether the words are names: a line with any number is no header.
bool is_header(std::span<const std::string_view> words) {
    return std::ranges::none_of(words, [](std::string_view word) {
        double number = 0;
        return std::from_chars(word.begin(), word.end(), number).ec == std::errc{};
    });
}

/// The columns that a header names, by any of the names that are usual for frames and ids.
/// @throws aabb::input_error without file and line
template <class Names>
list_columns columns_of_header(const Names& names, const list_form& form) {
    constexpr std::array<std::string_view, 6> frames{"frame", "step", "pose", "time_step", "timestep", "t"};
    std::vector<std::string> lower;
    for (const auto& name : names) {
        lower.emplace_back(name);
        for (char& c : lower.back()) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    const auto place_of = [&](std::string_view name) -> std::optional<std::size_t> {
        const auto column = std::ranges::find(lower, name);
        if (column == lower.end()) return std::nullopt;
        return static_cast<std::size_t>(column - lower.begin());
    };
    list_columns columns{.count = lower.size()};
    for (const std::string_view name : frames)
        if (!columns.frame && form.may_have_frames) columns.frame = place_of(name);
    for (std::span<const std::string_view> ids = form.names; !ids.empty(); ids = ids.subspan(form.ids)) {
        columns.ids.clear();
        for (const std::string_view name : ids.first(form.ids))
            if (const auto place = place_of(name)) columns.ids.push_back(*place);
        if (columns.ids.size() == form.ids) return columns;
    }
    throw aabb::input_error(form.ids == 2 ? "the header names no columns a and b, such as frame,a,b or i,j"
                                          : "the header names no columns " + std::string(columns_of_contacts));
}

/// Receives a row: the frame, or 0, and the ids.
using row_receiver = std::function<void(std::uint32_t frame, std::span<const std::uint32_t> ids)>;

/// Reads a list as text, line by line.
/// @returns whether it has frames; a file without rows is a list without pairs, of any frame.
bool read_text(const std::filesystem::path& file, const list_form& form, const row_receiver& take) {
    std::optional<list_columns> columns;
    std::vector<std::string_view> words;
    std::vector<std::uint32_t> ids(form.ids);
    for (line_stream lines(file); lines.next();) {
        split(without_comment(lines.line()), words);
        if (words.empty()) continue;
        if (!columns) {
            const bool has_names = is_header(words);
            try {
                columns = has_names ? columns_of_header(words, form) : columns_by_place(words.size(), form);
            } catch (const aabb::input_error& error) {
                lines.fail(error.what());
            }
            if (!columns)
                lines.fail(fmt::format("expected {}, or a header that names more columns, found {} columns",
                                       form.expected, words.size()));
            if (has_names) continue;
        }
        if (words.size() < columns->count)
            lines.fail(fmt::format("expected {} columns, found {}", columns->count, words.size()));
        const auto id = [&](std::size_t column) {
            const std::optional<std::uint32_t> value = id_of(words[column]);
            if (!value) lines.fail(fmt::format("expected an integer, found '{}'", words[column]));
            return *value;
        };
        for (std::size_t i = 0; i < form.ids; ++i) ids[i] = id(columns->ids[i]);
        take(columns->frame ? id(*columns->frame) : 0, ids);
    }
    return !columns || columns->frame;
}

bool read_array(const std::filesystem::path& file, const list_form& form, const row_receiver& take) {
    const number_array<std::int64_t> array = read_npy_integers(file);
    std::optional<list_columns> columns;
    if (array.shape.size() == 2) columns = columns_by_place(array.shape[1], form);
    if (!columns)
        throw aabb::input_error(fmt::format("{}: expected an array with the columns {}", file.string(), form.expected));
    const auto id = [&](std::size_t row, std::size_t column) {
        return id_of(array.values[row * columns->count + column]);
    };
    std::vector<std::uint32_t> ids(form.ids);
    for (std::size_t row = 0; row < array.shape[0]; ++row) {
        for (std::size_t i = 0; i < form.ids; ++i) ids[i] = id(row, columns->ids[i]);
        take(columns->frame ? id(row, *columns->frame) : 0, ids);
    }
    return columns->frame.has_value();
}

/// Reads an object with columns and rows, as commands write it.
bool read_json(const std::filesystem::path& file, const list_form& form, const row_receiver& take) {
    const json_value document(file.string(), text_of_file(file), "is not a list of pairs");
    list_columns columns;
    try {
        columns = columns_of_header(document.needed("columns").texts(), form);
    } catch (const aabb::input_error& error) {
        const std::string message = error.what();
        throw aabb::input_error(message.starts_with(file.string()) ? message : file.string() + ": " + message);
    }
    std::vector<std::uint32_t> ids(form.ids);
    for (const json_value& row : document.needed("rows").list()) {
        const std::vector<json_value> cells = row.list();
        if (cells.size() < columns.count) row.fail(fmt::format("must have {} columns", columns.count));
        const auto id = [&](std::size_t column) {
            const std::optional<std::uint32_t> value = id_of(cells[column].number());
            if (!value) cells[column].fail("must be an integer");
            return *value;
        };
        for (std::size_t i = 0; i < form.ids; ++i) ids[i] = id(columns.ids[i]);
        take(columns.frame ? id(*columns.frame) : 0, ids);
    }
    return columns.frame.has_value();
}

bool read_rows(const std::filesystem::path& file, const list_form& form, const row_receiver& take) {
    return file.extension() == ".npy"    ? read_array(file, form, take)
           : file.extension() == ".json" ? read_json(file, form, take)
                                         : read_text(file, form, take);
}

}  // namespace

pair_list read_pair_list(const std::filesystem::path& file, bool may_have_frames) {
    pair_list list{.rows = {}, .is_by_frame = true};
    list.has_frames =
        read_rows(file, form_of_pairs(may_have_frames), [&](std::uint32_t frame, std::span<const std::uint32_t> ids) {
            list.is_by_frame = list.is_by_frame && (list.rows.empty() || list.rows.back().frame <= frame);
            list.rows.push_back({frame, {ids[0], ids[1]}});
        });
    return list;
}

contact_list read_contact_list(const std::filesystem::path& file) {
    contact_list list;
    list.has_frames = read_rows(file, form_of_contacts(), [&](std::uint32_t frame, std::span<const std::uint32_t> ids) {
        list.rows.push_back({frame, {.a = ids[0], .b = ids[1], .triangle_a = ids[2], .triangle_b = ids[3]}});
    });
    return list;
}

}  // namespace aabblab
