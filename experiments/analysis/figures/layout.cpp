module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

module aabblab.figures;

import :layout;
import :text;

namespace aabblab {

namespace {

// In ems.
constexpr double figure_width = 38;  // a column of 12 cm in 9 points
constexpr double plot_height = 17;
constexpr double character = 0.6;  // the widest usual sans, and what gnuplot assumes for SVG
constexpr double line_height = 1.25;
constexpr double tick_room = 0.9;  // of a tick and the gap to its label
constexpr double sample = 6;       // of a line in the legend, with the gaps about it
constexpr double gap = 0.6;

// In characters, at which labels are broken into lines.
constexpr std::size_t x_label_length = 58;
constexpr std::size_t y_label_length = 36;

[[nodiscard]] double width_of(const std::vector<std::string>& lines) {
    std::size_t longest = 0;
    for (const std::string& line : lines) longest = std::max(longest, characters(line));
    return character * static_cast<double>(longest);
}

[[nodiscard]] double width_of(const std::string& line) {
    return character * static_cast<double>(characters(line));
}

[[nodiscard]] double height_of(const std::vector<std::string>& lines) {
    return line_height * static_cast<double>(lines.size());
}

/// The margin at the left, and for many names on the y axis the height of the plot.
void place_left(const contents& parts, layout& to) {
    double widest = 0;
    double highest = 0;
    for (const auto& [place, text] : parts.y_ticks) {
        const std::vector<std::string> lines = lines_of(text, parts.y_named ? y_name_length : text.size());
        widest = std::max(widest, width_of(lines));
        highest = std::max(highest, height_of(lines));
    }
    to.left = gap / 2;
    for (const std::string& line : lines_of(parts.y_label, y_label_length)) {
        to.y_label.push_back({line, to.left + line_height / 2});
        to.left += line_height;
    }
    to.left += gap + widest + tick_room;
    to.height = plot_height;
    if (parts.y_named) to.height = std::max(to.height, (highest + gap) * static_cast<double>(parts.y_ticks.size()));
}

/// The ticks of the x axis: their height, and the right margin, which the last one may hang over.
[[nodiscard]] double place_x_ticks(const contents& parts, layout& to) {
    to.right = 1.5;
    to.x_name_length = x_label_length;
    if (parts.x_ticks.empty()) return 0;
    double nearest = 1;
    for (std::size_t i = 1; i < parts.x_ticks.size(); ++i)
        nearest = std::min(nearest, parts.x_ticks[i].first - parts.x_ticks[i - 1].first);
    const double plot = figure_width - to.left - to.right;
    const double slot = plot * nearest - gap;
    to.x_name_length = parts.x_named ? static_cast<std::size_t>(std::max(slot / character, 1.)) : to.x_name_length;
    double widest = 0;
    double highest = 0;
    for (const auto& [place, text] : parts.x_ticks) {
        const std::vector<std::string> lines = lines_of(text, to.x_name_length);
        widest = std::max(widest, width_of(lines));
        highest = std::max(highest, height_of(lines));
    }
    if (!parts.x_named || (widest <= slot && highest <= 3 * line_height)) {
        const auto& [place, text] = parts.x_ticks.back();
        const double half = width_of(lines_of(text, to.x_name_length)) / 2;
        to.right = std::max(to.right, half - (1 - place) * plot + gap / 2);
        return highest;
    }
    // Slanted, each ends at its tick; upright where that puts one line upon the next or makes the plot narrow.
    constexpr double slant = 30 * 3.14159265358979 / 180;
    constexpr double widest_margin = 16;
    to.x_name_length = x_label_length;
    double left = to.left;
    double longest = 0;
    for (const auto& [place, text] : parts.x_ticks) {
        longest = std::max(longest, width_of(text));
        left = std::max(left, width_of(text) * std::cos(slant) - place * plot + gap);
    }
    if (slot * std::sin(slant) >= 0.8 && left <= widest_margin) {
        to.x_name_angle = 30;
        to.left = left;
        return longest * std::sin(slant) + 0.5;
    }
    to.x_name_angle = 90;
    return longest;
}

/// The height of the legend, column by column below all else.
[[nodiscard]] double place_legend(const contents& parts, layout& to) {
    const auto most = static_cast<std::size_t>((figure_width - sample - gap) / character);
    std::size_t entries = 0;
    std::size_t lines = 0;
    double widest = 0;
    for (const std::string& label : parts.legend) {
        to.legend.push_back(lines_of(with_breaks(label, most), most));
        lines += to.legend.back().size();
        if (!to.legend.back().empty()) ++entries;
        widest = std::max(widest, width_of(to.legend.back()));
    }
    if (entries == 0) return 0;
    const double column = sample + widest;
    auto columns = std::max<std::size_t>(1, static_cast<std::size_t>((figure_width - gap) / column));
    // Lines of one label must stay below each other.
    if (lines > entries) columns = 1;
    to.legend_rows = (lines + columns - 1) / columns;
    columns = (lines + to.legend_rows - 1) / to.legend_rows;
    to.legend_left = std::clamp(figure_width - column * static_cast<double>(columns), gap, std::max(gap, to.left));
    to.legend_bottom = gap / 2;
    return layout::legend_row * static_cast<double>(to.legend_rows) + gap;
}

/// The height of the marks' texts above the plot. Each text stands beside its line like a flag, so high that no other
/// line runs through it.
[[nodiscard]] double place_marks(const contents& parts, layout& to) {
    struct flag {
        double at;
        double begin;
        double end;
        std::size_t row = 0;
    };
    std::vector<flag> flags;
    for (const auto& [place, text] : parts.marks) {
        const double at = to.left + place * (figure_width - to.left - to.right);
        const double width = width_of(text) + gap;
        const bool right = at + width <= figure_width;
        flags.push_back({at, right ? at : at - width, right ? at + width : at});
        to.marks.push_back({0, right});
    }
    const auto crosses = [](const flag& line, const flag& text) { return text.begin < line.at && line.at < text.end; };
    // Each round settles one row at least, but for texts that each have the line of the other in them.
    for (std::size_t round = 0; round < flags.size(); ++round)
        for (flag& a : flags)
            for (flag& b : flags) {
                if (&a == &b) continue;
                const bool must_be_above = crosses(b, a) && (!crosses(a, b) || &a < &b);
                const bool meet = &a < &b && a.begin < b.end && b.begin < a.end;
                if (must_be_above && a.row <= b.row)
                    a.row = b.row + 1;
                else if (meet && a.row == b.row)
                    ++b.row;
            }
    std::size_t rows = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        to.marks[i].above = line_height * (static_cast<double>(flags[i].row) + 0.5);
        rows = std::max(rows, flags[i].row + 1);
    }
    return line_height * static_cast<double>(rows);
}

}  // namespace

layout layout_of(const contents& parts) {
    layout to{};
    to.width = figure_width;
    place_left(parts, to);
    const double x_ticks = place_x_ticks(parts, to);
    to.bottom = place_legend(parts, to) + gap / 2;
    std::vector<std::string> x_label = lines_of(parts.x_label, x_label_length);
    for (const std::string& line : x_label | std::views::reverse) {
        to.x_label.push_back({line, to.bottom + line_height / 2});
        to.bottom += line_height;
    }
    to.bottom += gap / 2 + x_ticks + tick_room;
    to.top = 1 + place_marks(parts, to);
    to.height += to.top + to.bottom;
    return to;
}

}  // namespace aabblab
