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

[[nodiscard]] std::string ticks(const scale& s, std::size_t name_length) {
    std::string list;
    for (const tick& t : s.ticks) {
        if (!list.empty()) list += ", ";
        const std::string label =
            s.named ? in_double_quotes(lines_of(without_format(t.label), name_length)) : in_double_quotes(t.label);
        list += fmt::format("{} {:.12g}{}", label, t.at, t.label.empty() && !s.named ? " 1" : "");
    }
    return "(" + list + ")";
}

[[nodiscard]] std::string axis(char name, const scale& s, std::size_t name_length) {
    return fmt::format("\n{0}_from = {1}\n{0}_to = {2}\nset {0}range [{0}_from:{0}_to]\n", name, s.from, s.to) +
           (s.logarithmic ? fmt::format("set logscale {}\n", name) : "") +
           fmt::format("set {}tics {} nomirror out{}\n", name, ticks(s, name_length), s.named ? " noenhanced" : "");
}

/// The edges of the plot; places are parts of the whole figure.
[[nodiscard]] std::string frame(const layout& r) {
    return fmt::format(
        "\nset lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
        "set bmargin at screen {:.4f}\nset tmargin at screen {:.4f}\n"
        "set border 3 linecolor rgb '#404040'\nset tics scale 0.6,0.3 textcolor rgb '#000000'\n"
        "set grid linetype 1 linecolor rgb '#E0E0E0' linewidth 0.5\n",
        r.left / r.width, 1 - r.right / r.width, r.bottom / r.height, 1 - r.top / r.height);
}

/// Where gnuplot itself puts them depends on how wide it believes the numbers to be.
[[nodiscard]] std::string axis_labels(const layout& r) {
    std::string text;
    for (const layout::label_line& line : r.x_label)
        text += fmt::format("set label {} at graph 0.5, screen {:.4f} center noenhanced\n", in_double_quotes(line.text),
                            line.at / r.height);
    for (const layout::label_line& line : r.y_label)
        text += fmt::format("set label {} at screen {:.4f}, graph 0.5 center rotate noenhanced\n",
                            in_double_quotes(line.text), line.at / r.width);
    return text;
}

[[nodiscard]] std::string legend(const layout& r) {
    if (r.legend_rows == 0) return "unset key\n";
    return fmt::format(
        "set key at screen {:.4f}, screen {:.4f} left bottom vertical Left reverse maxrows {} samplen 4\n",
        r.legend_left / r.width, r.legend_bottom / r.height, r.legend_rows);
}

[[nodiscard]] std::string marks(const drawing& d) {
    std::string text;
    const layout& r = d.room;
    for (std::size_t i = 0; i < d.marks.size(); ++i) {
        const double middle = (r.height - r.top + r.marks[i].above) / r.height;
        text += fmt::format(
            "set arrow from first {0}, graph 0 to first {0}, screen {1:.4f} nohead back linecolor rgb '#404040' "
            "dashtype (2,3)\nset label {2} at first {0}, screen {3:.4f} {4} noenhanced\n",
            d.marks[i].x, middle + 0.4 / r.height, in_double_quotes(d.marks[i].label), middle,
            r.marks[i].right_of_line ? "left offset character 0.5,0" : "right offset character -0.5,0");
    }
    if (d.lines.empty()) text += "set label 'no data' at graph 0.5, graph 0.5 center\n";
    return text;
}

[[nodiscard]] std::string line_styles(const drawing& d) {
    std::string text = "\n# The look of series n.\n";
    for (const shown_series& s : d.lines) {
        const std::size_t i = s.number - 1;
        text +=
            fmt::format("set style line {} linecolor rgb '{}' linewidth 1.5 dashtype {} pointtype {} pointsize {}\n",
                        s.number, colours[i % colours.size()], dashes[i % dashes.size()], shapes[i % shapes.size()],
                        shape_sizes[i % shape_sizes.size()]);
    }
    return text;
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
    // gnuplot's fonts in a PDF are as large as on a screen of 96 dots per inch.
    return fmt::format(
               "\nset terminal svg size {:.0f},{:.0f} fixed enhanced background 'white' font 'sans-serif,{}' "
               "linewidth 1.5\n",
               r.width * em_in_pixels, r.height * em_in_pixels, em_in_pixels) +
           heights(r, 1.5) + "set output " + in_double_quotes(d.f.name + ".svg") + "\n" + plot_command(d) +
           fmt::format(
               "\nset terminal pdfcairo size {:.2f}cm,{:.2f}cm enhanced font 'Helvetica,{}' fontscale 0.75 "
               "linewidth 1.3 dashlength 1.5\n",
               r.width * em_in_points * point_in_cm, r.height * em_in_points * point_in_cm, em_in_points) +
           heights(r, 1.15) + "set output " + in_double_quotes(d.f.name + ".pdf") + "\nreplot\nunset output\n";
}

}  // namespace

std::string script_of(const figure& f) {
    const drawing d(f);
    return head(d) + axis('x', d.x, d.room.x_name_length) + axis('y', d.y, y_name_length) + frame(d.room) +
           axis_labels(d.room) + legend(d.room) + marks(d) + "\n" + plot_functions(d) + line_styles(d) + terminals(d);
}

}  // namespace aabblab
