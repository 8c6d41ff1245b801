module;
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.tables;

import aabblab.results;

namespace aabblab {

namespace {

std::vector<std::string> header_of(const table& t) {
    std::vector<std::string> names;
    for (const column& c : t.columns) names.push_back(c.name);
    return names;
}

std::string escaped(std::string_view text, const std::vector<std::pair<char, std::string_view>>& rules) {
    std::string result;
    for (const char c : text) {
        const auto rule = std::ranges::find(rules, c, &std::pair<char, std::string_view>::first);
        if (rule == rules.end())
            result += c;
        else
            result += rule->second;
    }
    return result;
}

}  // namespace

std::size_t text_width(std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string to_text(const table& t) {
    std::vector<std::size_t> widths;
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        widths.push_back(text_width(t.columns[k].name));
        for (const auto& cells : t.rows) widths[k] = std::max(widths[k], text_width(cells[k]));
    }
    std::string text;
    const auto add = [&](const std::vector<std::string>& cells) {
        std::string line;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::string space(widths[k] - text_width(cells[k]), ' ');
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
        for (const std::string& cell : cells) text += " " + escaped(cell, {{'|', "\\|"}}) + " |";
        text += "\n";
    };
    add(header_of(t));
    text += "|";
    for (const column& c : t.columns) text += c.is_number ? "---:|" : "---|";
    text += "\n";
    for (const auto& cells : t.rows) add(cells);
    return text;
}

std::string tex_text(std::string_view text) {
    return escaped(text, {{'\\', "\\textbackslash{}"},
                          {'_', "\\_"},
                          {'%', "\\%"},
                          {'&', "\\&"},
                          {'#', "\\#"},
                          {'$', "\\$"},
                          {'{', "\\{"},
                          {'}', "\\}"},
                          {'~', "\\textasciitilde{}"},
                          {'^', "\\textasciicircum{}"}});
}

std::string html_text(std::string_view text) {
    return escaped(text, {{'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}});
}

std::string to_tex(const table& t) {
    std::string text = "\\begin{tabular}{";
    for (const column& c : t.columns) text += c.is_number ? 'r' : 'l';
    text += "}\n\\hline\n";
    const auto add = [&](const std::vector<std::string>& cells) {
        for (const std::string& cell : cells) text += (&cell == cells.data() ? "" : " & ") + tex_text(cell);
        text += " \\\\\n";
    };
    add(header_of(t));
    text += "\\hline\n";
    for (const auto& cells : t.rows) add(cells);
    return text + "\\hline\n\\end{tabular}\n";
}

std::string to_html(const table& t) {
    std::string text = "<table>\n";
    const auto add = [&](const std::vector<std::string>& cells, const std::string& tag) {
        text += "<tr>";
        for (std::size_t k = 0; k < cells.size(); ++k)
            text += "<" + tag + (t.columns[k].is_number ? " class=\"number\">" : ">") + html_text(cells[k]) + "</" +
                    tag + ">";
        text += "</tr>\n";
    };
    add(header_of(t), "th");
    for (const auto& cells : t.rows) add(cells, "td");
    return text + "</table>\n";
}

}  // namespace aabblab
