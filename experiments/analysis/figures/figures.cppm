/// Figures for a paper: readable in black and white, and by the colour-blind.
export module aabblab.figures;

import aabb.std;

export namespace aabblab {

/// One measured value and its quartiles, which are the value itself where nothing varies. What is not finite is left
/// out, and so is, on a logarithmic axis, what is not positive.
struct figure_point {
    double x;
    double y;
    double low = y;
    double high = y;
};

/// How a series is drawn. Quartiles show only where low < high.
enum class series_style : unsigned char {
    line,    ///< points joined in their order, with a band from quartile to quartile
    points,  ///< points alone, with quartile bars; over names, those of several series stand side by side
    level,   ///< a horizontal line over the whole width at the first point's y, with its band; x does not matter
};

struct series {
    std::string label;  ///< at its end or in the legend, where it is not empty
    series_style style = series_style::line;
    std::vector<figure_point> points{};  ///< a series without is left out; the others look as if it were there
};

struct figure_axis {
    std::string label;  ///< with the unit: "time a frame (ms)"
    bool logarithmic = false;
    /// Where the axis has names in place of numbers: each with its place, from left to right.
    std::vector<std::pair<double, std::string>> names{};
};

/// A vertical line with a few words above it.
struct figure_mark {
    double x;
    std::string label;
};

/// One of several small plots that share both axes.
struct figure_panel {
    std::string title;  ///< above it: "displacement 0.1"
    /// Beside those of the figure. What has the same label looks the same in every panel.
    std::vector<series> lines{};
    std::vector<figure_mark> marks{};
};

struct figure {
    std::string name;     ///< of its files, without ending: "figure1"
    std::string caption;  ///< one sentence or two; stands beside the figure in reports, not in it
    figure_axis x;
    figure_axis y;
    std::vector<series> lines{};  ///< up to ten are distinguishable; with panels, drawn in each
    std::vector<figure_mark> marks{};
    std::vector<figure_panel> panels{};  ///< without any it is one plot
};

/// Writes NAME.csv (the points), NAME.svg and NAME.pdf into the folder, which it makes. The same figures give the same
/// bytes.
/// @throws aabb::input_error where a file cannot be written.
void draw(const std::filesystem::path& folder, std::span<const figure> figures);

/// The text of NAME.csv: a line a point, with the number of its series, from 1.
[[nodiscard]] std::string csv_of(const figure& f);

[[nodiscard]] std::string svg_of(const figure& f);
[[nodiscard]] std::string pdf_of(const figure& f);

}  // namespace aabblab
