module;
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

module aabblab.figures;

import :drawing;
import :plot;
import :text;

namespace aabblab {

namespace {

/// Points of several series over one name stand side by side.
[[nodiscard]] double shift_of(const drawing& d, const shown_panel& panel, const shown_series& s) {
    if (!d.x.named || d.x.logarithmic || !s.is(series_style::points)) return 0;
    double count = 0;
    double before = 0;
    for (const shown_series& other : panel.lines) {
        if (!other.is(series_style::points)) continue;
        if (other.number < s.number) ++before;
        ++count;
    }
    return (before - (count - 1) / 2) * std::min(0.3, 1.4 / count) * half_gap(d.f.x);
}

[[nodiscard]] std::string x_of(const drawing& d, const shown_panel& panel, const shown_series& s) {
    if (s.is(series_style::level)) return fmt::format("(x_of_level({}))", s.number);
    const double shift = shift_of(d, panel, s);
    return shift == 0 ? fmt::format("(x_of({}))", s.number) : fmt::format("(x_of({}) {:+.4g})", s.number, shift);
}

[[nodiscard]] std::string low_of(const drawing& d) {
    return d.f.y.logarithmic ? "above(column(\"low\"))" : "column(\"low\")";
}

/// What lies below all lines.
[[nodiscard]] std::string band(const drawing& d, const shown_panel& panel, const shown_series& s) {
    const bool level = s.is(series_style::level);
    // Of one point it would have no width.
    if (!s.varies || (!level && (s.is(series_style::points) || s.points.size() == 1))) return {};
    const std::string columns = level ? fmt::format(":\"y\":(x_from):(x_to):({}):\"high\" with boxxyerror", low_of(d))
                                      : fmt::format(":({}):\"high\" with filledcurves", low_of(d));
    return x_of(d, panel, s) + columns +
           fmt::format(" linestyle {} fillstyle transparent solid 0.18 noborder notitle", s.look);
}

/// gnuplot's own error bars have a gap about the point, in which short ones vanish.
[[nodiscard]] std::string bars(const drawing& d, const shown_panel& panel, const shown_series& s) {
    if (!s.varies || s.is(series_style::level) || (s.is(series_style::line) && s.points.size() > 1)) return {};
    return fmt::format(
        "{0}:({1}):(0):(column(\"high\") - {1}) with vectors nohead linestyle {2} dashtype solid notitle",
        x_of(d, panel, s), low_of(d), s.look);
}

[[nodiscard]] std::string line(const drawing& d, const shown_panel& panel, const shown_series& s) {
    std::string text = x_of(d, panel, s) + ":\"y\"";
    if (s.is(series_style::level))
        text += ":(x_to - x_from):(0) with vectors nohead";
    else if (s.is(series_style::points) || s.points.size() == 1)
        text += " with points";
    else
        text += " with linespoints";
    text += fmt::format(" linestyle {}", s.look);
    // The points of a line that has many would be one thick line.
    constexpr std::size_t readable = 20;
    if (s.is(series_style::line) && s.points.size() > readable)
        text += fmt::format(" pointinterval {}", s.points.size() / (readable / 2));
    return text + " notitle";
}

/// What the legend shows of a label, drawn nowhere else.
[[nodiscard]] std::string legend_entry(const shown_label& label, const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        // In gnuplot's legend the lines of one title lie upon each other.
        std::string with = "lines linetype nodraw";
        if (text.empty()) {
            with = label.style == series_style::line ? "linespoints" : "points";
            if (label.style == series_style::level) with = "lines";
            with += fmt::format(" linestyle {}", label.look);
        } else {
            text += ", \\\n     ";
        }
        text += "NaN with " + with + " title " + in_double_quotes(line) + " noenhanced";
    }
    return text;
}

}  // namespace

std::string plot_functions(const drawing& d) {
    const auto has_level = [](const shown_panel& panel) {
        return std::ranges::any_of(panel.lines, [](const shown_series& s) { return s.is(series_style::level); });
    };
    const std::string positive_y = d.f.y.logarithmic ? " && column(\"y\") > 0" : "";
    std::string text = fmt::format(
        "# Where points of series n have their x{}.\n",
        d.f.x.logarithmic || d.f.y.logarithmic ? "; what is not positive has no place on a logarithmic axis" : "");
    text += fmt::format("x_of(n) = column(\"number\") == n{}{} ? column(\"x\") : NaN\n",
                        d.f.x.logarithmic ? " && column(\"x\") > 0" : "", positive_y);
    if (std::ranges::any_of(d.panels, has_level))
        text += fmt::format("x_of_level(n) = column(\"number\") == n{} ? x_from : NaN\n", positive_y);
    if (d.f.y.logarithmic) text += "above(low) = low > y_from ? low : y_from\n";
    return text;
}

std::string plot_command(const drawing& d, const shown_panel& panel, bool with_legend) {
    std::string text;
    const auto add = [&](const std::string& part) {
        if (!part.empty()) text += (text.empty() ? "" : ", \\\n     ") + part;
    };
    bool named = false;
    const auto add_points = [&](const std::string& part) {
        if (part.empty()) return;
        add((std::exchange(named, true) ? "''" : in_double_quotes(d.f.name + ".csv")) + " using " + part);
    };
    for (const shown_series& s : panel.lines) add_points(band(d, panel, s));
    for (const shown_series& s : panel.lines) {
        add_points(bars(d, panel, s));
        add_points(line(d, panel, s));
    }
    if (with_legend)
        for (std::size_t i = 0; i < d.labels.size(); ++i) add(legend_entry(d.labels[i], d.room.legend[i]));
    return "plot " + (text.empty() ? "NaN notitle" : text) + "\n";
}

}  // namespace aabblab
