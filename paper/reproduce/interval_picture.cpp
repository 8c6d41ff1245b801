module;
#include <fmt/format.h>

module aabblab.reproduction;

import aabblab.markup;
import aabblab.scale;

namespace aabblab {

namespace {

// The scale that all claims share, logarithmic and with 1 in its middle.
const scale shared{0.2, 5, true};
constexpr double margin = 4;  // at both ends, in percent, for arrows

// Places from left to right are in percent of the picture's width. So the picture can be as wide as there is room, and
// its text keeps its size. Those from the upper edge are in pixels.

double place_of(double ratio) {
    return margin + (100 - 2 * margin) * shared.place(std::clamp(ratio, shared.from, shared.to));
}

std::string line(std::string_view kind, double x1, double x2, double y1, double y2) {
    return element("line", {{"class", kind}, {"x1", percent(x1)}, {"x2", percent(x2)}, {"y1", y1}, {"y2", y2}});
}

std::string words_at(double x, double y, std::string_view text, std::string_view anchor, std::string_view kind = "") {
    return element("text", {{"class", kind}, {"x", percent(x)}, {"y", y}, {"text-anchor", anchor}}, markup_text(text));
}

std::string disc(double x, double y, double radius) {
    return element("circle", {{"cx", percent(x)}, {"cy", y}, {"r", radius}});
}

/// The band of no difference, and 1 in its middle.
std::string band(double low, double one, double high, double top, double bottom) {
    return element("rect", {{"class", "band"},
                            {"x", percent(low)},
                            {"width", percent(high - low)},
                            {"y", top},
                            {"height", bottom - top}}) +
           line("one", one, one, top, bottom);
}

std::string picture(std::string_view kind, std::string_view label, double height, const std::string& content) {
    return element("svg",
                   {{"class", kind}, {"role", "img"}, {"aria-label", label}, {"width", "100%"}, {"height", height}},
                   content);
}

constexpr double first_row = 16;
constexpr double row_height = 12;

/// @param y how far down it is
std::string axis_at(double y) {
    std::string svg = line("axis", margin, 100 - margin, y, y);
    for (const double ratio : {0.25, 0.5, 1., 2., 4.})
        svg += line("axis", place_of(ratio), place_of(ratio), y, y + 3) +
               words_at(place_of(ratio), y + 14, short_number(ratio), "middle");
    return svg;
}

/// What lies beyond the scale is an arrow at its end, with the number.
std::string arrow(bool to_left, double y, double number) {
    const std::string_view head = to_left ? "M8 -5 L0 0 L8 5z" : "M-8 -5 L0 0 L-8 5z";
    return element("svg", {{"x", percent(to_left ? 1 : 99)}, {"y", y}, {"overflow", "visible"}},
                   element("path", {{"d", head}})) +
           words_at(to_left ? margin : 100 - margin, y - 4, ratio_digits_of(number), to_left ? "start" : "end");
}

std::string interval_at(const endpoint& e, double y) {
    const auto& [low, high] = e.range;
    const bool below = low < shared.from;
    const bool above = high > shared.to;
    std::string svg = line("range", below ? 2 : place_of(low), above ? 98 : place_of(high), y, y);
    if (shared.from <= e.ratio && e.ratio <= shared.to) svg += disc(place_of(e.ratio), y, 4);
    if (below) svg += arrow(true, y, e.ratio < shared.from ? e.ratio : low);
    if (above) svg += arrow(false, y, e.ratio > shared.to ? e.ratio : high);
    return svg;
}

}  // namespace

std::string interval_picture(std::span<const endpoint> all) {
    const double axis = first_row + row_height * static_cast<double>(all.size());
    std::string label;
    std::string svg =
        band(place_of(1 / (1 + equivalence_band)), 50, place_of(1 + equivalence_band), 4, axis) + axis_at(axis);
    for (const endpoint& e : all) {
        label += (label.empty() ? "ratio " : "; ") + ratio_text(e);
        svg += interval_at(e, first_row + row_height * static_cast<double>(&e - all.data()));
    }
    return picture("interval", label, axis + 16, svg);
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
    // The left part of the picture has the scale, and the right part the words.
    constexpr double part = 64;
    const scale shown{0.4, 2.5, true};
    const auto x = [&](double ratio) { return part * shown.place(ratio); };
    constexpr double row = 26;
    constexpr double first = 40;
    constexpr double end = first + row * examples.size() - 8;
    std::string svg = band(x(1 / (1 + equivalence_band)), part / 2, x(1 + equivalence_band), 22, end) +
                      words_at(part / 2, 14, "1", "middle") + words_at(0, 14, "\u2190 for the claim", "") +
                      words_at(part, 14, "against \u2192", "end");
    double y = first;
    for (const example& e : examples) {
        svg += line("range", x(e.low), x(e.high), y, y) + disc(x(std::sqrt(e.low * e.high)), y, 5) +
               words_at(part + 3, y + 5, e.outcome, "", "outcome");
        y += row;
    }
    svg += words_at(part / 2, end + 18, fmt::format("band of \u00b1{:.0f} %", 100 * equivalence_band), "middle");
    return picture("rule", "an interval against the band of no difference", end + 26, svg);
}

}  // namespace aabblab
