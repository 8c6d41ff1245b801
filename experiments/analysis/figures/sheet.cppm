/// A figure as lines, areas and texts, as any format of pictures has them. Their places are in ems of the font, from
/// the left and the lower edge.
module aabblab.figures:sheet;

import aabb.std;
import aabblab.figures;
import aabblab.svg;

namespace aabblab {

/// Lines, or the areas within them, that look alike.
struct strokes {
    polylines lines;
    std::string_view colour;       ///< "#0072B2"
    double width = 0;              ///< in ems; 0 for an area
    std::vector<double> dashes{};  ///< of dash, gap, dash, gap, …, in ems; none where it is solid
    bool closed = false;
    bool round = false;  ///< at their ends: a line of one place is a disc then
    bool faint = false;  ///< what lies below an area is seen through it
};

inline constexpr double faint_opacity = 0.18;

/// A line of text; its middle is there, or its left or right end.
struct words {
    enum class anchor : unsigned char { left, middle, right };

    place at;
    std::string text;
    anchor end = anchor::left;
    std::string power{};  ///< raised and smaller, behind the text
    int angle = 0;        ///< in degrees, counter-clockwise
};

inline constexpr double power_size = 0.7;  ///< of the font's
inline constexpr double power_rise = 0.4;
inline constexpr double baseline = 0.35;  ///< below the middle of a line

struct sheet {
    double width;
    double height;
    std::vector<std::variant<strokes, words>> parts;  ///< each covers those before it
};

[[nodiscard]] sheet sheet_of(const figure& f);

[[nodiscard]] std::string svg_of(const sheet& s);
[[nodiscard]] std::string pdf_of(const sheet& s);

}  // namespace aabblab
