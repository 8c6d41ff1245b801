/// A figure made ready to be drawn: which points have a place in it, and on which axes.
module aabblab.figures:drawing;

import aabb.std;
import aabblab.scale;
import :figure;

namespace aabblab {

/// The points of a series in NAME.csv: all that are finite, of a level the first.
[[nodiscard]] std::vector<figure_point> points_of(const series& s);

/// A series in the order of NAME.csv: those that all panels share, then panel by panel.
struct numbered_series {
    const series* source;
    std::size_t number;         ///< from 1
    const figure_panel* panel;  ///< none, where all have it
};
[[nodiscard]] std::vector<numbered_series> numbered(const figure& f);

/// Half the distance of the nearest names; a factor where the axis is logarithmic.
[[nodiscard]] double half_gap(const figure_axis& axis);

/// A series as far as it has a place in the figure.
struct shown_series {
    const series* source;
    std::size_t look;  ///< from 0; the same for what has one label in several panels
    std::vector<figure_point> points;
    bool varies;  ///< has quartiles to show

    [[nodiscard]] bool is(series_style style) const { return source->style == style; }
    [[nodiscard]] bool is_joined() const { return is(series_style::line) && points.size() > 1; }
};

struct shown_panel {
    std::string title;
    std::vector<shown_series> lines;
    std::vector<figure_mark> marks;  ///< from left to right
};

/// A look in the legend, or at the end of its line.
struct shown_label {
    std::string text;
    std::size_t look;
    series_style style;  ///< points where a line has one point only
};

inline constexpr std::size_t y_name_length = 32;  ///< in characters, at which names on the y axis are broken into lines

/// The figure must outlive it.
struct drawing {
    explicit drawing(const figure& of);

    const figure& f;
    std::vector<shown_panel> panels;
    std::vector<shown_label> labels;
    scale x;
    scale y;

    [[nodiscard]] bool empty() const;
};

}  // namespace aabblab
