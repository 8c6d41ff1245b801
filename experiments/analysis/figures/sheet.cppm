/// A figure as lines, areas and texts, independent of the file format. Positions are in ems from left and bottom.
module aabblab.figures:sheet;

import aabb.std;
import aabblab.figures;
import aabblab.svg;

namespace aabblab {

/// Lines, or the areas that they enclose, with the same look.
struct strokes {
    polylines lines;
    std::string_view colour;       ///< "#0072B2"
    double width = 0;              ///< in ems; 0 for an area
    std::vector<double> dashes{};  ///< lengths of dash, gap, dash, gap, …, in ems; empty for solid lines
    bool closed = false;
    bool round = false;  ///< round caps: a line of a single point is then a disc
    bool faint = false;  ///< translucent
};

inline constexpr double faint_opacity = 0.18;

/// A line of text, anchored at its left end, middle or right end.
struct words {
    enum class anchor : unsigned char { left, middle, right };

    place at;
    std::string text;
    anchor end = anchor::left;
    std::string power{};  ///< a superscript after the text
    int angle = 0;        ///< in degrees, counter-clockwise
    double size = 1;      ///< relative to the font size
};

inline constexpr double power_size = 0.7;  ///< relative to the font size
inline constexpr double power_rise = 0.4;
inline constexpr double baseline = 0.35;  ///< below the middle of a line

struct sheet {
    double width, height;
    std::vector<std::variant<strokes, words>> parts;  ///< in painting order
};

[[nodiscard]] sheet sheet_of(const figure& f);

[[nodiscard]] std::string svg_of(const sheet& s);
[[nodiscard]] std::string pdf_of(const sheet& s);

}  // namespace aabblab
