module;
#include <cstddef>
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
    std::vector<placed_text> marks;  ///< from left to right
};

struct layout {
    static constexpr double legend_row = 1.4;

    double width;   ///< of the whole figure
    double height;  ///< of the whole figure
    double left;    ///< from the left edge of the figure to the plot, and so on
    double right;
    double top;
    double bottom;
    /// A line of an axis label, and the distance of its middle from the figure's left or lower edge.
    struct label_line {
        std::string text;
        double at;
    };
    std::vector<label_line> x_label;
    std::vector<label_line> y_label;

    std::size_t x_name_length;  ///< at which names below the plot are broken into lines
    int x_name_angle;           ///< of these names, in degrees; 0 where they fit side by side

    double legend_left;
    double legend_bottom;
    std::size_t legend_rows;
    std::vector<std::vector<std::string>> legend;  ///< the lines of each label; none where it has none

    struct mark {
        double above;  ///< of its text's middle over the plot
        bool right_of_line;
    };
    std::vector<mark> marks;
};

[[nodiscard]] layout layout_of(const contents& parts);

inline constexpr std::size_t y_name_length = 32;  ///< at which names on the y axis are broken into lines

}  // namespace aabblab
