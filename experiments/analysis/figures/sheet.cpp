module aabblab.figures;

import :drawing;
import :arrangement;
import :sheet;

namespace aabblab {

namespace {

// Each series has a colour and, for black and white, a dash pattern and a sign of its own.

/// The colour-blind safe palette of Okabe and Ito (2008), with grey instead of yellow, which is too light on white.
constexpr std::array<std::string_view, 8> colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                     "#E69F00", "#56B4E9", "#000000", "#8C8C8C"};

/// Lengths of dash, gap, dash, gap in tenths of an em; the first is solid.
const std::array<std::vector<double>, 10> dashes = {{{},
                                                     {8, 3},
                                                     {2.5, 2.5},
                                                     {10, 2.5, 2.5, 2.5},
                                                     {16, 4},
                                                     {10, 2.5, 2.5, 2.5, 2.5, 2.5},
                                                     {5, 2.5},
                                                     {16, 3, 2.5, 3},
                                                     {1.5, 4},
                                                     {10, 3, 5, 3}}};

/// The sign of a point: a regular polygon, a disc (no corners), or a cross of two lines.
struct sign {
    int corners;
    double turn;  ///< of the first corner from the right, in degrees
    bool is_open;
    double size;  ///< radius in ems, chosen so that all look equally large
};
constexpr int is_disc = 0;
constexpr int is_cross = 2;
/// Ordered so that neighbours are easy to distinguish: discs, open squares, triangles, …
constexpr std::array<sign, 10> signs = {{{is_disc, 0, false, 0.25},
                                         {4, 45, true, 0.33},
                                         {3, 90, false, 0.38},
                                         {4, 0, true, 0.4},
                                         {4, 45, false, 0.33},
                                         {20, 0, true, 0.26},
                                         {3, -90, false, 0.38},
                                         {is_cross, 45, true, 0.33},
                                         {4, 0, false, 0.36},
                                         {3, 90, true, 0.38}}};

constexpr std::string_view frame_colour = "#404040";
constexpr std::string_view grid_colour = "#E0E0E0";
constexpr std::string_view background_colour = "#FFFFFF";
constexpr double line_width = 0.14;
constexpr double frame_width = 0.09;
constexpr double thin = 0.06;

using places = std::vector<place>;

/// Adds the outlines of a sign (the symbol of a point), centred at a place. A disc is a point with a round cap.
void add_sign(const sign& s, place centre, std::vector<places>& outlines) {
    if (s.corners == is_disc) return outlines.push_back({centre});
    const auto corner = [&](int i, int count) {
        const double angle = (s.turn + 360. * i / count) * std::numbers::pi / 180;
        return place{centre.x + s.size * std::cos(angle), centre.y + s.size * std::sin(angle)};
    };
    if (s.corners == is_cross) {
        outlines.push_back({corner(0, 4), corner(2, 4)});
        outlines.push_back({corner(1, 4), corner(3, 4)});
        return;
    }
    places& outline = outlines.emplace_back();
    for (int i = 0; i < s.corners; ++i) outline.push_back(corner(i, s.corners));
}

/// Turns the laid-out parts of a figure into lines, areas and texts.
class painter {
public:
    explicit painter(const figure& f)
        : drawing_(f), layout_(arranger(drawing_).arranged()), sheet_{layout_.width, layout_.height, {}} {}

