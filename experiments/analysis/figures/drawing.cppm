module;
#include <cstddef>
#include <vector>

/// A figure made ready to be written down: which points have a place in it, on which axes, and where all else goes.
module aabblab.figures:drawing;

import :figure;
import :layout;
import :scale;

namespace aabblab {

/// The points of a series in NAME.csv: all that are finite, of a level the first.
[[nodiscard]] std::vector<figure_point> points_of(const series& s);

/// Half the distance of the nearest names; a factor where the axis is logarithmic.
[[nodiscard]] double half_gap(const figure_axis& axis);

/// A series as far as it has a place in the figure.
struct shown_series {
    const series* source;
    std::size_t number;  ///< from 1, among all series of the figure
    std::vector<figure_point> points;
    bool varies;  ///< has quartiles to show

    [[nodiscard]] bool is(series_style style) const { return source->style == style; }
};

/// The figure must outlive it.
struct drawing {
    explicit drawing(const figure& of);

    const figure& f;
    std::vector<shown_series> lines;  ///< their labels stand in the same order in `room`
    std::vector<figure_mark> marks;   ///< from left to right
    scale x;
    scale y;
    layout room;
};

}  // namespace aabblab
