module aabblab.tables;

import aabblab.text;

namespace aabblab {

namespace {

std::vector<std::string> header_of(const table& t) {
    std::vector<std::string> names;
    for (const column& c : t.columns) names.push_back(c.name);
    return names;
}

constexpr std::size_t gap = 2;  // between columns

bool has_numbered_rows(const table& t) {
    return !t.columns.empty() && t.columns[0].name == row_number;
}

/// The number of columns before the first value: the row number and the names.
std::size_t name_count(const table& t) {
    const auto names = t.columns.begin() + (has_numbered_rows(t) ? 1 : 0);
    return static_cast<std::size_t>(std::ranges::find(names, t.columns.end(), true, &column::is_number) -
                                    t.columns.begin());
}

std::size_t width_of(const table& t, std::size_t k) {
    std::size_t width = characters(t.columns[k].name);
    for (const auto& cells : t.rows) width = std::max(width, characters(cells[k]));
    return width;
}

/// The width of the columns [begin, end), with gaps between them.
std::size_t width_of(const table& t, std::size_t begin, std::size_t end) {
    std::size_t width = 0;
    for (std::size_t k = begin; k < end; ++k) width += width_of(t, k) + (k > begin ? gap : 0);
    return width;
}

bool fits(const table& t, std::size_t width) {
    return width_of(t, 0, t.columns.size()) <= width;
}

void remove_columns(table& t, std::size_t begin, std::size_t end) {
    const auto remove = [&](auto& list) {
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(begin), list.begin() + static_cast<std::ptrdiff_t>(end));
    };
    remove(t.columns);
    for (auto& cells : t.rows) remove(cells);
}

/// Removes columns, the greatest `spare` first, until the table fits or only those of `spare` 0 are left.
/// @returns a line that lists them
std::string leave_out_spare_columns(table& t, std::size_t width) {
    std::string names;
    while (!fits(t, width)) {
        const auto spare = std::ranges::max_element(t.columns, {}, &column::spare);
        if (spare == t.columns.end() || spare->spare == 0) break;
        names += (names.empty() ? "" : ", ") + spare->name;
        const auto k = static_cast<std::size_t>(spare - t.columns.begin());
        remove_columns(t, k, k + 1);
    }
    return names.empty() ? "" : "left out to fit the width: " + names + "\n";
}

/// "a + b + c" after the number of a row, in lines of at most `width` characters unless a single part is longer.
std::string legend_of(const std::string& number, const std::vector<std::string>& parts, std::size_t width) {
    std::string text;
    std::string line = number + std::string(gap, ' ');
    const std::string indent(line.size(), ' ');
    bool begins_line = true;
    for (const std::string& part : parts) {
        if (part.empty()) continue;
        if (!begins_line) line += " +";
        if (!begins_line && characters(line) + 1 + characters(part) > width - gap) {
            text += std::exchange(line, indent) + "\n";
            begins_line = true;
        }
        line += (begins_line ? "" : " ") + part;
        begins_line = false;
    }
    return text + line + "\n";
}

/// Replaces the first columns, which name the rows, by one of numbers, and returns a legend.
std::string replace_names_by_numbers(table& t, std::size_t width) {
    const bool had_numbers = has_numbered_rows(t);
    if (!had_numbers) {
        t.columns.insert(t.columns.begin(), {row_number});
        std::size_t row = 0;
        for (auto& cells : t.rows) cells.insert(cells.begin(), std::to_string(++row));
    }
    const std::size_t names = name_count(t);  // columns before the first value
    const auto numbered = [&](const std::string& number, const std::vector<std::string>& cells) {
        return legend_of(std::string(width_of(t, 0) - number.size(), ' ') + number,
                         {cells.begin() + 1, cells.begin() + static_cast<std::ptrdiff_t>(names)}, width);
    };
    // The heading names what the numbers stand for; tables with numbers of their own name it elsewhere.
    std::string legend = had_numbers ? "" : numbered(row_number, header_of(t));
    for (const auto& cells : t.rows) legend += numbered(cells[0], cells);
    remove_columns(t, 1, names);
    return legend;
}

/// The names of the rows with the columns [begin, end).
table block_of(table t, std::size_t names, std::size_t begin, std::size_t end) {
    remove_columns(t, end, t.columns.size());
    remove_columns(t, names, begin);
    return t;
}

}  // namespace

table empty_table(std::initializer_list<const char*> words, std::initializer_list<const char*> numbers,
                  std::initializer_list<const char*> more_words) {
    table t;
    for (const char* name : words) t.columns.push_back({name, false});
    for (const char* name : numbers) t.columns.push_back({name});
    for (const char* name : more_words) t.columns.push_back({name, false});
    return t;
}

/// Aligns the columns with spaces: numbers to the right, names to the left.
std::string to_text(const table& t) {
    std::vector<std::size_t> widths;
    for (std::size_t k = 0; k < t.columns.size(); ++k) widths.push_back(width_of(t, k));
    std::string text;
    const auto add = [&](const std::vector<std::string>& cells) {
        std::string line;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::string space(widths[k] - characters(cells[k]), ' ');
            line += (k ? "  " : "") + (t.columns[k].is_number ? space + cells[k] : cells[k] + space);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    };
    add(header_of(t));
    for (const auto& cells : t.rows) add(cells);
    return text;
}

std::string to_csv(const table& t) {
    std::string text = csv_line(header_of(t));
    for (const auto& cells : t.rows) text += csv_line(cells);
    return text;
}

/// A table in the syntax of GitHub; `---:` aligns a column of numbers to the right.
std::string to_markdown(const table& t) {
    std::string text;
    const auto add = [&](const std::vector<std::string>& cells) {
        text += "|";
        for (const std::string& cell : cells) {
            text += ' ';
            for (const char c : cell) text += c == '|' ? "\\|" : std::string(1, c);
            text += " |";
        }
        text += "\n";
    };
    add(header_of(t));
    text += "|";
    for (const column& c : t.columns) text += c.is_number ? "---:|" : "---|";
    text += "\n";
    for (const auto& cells : t.rows) add(cells);
    return text;
}

/// A table for terminals. If it is too wide, it loses spare columns, then long names become numbers with a legend, and
/// the columns that remain are split into blocks, each with the names of the rows.
std::string to_text(table t, std::size_t width) {
    if (name_count(t) == t.columns.size()) return to_text(t);
    table fewer = t;
    std::string left_out = leave_out_spare_columns(fewer, width);
    // Names up to half of the width stay; longer ones would take too much room in every block.
    const bool long_names = !fits(fewer, width) && width_of(t, 0, name_count(t)) > width / 2;
    const std::string legend = long_names ? replace_names_by_numbers(t, width) : "";
    if (long_names)
        left_out = leave_out_spare_columns(t, width);
    else
        t = std::move(fewer);
    const std::size_t names = name_count(t);                                        // columns
    const std::size_t room = width - std::min(width, width_of(t, 0, names) + gap);  // for values
    std::string text;
    for (std::size_t begin = names; begin < t.columns.size();) {
        std::size_t end = begin + 1;
        while (end < t.columns.size() && width_of(t, begin, end + 1) <= room) ++end;
        text += (text.empty() ? "" : "\n") + to_text(block_of(t, names, begin, end));
        begin = end;
    }
    return text + (legend.empty() ? "" : "\n") + legend + left_out;
}

}  // namespace aabblab
