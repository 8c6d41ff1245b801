module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
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
constexpr double figure_width = 36;  // on a phone of 400 pixels an em has ten of them
constexpr double plot_height = 17;
constexpr double panel_height = 10;
constexpr double character = 0.6;  // the widest usual sans, and what gnuplot assumes for SVG
constexpr double line_height = text_line;
constexpr double tick_room = 0.9;  // of a tick and the gap to its label
constexpr double sample = 6;       // of a line in the legend, with the gaps about it
constexpr double end_sign = 1.6;   // of the sign before a label at a line's end, with the gaps about it
constexpr double gap = 0.6;

// In characters, at which labels are broken into lines.
constexpr std::size_t longest_name = 54;
constexpr std::size_t end_label_length = 18;

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

[[nodiscard]] std::size_t length_in(double width) {
    return static_cast<std::size_t>(std::max(width / character, 1.));
}

/// The plots without what is about them: how many beside and above each other, and how large.
struct grid {
    std::size_t panels;
    std::size_t columns;
    std::size_t rows;
    double left = 0;
    double right = 1.5;
    double column_gap = 0;
    double plot_height = 0;

    [[nodiscard]] double plot_width() const {
        const auto count = static_cast<double>(columns);
        return (figure_width - left - right - column_gap * (count - 1)) / count;
    }
    [[nodiscard]] double plot_left(std::size_t panel) const {
        return left + static_cast<double>(panel % columns) * (plot_width() + column_gap);
    }
};

/// The height of the plots, which grows with the number of names on the y axis, and the margin at the left.
void place_left(const contents& parts, grid& plots, layout& to) {
    double widest = 0;
    double highest = 0;
    for (const auto& [place, text] : parts.y_ticks) {
        const std::vector<std::string> lines = lines_of(text, parts.y_named ? y_name_length : text.size());
        widest = std::max(widest, width_of(lines));
        highest = std::max(highest, height_of(lines));
    }
    plots.plot_height = plots.panels == 1 ? plot_height : panel_height;
    if (parts.y_named)
        plots.plot_height = std::max(plots.plot_height, (highest + gap) * static_cast<double>(parts.y_ticks.size()));
    plots.left = gap / 2;
    const std::size_t length = length_in(plots.plot_height * static_cast<double>(plots.rows) + 1.5);
    for (const std::string& line : lines_of(parts.y_label, length)) {
        to.y_label.push_back({line, plots.left + line_height / 2});
        plots.left += line_height;
    }
    plots.left += gap + widest + tick_room;
}

/// Leaves out numbers until none runs into the next.
void thin_x_ticks(const contents& parts, const grid& plots, layout& to) {
    const std::size_t count = parts.x_ticks.size();
    const auto fits = [&](std::size_t step) {
        for (std::size_t i = step; i < count; i += step) {
            const auto& [one, text] = parts.x_ticks[i - step];
            const auto& [next, next_text] = parts.x_ticks[i];
            if ((next - one) * plots.plot_width() < (width_of(text) + width_of(next_text)) / 2 + gap) return false;
        }
        return true;
    };
    std::size_t step = 1;
    while (step < count && !fits(step)) ++step;
    to.x_tick_shown.assign(count, false);
    for (std::size_t i = 0; i < count; i += step) to.x_tick_shown[i] = true;
}

