module aabblab.reproduction;

import aabblab.fmt;
import aabblab.markup;
import aabblab.scale;
import aabblab.svg;

namespace aabblab {

namespace {

// The scale of the pictures of all ratios, logarithmic with 1 in the middle.
constexpr double most_shown = 5;
const scale ratio_scale{1 / most_shown, most_shown, true};
constexpr double margin = 4;  // at both ends, in percent, for arrows

double x_percent(double ratio) {
    return margin + (100 - 2 * margin) * ratio_scale.place(std::clamp(ratio, ratio_scale.from, ratio_scale.to));
}

/// Draws the band of no difference, with 1 in the middle.
void add_band(svg_picture& picture, double low, double centre, double high, double top, double bottom) {
    picture.rectangle("band", {low, top, high - low, bottom - top});
    picture.line("one", {centre, top}, {centre, bottom});
}

/// Draws an arrow at the left or right end of the picture, for what lies beyond the scale.
/// Positions are in percent of the width (x) and in pixels (y), as everywhere in these pictures.
void add_arrow(svg_picture& picture, bool to_left, double y) {
    const double back = to_left ? 8 : -8;  // pixels
    svg_picture head;
    head.path("", {{{back, -5}, {0, 0}, {back, 5}}}, /*closed=*/true);
    picture.put({to_left ? 1. : 99., y}, head);
}

}  // namespace

/// A ratio as a disc on its 95 % interval. An arrow points to a limit beyond the scale, and replaces a disc beyond it.
std::string interval_picture(const endpoint& e) {
    constexpr double height = 18, y = height / 2;
    const auto& [low, high] = e.range;
    const bool is_below = low < ratio_scale.from;
    const bool is_above = high > ratio_scale.to;
    svg_picture picture("%");
    add_band(picture, x_percent(1 / (1 + equivalence_band)), /*centre=*/50, x_percent(1 + equivalence_band), /*top=*/0,
             height);
    picture.line("range", {is_below ? 2 : x_percent(low), y}, {is_above ? 98 : x_percent(high), y});
    if (ratio_scale.from <= e.ratio && e.ratio <= ratio_scale.to) picture.disc({x_percent(e.ratio), y}, 4);
    if (is_below) add_arrow(picture, /*to_left=*/true, y);
    if (is_above) add_arrow(picture, /*to_left=*/false, y);
    return picture.in_page("interval", "ratio " + ratio_text(e), height);
}

/// The axis above these intervals.
std::string interval_axis() {
    constexpr double height = 32;
    svg_picture picture("%");
    picture.text("", {margin, 11}, "\u2190 for the claim");
    picture.text("", {100 - margin, 11}, "against it \u2192", {{"text-anchor", "end"}});
    for (const double ratio : {0.25, 0.5, 1., 2., 4.}) {
        picture.text("", {x_percent(ratio), 25}, fmt::format("{:g}", ratio), {{"text-anchor", "middle"}});
        picture.line("axis", {x_percent(ratio), height - 4}, {x_percent(ratio), height});
    }
    return picture.in_page("interval", "scale of the ratios", height);
}

/// An SVG picture of the rule by which ratios are judged: example intervals with their outcomes.
std::string rule_picture() {
    struct example {
        double low;
        double high;
        std::string_view outcome;
    };
    constexpr std::array<example, 4> examples{{{0.45, 0.62, "less: for the claim"},
                                               {0.965, 1.035, "no difference"},
                                               {1.3, 1.8, "more: against it"},
                                               {0.72, 1.35, "undecided"}}};
    // The left part of the picture has the scale, and the right part the words.
    constexpr double plot_width = 64;  // %
    const scale shown{.from = 0.4, .to = 2.5, .logarithmic = true};
    const auto x = [&](double ratio) { return plot_width * shown.place(ratio); };
    constexpr double row = 26;  // vertical measures, in pixels
    constexpr double first = 40;
    constexpr double end = first + row * examples.size() - 8;
    svg_picture picture("%");
    add_band(picture, x(1 / (1 + equivalence_band)), plot_width / 2, x(1 + equivalence_band), /*top=*/22, end);
    picture.text("", {plot_width / 2, 14}, "1", {{"text-anchor", "middle"}});
    picture.text("", {0, 14}, "\u2190 for the claim");
    picture.text("", {plot_width, 14}, "against \u2192", {{"text-anchor", "end"}});
    for (const example& e : examples) {
        const double y = first + row * static_cast<double>(&e - examples.data());
        picture.line("range", {x(e.low), y}, {x(e.high), y});
        picture.disc({x(std::sqrt(e.low * e.high)), y}, 5);
        picture.text("outcome", {plot_width + 3, y + 5}, e.outcome);
    }
    picture.text("", {plot_width / 2, end + 18}, fmt::format("band of \u00b1{:.0f} %", 100 * equivalence_band),
                 {{"text-anchor", "middle"}});
    return picture.in_page("rule", "an interval against the band of no difference", end + 26);
}

}  // namespace aabblab
