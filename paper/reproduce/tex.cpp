module;
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

module aabblab.reproduction;

import aabblab.tables;

namespace aabblab {

namespace {

/// Longer texts stand in columns that break lines.
constexpr std::size_t longest_unbroken = 16;
/// Of the width, for all columns that do; numbers need the rest.
constexpr double share_of_text = 0.7;

std::size_t longest_cell(const table& t, std::size_t column) {
    std::size_t longest = 0;
    for (const std::vector<std::string>& cells : t.rows) longest = std::max(longest, cells[column].size());
    return longest;
}

/// `P{share}` is a column type of paper/tex/layout.tex.
std::string columns_of(const table& t) {
    double all = 0;
    const auto weight = [&](std::size_t k) {
        const std::size_t longest = longest_cell(t, k);
        // Neither so narrow that a word does not fit, nor so wide that the others are.
        return longest > longest_unbroken ? std::sqrt(static_cast<double>(std::clamp<std::size_t>(longest, 80, 300)))
                                          : 0;
    };
    for (std::size_t k = 0; k < t.columns.size(); ++k) all += weight(k);
    std::string spec;
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        if (t.columns[k].is_number)
            spec += 'r';
        else
            spec += weight(k) > 0 ? fmt::format("P{{{:.3f}}}", share_of_text * weight(k) / all) : "l";
    }
    return spec;
}

}  // namespace

std::string paper_table(const table& t) {
    const auto line = [](const std::vector<std::string>& cells) {
        std::string text;
        for (const std::string& cell : cells) text += (&cell == cells.data() ? "" : " & ") + tex_text(cell);
        return text + " \\\\\n";
    };
    std::vector<std::string> head;
    for (const column& c : t.columns) head.push_back(c.name);
    std::string text = "\\begin{tabular}{" + columns_of(t) + "}\n\\toprule\n" + line(head) + "\\midrule\n";
    for (const std::vector<std::string>& cells : t.rows) text += line(cells);
    return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace aabblab