/// The ticks of the x axis: their height, and the right margin and the gap between plots, which the outer ones may hang
/// over.
[[nodiscard]] double place_x_ticks(const contents& parts, grid& plots, layout& to) {
    to.x_name_length = longest_name;
    to.x_tick_shown.assign(parts.x_ticks.size(), true);
    if (plots.columns > 1) plots.column_gap = 1.5;
    if (parts.x_ticks.empty()) return 0;
    double nearest = 1;
    for (std::size_t i = 1; i < parts.x_ticks.size(); ++i)
        nearest = std::min(nearest, parts.x_ticks[i].first - parts.x_ticks[i - 1].first);
    const double plot = plots.plot_width();
    const double slot = plot * nearest - gap;
    if (parts.x_named) to.x_name_length = length_in(slot);
    double widest = 0;
    double highest = 0;
    for (const auto& [place, text] : parts.x_ticks) {
        const std::vector<std::string> lines = lines_of(text, to.x_name_length);
        widest = std::max(widest, width_of(lines));
        highest = std::max(highest, height_of(lines));
    }
    if (!parts.x_named || (widest <= slot && highest <= 3 * line_height)) {
        const auto& [first_place, first] = parts.x_ticks.front();
        const auto& [last_place, last] = parts.x_ticks.back();
        const double before = width_of(lines_of(first, to.x_name_length)) / 2 - first_place * plot;
        const double behind = width_of(lines_of(last, to.x_name_length)) / 2 - (1 - last_place) * plot;
        plots.right = std::max(plots.right, behind + gap / 2);
        if (plots.columns > 1)
            plots.column_gap = std::max(plots.column_gap, std::max(before, 0.) + std::max(behind, 0.) + gap);
        if (!parts.x_named) thin_x_ticks(parts, plots, to);
        return highest;
    }
    // Slanted, each ends at its tick; upright where that puts one line upon the next or makes the plot narrow.
    constexpr double slant = 30 * 3.14159265358979 / 180;
    constexpr double widest_margin = 16;
    to.x_name_length = longest_name;
    double left = plots.left;
    double longest = 0;
    for (const auto& [place, text] : parts.x_ticks) {
        longest = std::max(longest, width_of(text));
        left = std::max(left, width_of(text) * std::cos(slant) - place * plot + gap);
    }
    if (slot * std::sin(slant) >= 0.8 && left <= widest_margin) {
        to.x_name_angle = 30;
        plots.left = left;
        return longest * std::sin(slant) + 0.5;
    }
    to.x_name_angle = 90;
    return longest;
}

/// Labels at the ends of lines, if there is room for them: none may be far from its line.
/// @returns whether there are any
[[nodiscard]] bool place_ends(const contents& parts, grid& plots, layout& to) {
    constexpr double furthest = 2.2;
    struct text {
        std::size_t of;
        std::vector<std::string> lines;
        double middle;
    };
    std::vector<text> texts;
    double widest = 0;
    for (std::size_t i = 0; i < parts.ends.size(); ++i) {
        if (parts.legend[i].empty()) continue;
        texts.push_back({i, lines_of(parts.legend[i], end_label_length), parts.ends[i] * plots.plot_height});
        if (texts.back().lines.size() > 3) return false;
        widest = std::max(widest, width_of(texts.back().lines));
    }
    if (plots.panels > 1 || texts.empty() || widest > character * static_cast<double>(end_label_length)) return false;
    std::ranges::sort(texts, {}, &text::middle);
    const auto distance = [](const text& lower, const text& upper) {
        return (height_of(lower.lines) + height_of(upper.lines)) / 2;
    };
    // Those that meet share what they have to give way, again and again until none meet.
    std::vector<double> middles;
    for (const text& t : texts) middles.push_back(t.middle);
    constexpr int enough = 200;
    for (int round = 0; round < enough; ++round)
        for (std::size_t i = 1; i < texts.size(); ++i) {
            const double missing = distance(texts[i - 1], texts[i]) - (middles[i] - middles[i - 1]);
            if (missing <= 0) continue;
            middles[i - 1] -= missing / 2;
            middles[i] += missing / 2;
        }
    to.ends.resize(parts.legend.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const bool meets = i > 0 && middles[i] - middles[i - 1] < distance(texts[i - 1], texts[i]) - 0.1;
        if (meets || std::abs(middles[i] - texts[i].middle) > furthest) {
            to.ends.clear();
            return false;
        }
        to.ends[texts[i].of] = {middles[i], texts[i].lines};
    }
    plots.right = std::max(plots.right, end_sign + widest + gap / 2);
    return true;
}

/// The legend, column by column in a room so wide.
/// @returns its height
[[nodiscard]] double place_legend(const contents& parts, double width, layout& to) {
    const std::size_t most = length_in(width - sample - gap);
    std::size_t entries = 0;
    std::size_t lines = 0;
    double widest = 0;
    to.legend.clear();
    to.legend_rows = 0;
    for (const std::string& label : parts.legend) {
        to.legend.push_back(lines_of(with_breaks(label, most), most));
        lines += to.legend.back().size();
        if (!to.legend.back().empty()) ++entries;
        widest = std::max(widest, width_of(to.legend.back()));
    }
    if (entries == 0) return 0;
    const double column = sample + widest;
    auto columns = std::max<std::size_t>(1, static_cast<std::size_t>((width - gap) / column));
    // Lines of one label must stay below each other.
    if (lines > entries) columns = 1;
    to.legend_rows = (lines + columns - 1) / columns;
    columns = (lines + to.legend_rows - 1) / to.legend_rows;
    to.legend_left = std::max(gap, width - column * static_cast<double>(columns));
    return layout::legend_row * static_cast<double>(to.legend_rows) + gap;
}

