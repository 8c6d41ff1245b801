module aabblab.filters;

import aabb.policy;
import aabblab.files;
import aabblab.fmt;

namespace aabblab {

namespace {

/// The cells of a line, without blanks around them.
std::vector<std::string_view> cells_of(std::string_view line) {
    constexpr std::string_view blanks = " \t";
    std::vector<std::string_view> cells;
    for (std::size_t from = 0; from <= line.size();) {
        const std::size_t to = std::min(line.find(',', from), line.size());
        std::string_view cell = line.substr(from, to - from);
        cell.remove_prefix(std::min(cell.find_first_not_of(blanks), cell.size()));
        cells.push_back(cell.substr(0, cell.find_last_not_of(blanks) + 1));
        from = to + 1;
    }
    return cells;
}

/// A CSV file whose header names some of the known columns in any order. Empty lines are skipped.
class named_columns {
public:
    /// Opens the file and reads its header.
    /// @param known the columns that it may have
    /// @param required those that it must have, the first ones of `known`
    named_columns(const std::filesystem::path& file, const std::vector<std::string>& known, std::size_t required)
        : lines_(file) {
        if (!next_line())
            throw aabb::input_error(
                fmt::format("{}: is empty; expected the header {}", file.string(), fmt::join(known, ",")));
        if (is_number(cells_[0]))
            fail(fmt::format("there is no header; expected {} before the first row", fmt::join(known, ",")));
        for (const std::string_view cell : cells_) {
            if (std::ranges::find(known, cell) == known.end()) fail(aabb::unknown_name("column", cell, known));
            if (std::ranges::find(columns_, cell) != columns_.end())
                fail(fmt::format("the header has the column {} twice", cell));
            columns_.emplace_back(cell);
        }
        for (std::size_t column = 0; column < required; ++column)
            if (std::ranges::find(columns_, known[column]) == columns_.end())
                fail(fmt::format("the header lacks the column {}; expected {}", known[column], fmt::join(known, ",")));
    }

    /// Advances to the next row; false after the last.
    bool next() {
        if (!next_line()) return false;
        if (cells_.size() != columns_.size())
            fail(fmt::format("expected {} values, {}, found {}", columns_.size(), fmt::join(columns_, ","),
                             cells_.size()));
        return true;
    }

    /// The cell in a column; empty if the file lacks the column.
    [[nodiscard]] std::string_view cell(std::string_view column) const {
        const auto at = std::ranges::find(columns_, column);
        return at == columns_.end() ? std::string_view() : cells_[static_cast<std::size_t>(at - columns_.begin())];
    }

    /// The number of an object of the scene.
    [[nodiscard]] std::uint32_t object(std::string_view column, std::size_t objects) const {
        const std::optional<std::uint32_t> id = parsed(cell(column), 10);
        if (!id || *id >= objects)
            fail_at(column, fmt::format("the number of an object, below {}, as the scene has {}", objects, objects));
        return *id;
    }

    /// 32 bits, as a decimal or hexadecimal number, with a sign where an engine has signed masks: -1 is all of them.
    /// `otherwise` if the cell is empty.
    [[nodiscard]] std::uint32_t bits(std::string_view column, std::uint32_t otherwise) const {
        const std::string_view text = cell(column);
        if (text.empty()) return otherwise;
        if (std::int32_t negative = 0; text.starts_with('-')) {
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), negative);
            if (error == std::errc{} && end == text.data() + text.size()) return static_cast<std::uint32_t>(negative);
        }
        const bool is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
        const std::optional<std::uint32_t> number = is_hexadecimal ? parsed(text.substr(2), 16) : parsed(text, 10);
        if (!number) fail_at(column, "32 bits, as a number such as 5, 0x5 or -3, or -1 for all");
        return *number;
    }

    /// The index of the cell among these words, of which the first is meant by an empty cell.
    [[nodiscard]] std::size_t choice(std::string_view column, std::span<const std::string_view> words,
                                     const std::string& expected) const {
        const std::string_view text = cell(column);
        if (text.empty()) return 0;
        const auto word = std::ranges::find(words, text);
        if (word == words.end()) fail_at(column, expected);
        return static_cast<std::size_t>(word - words.begin());
    }

