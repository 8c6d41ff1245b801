module aabblab.figures;

import aabblab.fmt;
import aabblab.markup;
import :sheet;

namespace aabblab {

namespace {

constexpr double em = 16;  // in pixels

class svg_writer {
public:
    explicit svg_writer(double height) : height_(height) {}

    std::string operator()(const strokes& s) const {
        std::string d;
        for (const std::vector<place>& line : s.lines) {
            for (const place& p : line) d += (&p == line.data() ? "M" : "L") + x(p) + " " + y(p);
            if (line.size() == 1) d += "h0";
            if (s.closed) d += "z";
        }
        std::string dashes;
        for (const double length : s.dashes) dashes += (dashes.empty() ? "" : " ") + short_number(length * em);
        const bool is_area = s.width == 0;
        return element("path", {{"d", d},
                                {"fill", is_area ? s.colour : "none"},
                                {"fill-opacity", s.faint ? short_number(faint_opacity) : ""},
                                {"stroke", is_area ? "" : s.colour},
                                {"stroke-width", is_area ? "" : short_number(s.width * em)},
                                {"stroke-dasharray", dashes},
                                {"stroke-linecap", s.round ? "round" : ""}});
    }

    std::string operator()(const words& w) const {
        constexpr std::array<std::string_view, 3> anchors = {"start", "middle", "end"};
        std::string content = markup_text(w.text);
        if (!w.power.empty())
            content +=
                element("tspan", {{"dy", -power_rise * em}, {"font-size", power_size * em}}, markup_text(w.power));
        const std::string turn = w.angle == 0 ? "" : fmt::format("rotate({} {} {})", -w.angle, x(w.at), y(w.at));
        return element("text",
                       {{"x", x(w.at)},
                        {"y", y(w.at)},
                        {"dy", baseline * em},
                        {"text-anchor", anchors[static_cast<std::size_t>(w.end)]},
                        {"transform", turn}},
                       content);
    }

private:
    [[nodiscard]] static std::string x(const place& p) { return short_number(p.x * em); }
    [[nodiscard]] std::string y(const place& p) const { return short_number((height_ - p.y) * em); }

    double height_;
};

}  // namespace

std::string svg_of(const sheet& s) {
    std::string content = "\n" + element("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "white"}}) + "\n";
    for (const auto& part : s.parts) content += std::visit(svg_writer(s.height), part) + "\n";
    return element("svg",
                   {{"xmlns", "http://www.w3.org/2000/svg"},
                    {"width", s.width * em},
                    {"height", s.height * em},
                    {"viewBox", fmt::format("0 0 {} {}", short_number(s.width * em), short_number(s.height * em))},
                    {"font-family", "sans-serif"},
                    {"font-size", em}},
                   content) +
           "\n";
}

}  // namespace aabblab
