/// Writes pictures as SVG; all SVG goes through this module.
export module aabblab.svg;

import aabb.std;
import aabblab.markup;

export namespace aabblab {

/// A point; unless stated otherwise in pixels from the left and upper edges.
struct place {
    double x, y;
};
using polylines = std::vector<std::vector<place>>;

struct svg_box {
    double left, top, width, height;
};

/// A superscript in a text.
[[nodiscard]] inline std::string svg_power(std::string_view text, double rise, double size) {
    return element("tspan", {{"dy", -rise}, {"font-size", size}}, markup_text(text));
}

/// Elements in painting order. A `kind` is a class of a style sheet; a `look` holds further attributes.
class svg_picture {
public:
    /// @param unit of x and of widths: with "%" the picture fills the available width, and its text keeps its size
    explicit svg_picture(std::string_view unit = "") : unit_(unit) {}

    void line(std::string_view kind, place from, place to) {
        add("line", {{"class", kind}, {"x1", along(from.x)}, {"x2", along(to.x)}, {"y1", from.y}, {"y2", to.y}});
    }
    void rectangle(std::string_view kind, const svg_box& r) {
        add("rect",
            {{"class", kind}, {"x", along(r.left)}, {"y", r.top}, {"width", along(r.width)}, {"height", r.height}});
    }
    void disc(place middle, double radius) {
        add("circle", {{"cx", along(middle.x)}, {"cy", middle.y}, {"r", radius}});
    }
    /// Adds polylines as one path, in pixels. A single point is a line of length 0 ("h0"): only its round caps are
    /// drawn.
    /// @param closed whether each polyline returns to its first point
    void path(std::string_view kind, const polylines& lines, bool closed = false, const attributes& look = {}) {
        std::string d;
        for (const std::vector<place>& line : lines) {
            for (const place& p : line)
                d += (&p == line.data() ? "M" : "L") + short_number(p.x) + " " + short_number(p.y);
            if (line.size() == 1) d += "h0";
            if (closed) d += "z";
        }
        add("path", {{"class", kind}, {"d", d}}, look);
    }
    /// @param behind markup that follows the text
    void text(std::string_view kind, place at, std::string_view text, const attributes& look = {},
              std::string_view behind = "") {
        add("text", {{"class", kind}, {"x", along(at.x)}, {"y", at.y}}, look, markup_text(text).append(behind));
    }
    void group(const svg_picture& of, const attributes& look) { add("g", {}, look, "\n" + of.elements_); }
    /// Places its upper left corner. A nested svg, because a group cannot be moved by a share of the width.
    void put(place at, const svg_picture& other) {
        if (unit_.empty())
            return group(other, {{"transform", "translate(" + short_number(at.x) + " " + short_number(at.y) + ")"}});
        add("svg", {{"x", along(at.x)}, {"y", at.y}, {"overflow", "visible"}}, {}, other.elements_);
    }
    void style(std::string_view css) { add("style", {}, {}, css); }

    [[nodiscard]] std::string in_page(std::string_view kind, std::string_view label, double height) const {
        return element("svg",
                       {{"class", kind}, {"role", "img"}, {"aria-label", label}, {"width", "100%"}, {"height", height}},
                       elements_);
    }
    /// The picture as a file, on a white background.
    [[nodiscard]] std::string file(double width, double height, double font_size) const {
        const std::string paper = element("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "white"}});
        return element("svg",
                       {{"xmlns", "http://www.w3.org/2000/svg"},
                        {"width", width},
                        {"height", height},
                        {"viewBox", "0 0 " + short_number(width) + " " + short_number(height)},
                        {"font-family", "sans-serif"},
                        {"font-size", font_size}},
                       "\n" + paper + "\n" + elements_) +
               "\n";
    }

private:
    void add(std::string_view tag, std::initializer_list<attribute> own, attributes look = {},
             std::optional<std::string_view> content = {}) {
        look.insert(look.begin(), own);
        elements_ += element(tag, look, content) + "\n";
    }
    [[nodiscard]] std::string along(double value) const { return short_number(value) + unit_; }

    std::string unit_, elements_;
};

}  // namespace aabblab
