module;
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Where the parts of a figure go, in ems of its font, so that no legend, name or mark covers data. gnuplot would take
/// the room for them from the plot, and thinks wrongly of how wide text is in an SVG.
module aabblab.figures:layout;

namespace aabblab {

/// A text and its place along the plot: 0 at the left or lower end, 1 at the other.
using placed_text = std::pair<double, std::string>;

struct contents {
    std::string x_label;
    std::string y_label;
    std::vector<placed_text> x_ticks;
    std::vector<placed_text> y_ticks;
    bool x_named = false;
    bool y_named = false;
    std::vector<std::string> legend;
    /// Where on the y axis the lines of the legend end at the right edge; none where one of them does not.
    std::vector<double> ends;
    std::vector<std::string> titles;              ///< of panels, one or more, from left to right and downwards
    std::vector<std::vector<placed_text>> marks;  ///< of each panel, from left to right
};

struct layout {
    static constexpr double legend_row = 1.4;

    double width;   ///< of the whole figure
    double height;  ///< of the whole figure

    /// A plot, from the figure's left and lower edges.
    struct box {
        double left;
        double right;
        double bottom;
        double top;
        double title;  ///< the middle of its title's line
        bool has_x_ticks;
        bool has_y_ticks;
    };
    std::vector<box> plots;  ///< one a panel

    /// A line of text, and where its middle is: of an axis label along the axis's other side, of an end on both.
    struct label_line {
        std::string text;
        double at;
    };
    std::vector<label_line> x_label;
    std::vector<label_line> y_label;
    double x_label_middle;  ///< from the left edge
    double y_label_middle;  ///< from the lower edge

    std::vector<bool> x_tick_shown;  ///< of each tick: numbers that would run into each other are left out
    std::size_t x_name_length;       ///< at which names below the plot are broken into lines
    int x_name_angle;                ///< of these names, in degrees; 0 where they fit side by side

    double legend_left;
    double legend_bottom;
    std::size_t legend_rows;
    std::vector<std::vector<std::string>> legend;  ///< the lines of each label; none where it has none

    /// The label of a line at its end, in place of the legend.
    struct end_label {
        double at;  ///< its middle, from the lower edge
        std::vector<std::string> lines;
    };
    std::vector<std::optional<end_label>> ends;  ///< empty where there is a legend
    double end_left;                             ///< of the sign before them

    struct mark {
        double above;  ///< of its text's middle over the plot
        bool right_of_line;
    };
    std::vector<std::vector<mark>> marks;  ///< of each panel
};

[[nodiscard]] layout layout_of(const contents& parts);

inline constexpr std::size_t y_name_length = 32;  ///< at which names on the y axis are broken into lines
inline constexpr double text_line = 1.25;         ///< from one line of text to the next

}  // namespace aabblab
