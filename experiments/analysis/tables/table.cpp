module aabblab.tables;

import aabblab.text;

namespace aabblab {

namespace {

std::vector<std::string> header_of(const table& t) {
    std::vector<std::string> names;
    for (const column& c : t.columns) names.push_back(c.name);
    return names;
}

}  // namespace

std::string to_text(const table& t) {
    std::vector<std::size_t> widths;
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        widths.push_back(characters(t.columns[k].name));
        for (const auto& cells : t.rows) widths[k] = std::max(widths[k], characters(cells[k]));
    }
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

}  // namespace aabblab
