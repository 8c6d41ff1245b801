module;
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

module aabblab.figures;

import :drawing;
import :layout;
import :look;
import :plot;
import :scale;
import :text;

namespace aabblab {

namespace {

/// A comment must not end in a backslash, which would make the next line one too.
[[nodiscard]] std::string comment(const std::string& text) {
    return text.empty() ? text : "# " + one_line(text) + (text.back() == '\\' ? " \n" : "\n");
}

[[nodiscard]] std::string head(const drawing& d) {
    return comment(fmt::format(
               "Draws {0}.svg and {0}.pdf from {0}.csv. Run it in the folder of these files: gnuplot {0}.gp",
               d.f.name)) +
           comment(d.f.caption) +
           "reset\nset encoding utf8\nset datafile separator comma\nset datafile columnheaders\n";
}

/// @param with_labels whether this plot has them, or one below or beside it does
[[nodiscard]] std::string ticks(char name, const scale& s, std::size_t name_length, bool with_labels) {
    std::string list;
    for (const tick& t : s.ticks) {
        if (!list.empty()) list += ", ";
        std::string label = "''";
        if (with_labels)
            label =
                s.named ? in_double_quotes(lines_of(without_format(t.label), name_length)) : in_double_quotes(t.label);
        list += fmt::format("{} {:.12g}{}", label, t.at, t.label.empty() && !s.named ? " 1" : "");
    }
    return fmt::format("set {}tics ({}) nomirror out{}\n", name, list, s.named ? " noenhanced" : "");
}

[[nodiscard]] std::string range(char name, const scale& s) {
    return fmt::format("\n{0}_from = {1}\n{0}_to = {2}\nset {0}range [{0}_from:{0}_to]\n", name, s.from, s.to) +
           (s.logarithmic ? fmt::format("set logscale {}\n", name) : "");
}

[[nodiscard]] std::string look_of_frame() {
    return "\nset border 3 linecolor rgb '#404040'\nset tics scale 0.6,0.3 textcolor rgb '#000000'\n"
           "set grid linetype 1 linecolor rgb '#E0E0E0' linewidth 0.5\n";
}

/// The edges of a plot; places are parts of the whole figure.
[[nodiscard]] std::string frame(const layout& r, const layout::box& plot) {
    return fmt::format(
        "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
        "set bmargin at screen {:.4f}\nset tmargin at screen {:.4f}\n",
        plot.left / r.width, plot.right / r.width, plot.bottom / r.height, plot.top / r.height);
}

/// Where gnuplot itself puts them depends on how wide it believes the numbers to be.
[[nodiscard]] std::string axis_labels(const layout& r) {
    std::string text;
    for (const layout::label_line& line : r.x_label)
        text += fmt::format("set label {} at screen {:.4f}, screen {:.4f} center noenhanced\n",
                            in_double_quotes(line.text), r.x_label_middle / r.width, line.at / r.height);
    for (const layout::label_line& line : r.y_label)
        text += fmt::format("set label {} at screen {:.4f}, screen {:.4f} center rotate noenhanced\n",
                            in_double_quotes(line.text), line.at / r.width, r.y_label_middle / r.height);
    return text;
}

/// The labels of lines at their ends, each behind the sign of its line, which may be a little off.
[[nodiscard]] std::string end_labels(const drawing& d) {
    const layout& r = d.room;
    std::string text;
    for (std::size_t i = 0; i < r.ends.size(); ++i) {
        if (!r.ends[i]) continue;
        const auto& [at, lines] = *r.ends[i];
        const std::size_t look = d.labels[i].look;
        const std::string sign =
            d.labels[i].style == series_style::level ? "" : fmt::format(" point linestyle {}", look);
        if (!sign.empty())
            text += fmt::format("set label '' at screen {:.4f}, screen {:.4f}{}\n", r.end_left / r.width, at / r.height,
                                sign);
        for (std::size_t k = 0; k < lines.size(); ++k) {
            const double above = text_line * ((static_cast<double>(lines.size()) - 1) / 2 - static_cast<double>(k));
            text += fmt::format("set label {} at screen {:.4f}, screen {:.4f} left noenhanced\n",
                                in_double_quotes(lines[k]), (r.end_left + (sign.empty() ? -0.2 : 0.8)) / r.width,
                                (at + above) / r.height);
        }
    }
    return text;
}

[[nodiscard]] std::string legend(const layout& r) {
    if (r.legend_rows == 0) return "unset key\n";
    return fmt::format(
        "set key at screen {:.4f}, screen {:.4f} left bottom vertical Left reverse maxrows {} samplen 4\n",
        r.legend_left / r.width, r.legend_bottom / r.height, r.legend_rows);
}

[[nodiscard]] std::string marks(const drawing& d, std::size_t panel) {
    std::string text;
    const layout& r = d.room;
    const std::vector<figure_mark>& all = d.panels[panel].marks;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const layout::mark& place = r.marks[panel][i];
        const double middle = (r.plots[panel].top + place.above) / r.height;
        text += fmt::format(
            "set arrow from first {0}, graph 0 to first {0}, screen {1:.4f} nohead back linecolor rgb '#404040' "
            "dashtype (2,3)\nset label {2} at first {0}, screen {3:.4f} {4} noenhanced\n",
            all[i].x, middle + 0.4 / r.height, in_double_quotes(all[i].label), middle,
            place.right_of_line ? "left offset character 0.5,0" : "right offset character -0.5,0");
    }
    return text;
}

[[nodiscard]] std::string title(const drawing& d, std::size_t panel) {
    if (d.panels[panel].title.empty()) return {};
    const layout& r = d.room;
    const layout::box& plot = r.plots[panel];
    return fmt::format("set label {} at screen {:.4f}, screen {:.4f} left noenhanced\n",
                       in_double_quotes(d.panels[panel].title), plot.left / r.width, plot.title / r.height);
}

[[nodiscard]] std::string line_styles(const drawing& d) {
    std::string text = "\n# The look of each label.\n";
    for (const shown_label& label : d.labels) {
        const std::size_t i = label.look - 1;
        text +=
            fmt::format("set style line {} linecolor rgb '{}' linewidth 1.5 dashtype {} pointtype {} pointsize {}\n",
                        label.look, colours[i % colours.size()], dashes[i % dashes.size()], shapes[i % shapes.size()],
                        shape_sizes[i % shape_sizes.size()]);
    }
    return text;
}

/// All plots. Labels that stand beside them are the first one's, the legend is the last one's.
[[nodiscard]] std::string plots(const drawing& d) {
    const layout& r = d.room;
    std::string text;
    for (std::size_t i = 0; i < d.panels.size(); ++i) {
        const bool first = i == 0;
        const bool last = i + 1 == d.panels.size();
        if (!first) text += "\nunset label\nunset arrow\n";
        text += frame(r, r.plots[i]) + ticks('x', d.x, r.x_name_length, r.plots[i].has_x_ticks) +
                ticks('y', d.y, y_name_length, r.plots[i].has_y_ticks) + (first ? axis_labels(r) + end_labels(d) : "") +
                title(d, i) + marks(d, i) +
                (d.empty() && first ? "set label 'no data' at graph 0.5, graph 0.5 center\n" : "") +
                (last ? legend(r) : "unset key\n") + plot_command(d, d.panels[i], last);
    }
    if (d.panels.size() == 1) return text;
    return "set multiplot\n" + text + "unset multiplot\nunset label\nunset arrow\n";
}

/// Lines of text are to gnuplot so many ems high: in an SVG always the same, in a PDF as high as the font is, about.
[[nodiscard]] std::string heights(const layout& r, double line) {
    return fmt::format("set key spacing {:.2f}\n", layout::legend_row / line) +
           (r.x_name_angle == 0 ? fmt::format("set xtics offset 0,{:.2f}\n", 1 - 1.1 / line)
                                : fmt::format("set xtics rotate by {} right\n", r.x_name_angle));
}

[[nodiscard]] std::string terminals(const drawing& d) {
    constexpr double em_in_pixels = 16;
    constexpr double em_in_points = 9;
    constexpr double point_in_cm = 2.54 / 72;
    const layout& r = d.room;
    const bool one = d.panels.size() == 1;
    // gnuplot's fonts in a PDF are as large as on a screen of 96 dots per inch.
    return fmt::format(
               "\nset terminal svg size {:.0f},{:.0f} fixed enhanced background 'white' font 'sans-serif,{}' "
               "linewidth 1.5\n",
               r.width * em_in_pixels, r.height * em_in_pixels, em_in_pixels) +
           heights(r, 1.5) + "set output " + in_double_quotes(d.f.name + ".svg") + "\n" + plots(d) +
           fmt::format(
               "\nset terminal pdfcairo size {:.2f}cm,{:.2f}cm enhanced font 'Helvetica,{}' fontscale 0.75 "
               "linewidth 1.3 dashlength 1.5\n",
               r.width * em_in_points * point_in_cm, r.height * em_in_points * point_in_cm, em_in_points) +
           heights(r, 1.15) + "set output " + in_double_quotes(d.f.name + ".pdf") + "\n" +
           (one ? "replot\n" : plots(d)) + "unset output\n";
}

}  // namespace

std::string script_of(const figure& f) {
    const drawing d(f);
    return head(d) + range('x', d.x) + range('y', d.y) + look_of_frame() + "\n" + plot_functions(d) + line_styles(d) +
           terminals(d);
}

}  // namespace aabblab