    /// Paints each panel from back to front, then the texts and the legend, as the layout places them.
    sheet painted() && {
        for (std::size_t i = 0; i < drawing_.panels.size(); ++i) {
            plot_ = &layout_.plots[i];     // the edges of the panel that is painted
            panel_ = &drawing_.panels[i];  // and its content
            draw_grid();
            for (const shown_series& s : panel_->lines) draw_band(s);
            draw_marks();
            for (const shown_series& s : panel_->lines) {
                draw_bars(s);
                draw_line(s);
            }
            draw_frame();
        }
        if (drawing_.empty()) write({{middle_x(), middle_y()}, "no data", words::anchor::middle});
        for (const auto& [line, appearance] : layout_.leaders)
            stroke({{line.from, line.to}}, colour_of(appearance), thin);
        for (const words& text : layout_.texts) write(text);
        for (const arrangement::sample& s : layout_.samples) draw_sample(s);
        return std::move(sheet_);
    }

private:
    void write(words w) {
        w.text = one_line(w.text);
        sheet_.parts.emplace_back(std::move(w));
    }
    void write(const std::vector<std::string>& lines, place top, words::anchor end, const std::string& power) {
        const places centres = lines_below(top, lines.size());
        for (std::size_t i = 0; i < lines.size(); ++i) write({centres[i], lines[i], end, power});
    }
    void stroke(std::vector<places> lines, std::string_view colour, double thickness,
                std::vector<double> pattern = {}) {
        sheet_.parts.emplace_back(strokes{std::move(lines), colour, thickness, std::move(pattern)});
    }
    void stroke_series(std::vector<places> lines, std::size_t appearance, bool is_dashed) {
        std::vector<double> lengths;
        if (is_dashed)
            for (const double tenths : dashes[appearance % dashes.size()]) lengths.push_back(tenths / 10);
        stroke(std::move(lines), colour_of(appearance), line_width, std::move(lengths));
    }
    /// Draws the sign (disc, square, …) of a series at each place.
    /// @param appearance the index of its colour and sign
    void put_signs(const places& centres, std::size_t appearance) {
        const sign& s = signs[appearance % signs.size()];
        strokes drawn{{}, colour_of(appearance)};
        for (const place& p : centres) add_sign(s, p, drawn.lines);
        drawn.closed = s.corners > is_cross;  // a polygon
        drawn.round = s.corners == is_disc;
        if (s.is_open) drawn.width = frame_width;   // without a width, the area is filled
        if (drawn.round) drawn.width = 2 * s.size;  // the caps of a point are the disc
        if (!centres.empty()) sheet_.parts.emplace_back(std::move(drawn));
    }
    void fill(places outline, std::size_t appearance) {
        sheet_.parts.emplace_back(
            strokes{.lines = {std::move(outline)}, .colour = colour_of(appearance), .closed = true, .faint = true});
    }
    static std::string_view colour_of(std::size_t appearance) { return colours[appearance % colours.size()]; }

    [[nodiscard]] double x(double value) const {
        return plot_->left + drawing_.x.place(value) * (plot_->right - plot_->left);
    }
    [[nodiscard]] double y(double value) const {
        return plot_->bottom + drawing_.y.place(value) * (plot_->top - plot_->bottom);
    }
    [[nodiscard]] double middle_x() const { return (plot_->left + plot_->right) / 2; }
    [[nodiscard]] double middle_y() const { return (plot_->bottom + plot_->top) / 2; }
    /// The y of the lower quartile, clamped to the axis if it is logarithmic, where it may not be positive.
    [[nodiscard]] double low(const figure_point& p) const {
        return y(drawing_.y.logarithmic ? std::max(p.low, drawing_.y.from) : p.low);
    }
    /// The x of the lower limit, clamped likewise.
    [[nodiscard]] double x_low(const figure_point& p) const {
        return x(drawing_.x.logarithmic ? std::max(p.x_low, drawing_.x.from) : p.x_low);
    }

    /// The horizontal shift of a series of points, so that n series are side by side over a name: k - (n - 1)/2 steps
    /// of min(0.3, 1.4/n) h, with h half the distance of two names, so that all stay within 0.7 h.
    [[nodiscard]] double shift_of(const shown_series& s) const {
        if (!drawing_.x.named || drawing_.x.logarithmic || !s.is(series_style::points)) return 0;
        double count = 0, before = 0;  // of series with points
        for (const shown_series& other : panel_->lines) {
            if (!other.is(series_style::points)) continue;
            if (&other < &s) ++before;
            ++count;
        }
        return (before - (count - 1) / 2) * std::min(0.3, 1.4 / count) * half_gap(drawing_.f.x);
    }

    /// Draws a thin line across the plot at each tick with a label. x() and y() convert values of the axes to places.
    void draw_grid() {
        std::vector<places> lines;
        for (const tick& t : layout_.x_ticks)
            if (!t.label.empty()) lines.push_back({{x(t.at), plot_->bottom}, {x(t.at), plot_->top}});
        for (const tick& t : drawing_.y.ticks)
            if (!t.label.empty()) lines.push_back({{plot_->left, y(t.at)}, {plot_->right, y(t.at)}});
        stroke(std::move(lines), grid_colour, thin);
    }

    /// Fills the area between the quartiles of a line, or of a level (a horizontal line across the plot).
    void draw_band(const shown_series& s) {
        if (!s.varies || !s.has_band()) return;
        if (s.is(series_style::level)) {
            const double bottom = low(s.points.front());
            const double top = y(s.points.front().high);
            fill({{plot_->left, bottom}, {plot_->left, top}, {plot_->right, top}, {plot_->right, bottom}},
                 s.appearance);
        } else {
            places outline;
            for (const figure_point& p : s.points) outline.push_back({x(p.x), y(p.high)});
            for (auto p = s.points.rbegin(); p != s.points.rend(); ++p) outline.push_back({x(p->x), low(*p)});
            fill(std::move(outline), s.appearance);
        }
    }