    [[noreturn]] void fail(const std::string& sentence) const { lines_.fail(sentence); }

private:
    [[noreturn]] void fail_at(std::string_view column, const std::string& expected) const {
        constexpr std::size_t longest_quote = 40;
        const std::string_view text = cell(column);
        fail(fmt::format("{} is '{}{}'; expected {}", column, text.substr(0, longest_quote),
                         text.size() > longest_quote ? "…" : "", expected));
    }

    [[nodiscard]] static std::optional<std::uint32_t> parsed(std::string_view text, int base) {
        std::uint32_t number = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
        return error == std::errc() && rest == text.data() + text.size() ? std::optional(number) : std::nullopt;
    }

    [[nodiscard]] static bool is_number(std::string_view text) {
        return text.find_first_not_of("+-.0123456789") == std::string_view::npos && !text.empty();
    }

    bool next_line() {
        do {
            if (!lines_.next()) return false;
            cells_ = cells_of(lines_.line());
        } while (cells_.size() == 1 && cells_[0].empty());
        return true;
    }

    line_stream lines_;
    std::vector<std::string> columns_;
    std::vector<std::string_view> cells_;  // views into the line
};

void read_groups(const std::filesystem::path& file, std::size_t objects, aabb::collision_filter& filter) {
    static constexpr std::array<std::string_view, 3> sets{"", "a", "b"};  // in the order of `object_set`
    static constexpr std::array<std::string_view, 2> rests{"0", "1"};
    named_columns rows(file, {"object", "group", "mask", "set", "rest"}, 1);
    std::vector<bool> is_listed(objects);
    const aabb::object_filter otherwise;
    while (rows.next()) {
        const std::uint32_t id = rows.object("object", objects);
        if (is_listed[id]) rows.fail(fmt::format("object {} is listed twice", id));
        is_listed[id] = true;
        filter.set(id, {.group = rows.bits("group", otherwise.group),
                        .mask = rows.bits("mask", otherwise.mask),
                        .set = static_cast<aabb::object_set>(rows.choice("set", sets, "a, b or nothing")),
                        .rests = rows.choice("rest", rests, "1 for an object at rest, else 0") == 1});
    }
}

void read_exceptions(const std::filesystem::path& file, std::size_t objects, aabb::collision_filter& filter) {
    named_columns rows(file, {"a", "b"}, 2);
    std::vector<aabb::index_pair> pairs;
    while (rows.next()) {
        const aabb::index_pair pair{rows.object("a", objects), rows.object("b", objects)};
        if (pair.a == pair.b) rows.fail(fmt::format("object {} is paired with itself", pair.a));
        pairs.push_back(pair);
    }
    filter.add_exceptions(pairs);
}

}  // namespace

std::string filter_files::text() const {
    if (groups && except) return *groups + " and " + *except;
    return groups ? *groups : except.value_or("");
}

std::shared_ptr<const aabb::collision_filter> read_filter(const filter_files& files, std::size_t objects) {
    if (!files.any()) return nullptr;
    auto filter = std::make_unique<aabb::collision_filter>();
    if (files.groups) read_groups(*files.groups, objects, *filter);
    if (files.except) read_exceptions(*files.except, objects, *filter);
    return filter;
}

std::shared_ptr<const aabb::collision_filter> filter_of(const scene_choice& scene, std::size_t objects) {
    const auto file_of = [&](std::string_view key) -> std::optional<std::string> {
        const auto setting = std::ranges::find(scene.settings, key, &aabb::setting::name);
        if (setting == scene.settings.end()) return std::nullopt;
        return resolve_file(setting->value, scene.folder).string();
    };
    return read_filter({.groups = file_of(filter_settings[0]), .except = file_of(filter_settings[1])}, objects);
}

void add_filter(const filter_files& files, scene_choice& scene) {
    if (files.groups) scene.settings.push_back({std::string(filter_settings[0]), *files.groups});
    if (files.except) scene.settings.push_back({std::string(filter_settings[1]), *files.except});
}

}  // namespace aabblab
