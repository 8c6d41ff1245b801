module aabblab.tables;

import aabblab.fmt;
import aabblab.text;

namespace aabblab {

namespace {

/// Columns with longer texts break lines.
constexpr std::size_t longest_unbroken = 20;
/// The share of the page width for all columns that break lines; numbers need the rest.
constexpr double share_of_text = 0.7;
/// The share of the page width of a letter in small print.
constexpr double share_of_letter = 0.0095;

std::size_t longest_cell(const table& t, std::size_t column) {
    std::size_t longest = 0;
    for (const std::vector<std::string>& cells : t.rows) longest = std::max(longest, cells[column].size());
    return longest;
}

/// The column types of a LaTeX tabular: `r` for numbers, `l` for short texts, and for long ones `P{w}`, which breaks
/// lines at a share w of the page width (paper/tex/layout.tex). The width of these columns together is `share`, which
/// they divide in proportion to the square roots of their longest cells: as longer cells have more lines, too.
std::string column_types_of(const table& t) {
    double sum = 0, letters = 0;
    const auto weight = [&](std::size_t k) {
        const std::size_t longest = longest_cell(t, k);
        if (t.columns[k].is_number || longest <= longest_unbroken) return 0.0;
        // Clamped so that every word fits and no column squeezes the others.
        return std::sqrt(static_cast<double>(std::clamp<std::size_t>(longest, 80, 300)));
    };
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        sum += weight(k);
        if (weight(k) > 0) letters += static_cast<double>(longest_cell(t, k));
    }
    const double share = std::min(share_of_text, share_of_letter * letters);
    std::string spec;
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        if (t.columns[k].is_number)
            spec += 'r';
        else
            spec += weight(k) > 0 ? fmt::format("P{{{:.3f}}}", share * weight(k) / sum) : "l";
    }
    return spec;
}

std::string line_of(std::vector<std::string> cells) {
    for (std::string& cell : cells) cell = tex_text(cell);
    return fmt::format("{} \\\\\n", fmt::join(cells, " & "));
}

/// Breaks a head into lines so that it does not widen a column of numbers.
std::string head_of(const column& c) {
    constexpr std::size_t longest_line = 14;
    std::vector<std::string> lines = lines_of(c.name, longest_line);
    if (lines.size() < 2) return tex_text(c.name);
    for (std::string& line : lines) line = tex_text(line);
    return fmt::format("\\shortstack[{}]{{{}}}", c.is_number ? 'r' : 'l', fmt::join(lines, "\\\\"));
}

}  // namespace

/// Escapes the special characters of LaTeX.
std::string tex_text(std::string_view text) {
    std::string safe;
    for (const char c : text) switch (c) {
            case '\\': safe += "\\textbackslash{}"; break;
            case '~': safe += "\\textasciitilde{}"; break;
            case '^': safe += "\\textasciicircum{}"; break;
            case '_':
            case '%':
            case '&':
            case '#':
            case '$':
            case '{':
            case '}': safe += '\\'; [[fallthrough]];
            default: safe += c;
        }
    return safe;
}

/// A LaTeX tabular with horizontal rules.
std::string to_tex(const table& t) {
    std::vector<std::string> heads;
    for (const column& c : t.columns) heads.push_back(head_of(c));
    std::string text = fmt::format("\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n\\midrule\n", column_types_of(t),
                                   fmt::join(heads, " & "));
    for (const std::vector<std::string>& cells : t.rows) text += line_of(cells);
    return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace aabblab