    /// Draws bars at each point of a series without a band: from the lower to the upper quartile, and across the
    /// interval of x.
    void draw_bars(const shown_series& s) {
        if (s.has_band()) return;
        const double shift = shift_of(s);
        std::vector<places> lines;
        for (const figure_point& p : s.points) {
            if (p.low < p.high) lines.push_back({{x(p.x + shift), low(p)}, {x(p.x + shift), y(p.high)}});
            if (p.x_low < p.x_high) lines.push_back({{x_low(p), y(p.y)}, {x(p.x_high), y(p.y)}});
        }
        if (!lines.empty()) stroke_series(std::move(lines), s.appearance, /*is_dashed=*/false);
    }

    /// Draws a series: the line that joins its points and their signs, or a level, a horizontal line across the plot.
    void draw_line(const shown_series& s) {
        if (s.is(series_style::level)) {
            const double height = y(s.points.front().y);
            return stroke_series({{{plot_->left, height}, {plot_->right, height}}}, s.appearance, /*is_dashed=*/true);
        }
        const double shift = shift_of(s);
        places points;
        for (const figure_point& p : s.points) points.push_back({x(p.x + shift), y(p.y)});
        if (s.is_joined()) stroke_series({points}, s.appearance, /*is_dashed=*/true);
        // Signs at all points of a long line would merge into one thick line.
        constexpr std::size_t readable = 20;
        const std::size_t step = s.is_joined() && points.size() > readable ? points.size() / (readable / 2) : 1;
        places sparse;
        for (std::size_t i = 0; i < points.size(); i += step) sparse.push_back(points[i]);
        put_signs(sparse, s.appearance);
    }

    void draw_marks() {
        for (std::size_t i = 0; i < panel_->marks.size(); ++i) {
            const double mark_x = x(panel_->marks[i].x);
            stroke({{{mark_x, plot_->bottom}, {mark_x, plot_->mark_tops[i]}}}, frame_colour, thin, {0.15, 0.25});
        }
        for (const auto& [low, high] : plot_->gaps)
            sheet_.parts.emplace_back(strokes{
                .lines = {{low, {high.x, low.y}, high, {low.x, high.y}}}, .colour = background_colour, .closed = true});
    }

    /// Draws the axes with ticks. Inner plots share the labels of outer ones; long names below may be turned.
    void draw_frame() {
        const auto& [left, right, bottom, top, has_x, has_y, mark_tops, gaps] = *plot_;
        std::vector<places> lines{{{left, top}, {left, bottom}, {right, bottom}}};
        const auto length = [](const tick& t) { return t.label.empty() ? 0.2 : 0.4; };
        for (const tick& t : layout_.x_ticks) lines.push_back({{x(t.at), bottom}, {x(t.at), bottom - length(t)}});
        for (const tick& t : drawing_.y.ticks) lines.push_back({{left, y(t.at)}, {left - length(t), y(t.at)}});
        stroke(std::move(lines), frame_colour, frame_width);
        constexpr double to_label = tick_room - 0.2;
        for (const tick& t : layout_.x_ticks)
            if (has_x && layout_.x_name_angle != 0)
                write({{x(t.at), bottom - to_label}, t.label, words::anchor::right, {}, layout_.x_name_angle});
            else if (has_x && !t.label.empty())
                write(lines_of(drawing_.x, t, layout_.x_name_length), {x(t.at), bottom - to_label},
                      words::anchor::middle, t.power);
        for (const tick& t : drawing_.y.ticks) {
            if (!has_y || t.label.empty()) continue;
            const std::vector<std::string> texts = lines_of(drawing_.y, t, y_name_length);
            const double half = line_height * static_cast<double>(texts.size()) / 2;
            write(texts, {left - to_label, y(t.at) + half}, words::anchor::right, t.power);
        }
    }

    /// Draws a series' sign beside its label: at the end of its line, or on a short line in the legend.
    void draw_sample(const arrangement::sample& s) {
        if (s.is_end) return put_signs({s.at}, s.label->appearance);
        constexpr double length = 4.4;  // of the line, in ems
        const auto [x, y] = s.at;
        if (s.label->style != series_style::points)
            stroke_series({{{x, y}, {x + length, y}}}, s.label->appearance, /*is_dashed=*/true);
        if (s.label->style != series_style::level) put_signs({{x + length / 2, y}}, s.label->appearance);
    }

    drawing drawing_;
    arrangement layout_;
    sheet sheet_;
    const arrangement::box* plot_ = nullptr;
    const shown_panel* panel_ = nullptr;
};

}  // namespace

sheet sheet_of(const figure& f) {
    return painter(f).painted();
}

}  // namespace aabblab
