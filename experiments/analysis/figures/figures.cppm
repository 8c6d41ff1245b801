/// Figures for a paper that are readable in black and white, and by colour-blind people.
export module aabblab.figures;

import aabb.std;

export namespace aabblab {

/// A measured value with its quartiles or interval, which equal the value if it does not vary. Values that are not
/// finite are omitted, as are non-positive values on a logarithmic axis.
struct figure_point {
    double x, y;
    double low = y;
    double high = y;
    double x_low = x;  ///< the interval of x, drawn where no band is
    double x_high = x;
    std::string label{};  ///< drawn beside the point, or with a line to it
};

/// The style of a series. Quartiles and intervals are drawn only if low < high.
enum class series_style : unsigned char {
    line,    ///< points joined in their order, with a band from quartile to quartile
    points,  ///< points with quartile bars; over names, several series are drawn side by side
    level,   ///< a horizontal line over the whole width at the first point's y, with its band; x does not matter
    curve,   ///< points joined in their order, with bars of the intervals of x and y: both were measured
};

struct series {
    std::string label;  ///< at its end or in the legend, unless empty
    series_style style = series_style::line;
    std::vector<figure_point> points{};  ///< an empty series is omitted; the looks of others do not change
};

struct figure_axis {
    std::string label;  ///< with the unit: "time per frame (ms)"
    bool logarithmic = false;
    /// The names that replace numbers, each with its position, from left to right; empty for numbers.
    std::vector<std::pair<double, std::string>> names{};
};

/// A vertical line with a short text above it.
struct figure_mark {
    double x;
    std::string label;
};

/// One of several small plots that share both axes.
struct figure_panel {
    std::string title;  ///< above it: "displacement 0.1"
    /// Drawn in addition to those of the figure. Series with the same label look the same in every panel.
    std::vector<series> lines{};
    std::vector<figure_mark> marks{};
};

struct figure {
    std::string name;     ///< of its files, without extension: "figure1"
    std::string caption;  ///< one or two sentences; reports show it beside the figure
    figure_axis x;
    figure_axis y;
    std::vector<series> lines{};  ///< up to ten are distinguishable; with panels, drawn in each
    std::vector<figure_mark> marks{};
    std::vector<figure_panel> panels{};  ///< if empty, the figure is a single plot
};

/// Writes NAME.csv (the points), NAME.svg and NAME.pdf to the folder, which it creates; the bytes are reproducible.
/// @throws aabb::input_error if a file cannot be written.
void draw(const std::filesystem::path& folder, std::span<const figure> figures);

/// The text of NAME.csv: one line per point, with the number of its series, from 1.
[[nodiscard]] std::string csv_of(const figure& f);

[[nodiscard]] std::string svg_of(const figure& f);
[[nodiscard]] std::string pdf_of(const figure& f);

}  // namespace aabblab
