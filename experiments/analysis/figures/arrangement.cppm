/// Where the parts of a figure go, in ems of its font, so that no legend, name or mark covers data.
module aabblab.figures:arrangement;

import aabb.std;
import aabblab.scale;
import :drawing;
import :sheet;

namespace aabblab {

struct arrangement {
    double width;   ///< of the whole figure
    double height;  ///< of the whole figure

    /// A plot, from the figure's left and lower edges.
    struct box {
        double left;
        double right;
        double bottom;
        double top;
        bool has_x_ticks;
        bool has_y_ticks;
        std::vector<double> mark_tops;  ///< up to where the lines of its marks reach
    };
    std::vector<box> plots;  ///< one a panel

    std::vector<tick> x_ticks;  ///< small ones for numbers that would run into each other
    std::size_t x_name_length;  ///< at which names below the plot are broken into lines
    int x_name_angle;           ///< of these names, in degrees; 0 where they fit side by side

    /// How a label's line looks, beside the label: in a legend from here to the right, at the line's end about this
    /// place.
    struct sample {
        place at;
        const shown_label* of;
        bool is_end;
    };
    std::vector<sample> samples;
    std::vector<words> texts;  ///< all but those of the ticks
};

[[nodiscard]] arrangement arranged(const drawing& d);

/// The label of a tick as its axis shows it: a name is broken into short lines, a number stands in one.
[[nodiscard]] std::vector<std::string> lines_of(const scale& axis, const tick& t, std::size_t length);

// In ems.
inline constexpr double line_height = 1.25;
inline constexpr double tick_room = 0.9;  ///< of a tick and the gap to its label

/// The middles of lines of text below a place.
[[nodiscard]] std::vector<place> lines_below(place top, std::size_t count);

}  // namespace aabblab
