module;
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

module aabblab.reproduction;

import aabblab.tables;

namespace aabblab {

namespace {

/// Longer texts stand in columns that break lines.
constexpr std::size_t longest_unbroken = 20;
/// Of the width, for all columns that do; numbers need the rest.
constexpr double share_of_text = 0.7;
/// What a letter takes of the width of a page, in small print.
constexpr double share_of_letter = 0.0095;

std::size_t longest_cell(const table& t, std::size_t column) {
    std::size_t longest = 0;
    for (const std::vector<std::string>& cells : t.rows) longest = std::max(longest, cells[column].size());
    return longest;
}

/// `P{share}` is a column type of paper/tex/layout.tex.
std::string columns_of(const table& t) {
    double all = 0;
    double letters = 0;
    const auto weight = [&](std::size_t k) {
        const std::size_t longest = longest_cell(t, k);
        if (t.columns[k].is_number || longest <= longest_unbroken) return 0.0;
        // Neither so narrow that a word does not fit, nor so wide that the others are.
        return std::sqrt(static_cast<double>(std::clamp<std::size_t>(longest, 80, 300)));
    };
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        all += weight(k);
        if (weight(k) > 0) letters += static_cast<double>(longest_cell(t, k));
    }
    const double share = std::min(share_of_text, share_of_letter * letters);
    std::string spec;
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        if (t.columns[k].is_number)
            spec += 'r';
        else
            spec += weight(k) > 0 ? fmt::format("P{{{:.3f}}}", share * weight(k) / all) : "l";
    }
    return spec;
}

/// A head in lines, so that no column of numbers is wider than its numbers need.
std::string head_of(const column& c) {
    constexpr std::size_t longest_line = 14;
    std::vector<std::string> lines;
    std::istringstream words(c.name);
    for (std::string word; words >> word;)
        if (!lines.empty() && lines.back().size() + 1 + word.size() <= longest_line)
            lines.back() += " " + word;
        else
            lines.push_back(word);
    if (lines.size() < 2) return tex_text(c.name);
    std::string text = c.is_number ? "\\shortstack[r]{" : "\\shortstack[l]{";
    for (const std::string& line : lines) text += (&line == lines.data() ? "" : "\\\\") + tex_text(line);
    return text + "}";
}

}  // namespace

std::string paper_table(const table& t) {
    const auto line = [](const std::vector<std::string>& cells) {
        std::string text;
        for (const std::string& cell : cells) text += (&cell == cells.data() ? "" : " & ") + tex_text(cell);
        return text + " \\\\\n";
    };
    std::string head;
    for (const column& c : t.columns) head += (&c == t.columns.data() ? "" : " & ") + head_of(c);
    std::string text = "\\begin{tabular}{" + columns_of(t) + "}\n\\toprule\n" + head + " \\\\\n\\midrule\n";
    for (const std::vector<std::string>& cells : t.rows) text += line(cells);
    return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace aabblab
