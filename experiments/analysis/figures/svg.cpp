module aabblab.figures;

import aabblab.fmt;
import aabblab.markup;
import aabblab.svg;
import :sheet;

namespace aabblab {

namespace {

constexpr double em = 16;  // in pixels

struct svg_writer {
    double height;
    svg_picture picture{};

    /// Writes lines, or areas (strokes without a width), as one path; lengths in ems become pixels.
    void operator()(strokes s) {
        for (std::vector<place>& line : s.lines)
            for (place& p : line) p = in_pixels(p);
        std::string dashes;
        for (const double length : s.dashes) dashes += (dashes.empty() ? "" : " ") + short_number(length * em);
        const bool is_area = s.width == 0;
        picture.path(/*kind=*/"", s.lines, s.closed,
                     {{"fill", is_area ? s.colour : "none"},
                      {"fill-opacity", s.faint ? short_number(faint_opacity) : ""},
                      {"stroke", is_area ? "" : s.colour},
                      {"stroke-width", is_area ? "" : short_number(s.width * em)},
                      {"stroke-dasharray", dashes},
                      {"stroke-linecap", s.round ? "round" : ""}});
    }

    /// Writes a line of text with its superscript, turned about its anchor (the left end, middle or right end).
    void operator()(const words& w) {
        constexpr std::array<std::string_view, 3> anchors = {"start", "middle", "end"};
        const place at = in_pixels(w.at);
        const std::string turn = fmt::format("rotate({} {} {})", -w.angle, short_number(at.x), short_number(at.y));
        picture.text("", at, w.text,
                     {{"dy", baseline * w.size * em},
                      {"font-size", w.size == 1 ? "" : short_number(w.size * em)},
                      {"text-anchor", anchors[static_cast<std::size_t>(w.end)]},
                      {"transform", w.angle == 0 ? "" : turn}},
                     w.power.empty() ? "" : svg_power(w.power, power_rise * em, power_size * em));
    }

private:
    [[nodiscard]] place in_pixels(const place& p) const { return {p.x * em, (height - p.y) * em}; }
};

}  // namespace

std::string svg_of(const sheet& s) {
    svg_writer to{s.height};
    for (const auto& part : s.parts) std::visit(to, part);
    return to.picture.file(s.width * em, s.height * em, em);
}

}  // namespace aabblab