/// The height of the marks' texts above a plot. Each text stands beside its line like a flag, so high that no other
/// line runs through it.
[[nodiscard]] double place_marks(const std::vector<placed_text>& marks, double left, double width,
                                 std::vector<layout::mark>& to) {
    struct flag {
        double at;
        double begin;
        double end;
        std::size_t row = 0;
    };
    std::vector<flag> flags;
    for (const auto& [place, text] : marks) {
        const double at = left + place * width;
        const double length = width_of(text) + gap;
        const bool right = at + length <= figure_width;
        flags.push_back({at, right ? at : at - length, right ? at + length : at});
        to.push_back({0, right});
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
        to[i].above = line_height * (static_cast<double>(flags[i].row) + 0.5);
        rows = std::max(rows, flags[i].row + 1);
    }
    return line_height * static_cast<double>(rows);
}

[[nodiscard]] grid grid_of(const contents& parts) {
    const std::size_t panels = std::max<std::size_t>(parts.titles.size(), 1);
    const std::size_t columns = std::min<std::size_t>(panels, 2);
    return {.panels = panels, .columns = columns, .rows = (panels + columns - 1) / columns};
}

}  // namespace

layout layout_of(const contents& parts) {
    layout to{};
    to.width = figure_width;
    grid plots = grid_of(parts);
    place_left(parts, plots, to);
    const bool with_ends = place_ends(parts, plots, to);
    const double x_ticks = place_x_ticks(parts, plots, to);
    const double below_plot = tick_room + x_ticks;

    const bool titled = std::ranges::any_of(parts.titles, [](const std::string& title) { return !title.empty(); });
    double head = titled ? line_height + gap / 2 : 0;
    double highest_marks = 0;
    to.marks.resize(plots.panels);
    for (std::size_t i = 0; i < parts.marks.size(); ++i)
        highest_marks =
            std::max(highest_marks, place_marks(parts.marks[i], plots.plot_left(i), plots.plot_width(), to.marks[i]));
    head += highest_marks;

    // The last row of panels may leave a place free, which the legend can take.
    double legend = 0;
    if (with_ends)
        to.legend.resize(parts.legend.size());
    else if (plots.panels % plots.columns != 0 &&
             place_legend(parts, plots.plot_width(), to) + below_plot <= plots.plot_height + head &&
             std::ranges::all_of(to.legend, [](const auto& lines) { return lines.size() <= 1; }))
        to.legend_left = plots.plot_left(plots.panels) + gap;
    else
        legend = place_legend(parts, figure_width, to);
    if (legend > 0) to.legend_left = std::min(to.legend_left, std::max(gap, plots.left));

    double bottom = legend + gap / 2;
    to.legend_bottom = gap / 2;
    to.x_label_middle = (plots.left + figure_width - plots.right) / 2;
    const double about_middle = 2 * std::min(to.x_label_middle, figure_width - to.x_label_middle);
    for (const std::string& line : lines_of(parts.x_label, length_in(about_middle - gap)) | std::views::reverse) {
        to.x_label.insert(to.x_label.begin(), {line, bottom + line_height / 2});
        bottom += line_height;
    }
    bottom += gap / 2 + below_plot;
    constexpr double row_gap = 1.2;
    const double above = titled ? gap / 2 : 1;
    const double row = plots.plot_height + head;
    const auto rows = static_cast<double>(plots.rows);
    to.height = bottom + rows * row + (rows - 1) * row_gap + above;
    for (std::size_t i = 0; i < plots.panels; ++i) {
        const std::size_t from_above = i / plots.columns;
        const auto from_below = static_cast<double>(plots.rows - 1 - from_above);
        const double low = bottom + from_below * (row + row_gap);
        const double left = plots.plot_left(i);
        to.plots.push_back({.left = left,
                            .right = left + plots.plot_width(),
                            .bottom = low,
                            .top = low + plots.plot_height,
                            .title = low + plots.plot_height + highest_marks + gap / 2 + line_height / 2,
                            .has_x_ticks = i + plots.columns >= plots.panels,
                            .has_y_ticks = i % plots.columns == 0});
    }
    if (!with_ends && legend == 0 && to.legend_rows > 0)
        to.legend_bottom = to.plots.back().top - layout::legend_row * static_cast<double>(to.legend_rows) - gap;
    for (std::optional<layout::end_label>& end : to.ends)
        if (end) end->at += bottom;
    to.end_left = to.plots.front().right + 0.7;
    to.y_label_middle = (to.plots.back().bottom + to.plots.front().top) / 2;
    return to;
}

}  // namespace aabblab
