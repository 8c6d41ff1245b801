module;
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

module aabblab.reproduction;

import aabblab.claims;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

// The scale that all claims share, logarithmic and with 1 in its middle.
constexpr double least = 0.2;
constexpr double greatest = 5;
constexpr double margin = 4;  // at both ends, in percent, for arrows

/// In percent of the picture's width. So the picture can be as wide as there is room, and its text keeps its size.
double place_of(double ratio) {
    const double part = std::log(std::clamp(ratio, least, greatest) / least) / std::log(greatest / least);
    return margin + (100 - 2 * margin) * part;
}

// In pixels.
constexpr double first_row = 16;
constexpr double row_height = 12;

/// @param axis how far down it is
std::string band_and_axis(double axis) {
    const double low = place_of(1 / (1 + equivalence_band));
    const double high = place_of(1 + equivalence_band);
    std::string svg = fmt::format(
        "<rect class=\"band\" x=\"{:.2f}%\" width=\"{:.2f}%\" y=\"4\" height=\"{}\"/>"
        "<line class=\"one\" x1=\"50%\" x2=\"50%\" y1=\"4\" y2=\"{}\"/>"
        "<line class=\"axis\" x1=\"{}%\" x2=\"{}%\" y1=\"{}\" y2=\"{}\"/>",
        low, high - low, axis - 4, axis, margin, 100 - margin, axis, axis);
    constexpr std::array<std::pair<double, std::string_view>, 5> numbers{
        {{0.25, "0.25"}, {0.5, "0.5"}, {1, "1"}, {2, "2"}, {4, "4"}}};
    for (const auto& [ratio, text] : numbers)
        svg += fmt::format(
            "<line class=\"axis\" x1=\"{0:.2f}%\" x2=\"{0:.2f}%\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text x=\"{0:.2f}%\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
            place_of(ratio), axis, axis + 3, axis + 14, text);
    return svg;
}

/// What lies beyond the scale is an arrow at its end, with the number.
std::string arrow(bool to_left, double y, double number) {
    return fmt::format(
        "<svg x=\"{}%\" y=\"{}\" overflow=\"visible\"><path d=\"M{} -5 L0 0 L{} 5z\"/></svg>"
        "<text x=\"{}%\" y=\"{}\" text-anchor=\"{}\">{}</text>",
        to_left ? 1 : 99, y, to_left ? 8 : -8, to_left ? 8 : -8, to_left ? 4 : 96, y - 4, to_left ? "start" : "end",
        ratio_digits_of(number));
}

std::string interval_at(const endpoint& e, double y) {
    const auto& [low, high] = e.range;
    std::string svg = fmt::format("<line class=\"range\" x1=\"{:.2f}%\" x2=\"{:.2f}%\" y1=\"{}\" y2=\"{}\"/>",
                                  low < least ? 2 : place_of(low), high > greatest ? 98 : place_of(high), y, y);
    if (least <= e.ratio && e.ratio <= greatest)
        svg += fmt::format("<circle cx=\"{:.2f}%\" cy=\"{}\" r=\"4\"/>", place_of(e.ratio), y);
    if (low < least) svg += arrow(true, y, e.ratio < least ? e.ratio : low);
    if (high > greatest) svg += arrow(false, y, e.ratio > greatest ? e.ratio : high);
    return svg;
}

}  // namespace

std::string interval_picture(std::span<const endpoint> all) {
    const double axis = first_row + row_height * static_cast<double>(all.size());
    std::string label;
    std::string intervals;
    for (const endpoint& e : all) {
        label += (label.empty() ? "ratio " : "; ") + ratio_text(e);
        intervals += interval_at(e, first_row + row_height * static_cast<double>(&e - all.data()));
    }
    return fmt::format("<svg class=\"interval\" role=\"img\" aria-label=\"{}\" width=\"100%\" height=\"{}\">",
                       html_text(label), axis + 16) +
           band_and_axis(axis) + intervals + "</svg>";
}

std::string rule_picture() {
    struct example {
        double low;
        double high;
        std::string_view outcome;
    };
    constexpr std::array<example, 5> examples{{{0.45, 0.62, "less"},
                                               {0.84, 0.98, "less, by little"},
                                               {0.965, 1.035, "the same"},
                                               {1.3, 1.8, "more"},
                                               {0.72, 1.35, "direction open"}}};
    // The left part of the picture has the scale, from 0.4 to 2.5, and the right part the words.
    constexpr double part = 64;
    const auto x = [](double ratio) { return part / 2 + part / 2 * std::log(ratio) / std::log(2.5); };
    constexpr double row = 26;
    constexpr double first = 40;
    constexpr double end = first + row * examples.size() - 8;
    const double low = x(1 / (1 + equivalence_band));
    const double high = x(1 + equivalence_band);
    std::string svg = fmt::format(
        "<svg class=\"rule\" role=\"img\" aria-label=\"an interval against the band of no difference\" width=\"100%\" "
        "height=\"{0}\"><rect class=\"band\" x=\"{1:.2f}%\" width=\"{2:.2f}%\" y=\"22\" height=\"{3}\"/>"
        "<line class=\"one\" x1=\"{4}%\" x2=\"{4}%\" y1=\"22\" y2=\"{5}\"/>"
        "<text x=\"{4}%\" y=\"14\" text-anchor=\"middle\">1</text>"
        "<text x=\"0\" y=\"14\">\u2190 for the claim</text>"
        "<text x=\"{6}%\" y=\"14\" text-anchor=\"end\">against \u2192</text>",
        end + 26, low, high - low, end - 22, part / 2, end, part);
    for (std::size_t i = 0; i < examples.size(); ++i) {
        const example& e = examples[i];
        const double y = first + row * static_cast<double>(i);
        svg += fmt::format(
            "<line class=\"range\" x1=\"{0:.2f}%\" x2=\"{1:.2f}%\" y1=\"{2}\" y2=\"{2}\"/>"
            "<circle cx=\"{3:.2f}%\" cy=\"{2}\" r=\"5\"/><text class=\"outcome\" x=\"{4}%\" y=\"{5}\">{6}</text>",
            x(e.low), x(e.high), y, x(std::sqrt(e.low * e.high)), part + 3, y + 5, e.outcome);
    }
    return svg + fmt::format("<text x=\"{}%\" y=\"{}\" text-anchor=\"middle\">band of \u00b1{:.0f} %</text></svg>",
                             part / 2, end + 18, 100 * equivalence_band);
}

}  // namespace aabblab
