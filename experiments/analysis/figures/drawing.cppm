/// Prepares a figure for drawing: selects the points that can be shown, and scales the axes.
module aabblab.figures:drawing;

import aabb.std;
import aabblab.scale;
import aabblab.text;
import aabblab.figures;

namespace aabblab {

/// The points of a series that the figure's CSV file lists: all finite ones, or only the first for a level (a
/// horizontal line across the plot, for which x does not matter). Without valid quartiles, `low` and `high` become y;
/// without a valid interval, `x_low` and `x_high` become x.
[[nodiscard]] std::vector<figure_point> points_of(const series& s) {
    std::vector<figure_point> points;
    for (figure_point p : s.points) {
        if (!std::isfinite(p.y) || (s.style != series_style::level && !std::isfinite(p.x))) continue;
        if (!std::isfinite(p.low) || !std::isfinite(p.high) || !(p.low < p.high)) p.low = p.high = p.y;
        if (!std::isfinite(p.x_low) || !std::isfinite(p.x_high) || !(p.x_low < p.x_high)) p.x_low = p.x_high = p.x;
        points.push_back(p);
        if (s.style == series_style::level) break;
    }
    return points;
}

/// A series with its number in the figure's CSV file: first those that all panels share, then those of each panel.
struct numbered_series {
    const series* source;
    std::size_t number;         ///< from 1
    const figure_panel* panel;  ///< null if all panels share it
};

[[nodiscard]] std::vector<numbered_series> numbered_series_of(const figure& f) {
    std::vector<numbered_series> list;
    for (const series& s : f.lines) list.push_back({&s, list.size() + 1, nullptr});
    for (const figure_panel& panel : f.panels)
        for (const series& s : panel.lines) list.push_back({&s, list.size() + 1, &panel});
    return list;
}

/// Half the distance of the two nearest names, the room beside a name; on a logarithmic axis the root of their ratio.
[[nodiscard]] double half_gap(const figure_axis& axis) {
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < axis.names.size(); ++i) {
        const double previous = axis.names[i - 1].first;
        const double next = axis.names[i].first;
        gap = std::min(gap, axis.logarithmic ? std::sqrt(next / previous) : (next - previous) / 2);
    }
    if (std::isfinite(gap)) return gap;
    return axis.logarithmic ? 2 : 0.5;
}

/// The part of a series that can be shown.
struct shown_series {
    const series* source;
    std::size_t appearance;  ///< index of colour, dashes and sign; series with one label in several panels share it
    std::vector<figure_point> points;
    bool varies;  ///< has quartiles to show

    [[nodiscard]] bool is(series_style style) const { return source->style == style; }
    [[nodiscard]] bool is_joined() const {
        return (is(series_style::line) || is(series_style::curve)) && points.size() > 1;
    }
    /// Whether a band shows the quartiles, not a bar at each point.
    [[nodiscard]] bool has_band() const { return is(series_style::level) || (is(series_style::line) && is_joined()); }
};

struct shown_panel {
    std::string title;
    std::vector<shown_series> lines;
    std::vector<figure_mark> marks;  ///< from left to right
};

/// An entry of the legend, or a label at the end of a line.
struct shown_label {
    std::string text;
    std::size_t appearance;
    series_style style;  ///< `points` for a line with a single point
};

inline constexpr std::size_t y_name_length = 32;  ///< maximum line length of names on the y axis

struct extent {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();

    void include(double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
};

[[nodiscard]] bool has_place(const figure_axis& axis, double value) {
    return std::isfinite(value) && (!axis.logarithmic || value > 0);
}

/// The index of each series' colour, dashes and sign; series with one label in several panels share them.
[[nodiscard]] std::vector<std::size_t> appearances_of(const figure& f, const std::vector<numbered_series>& lines) {
    std::vector<std::size_t> appearances;
    std::vector<const series*> first;  // the first series of each appearance
    for (const numbered_series& s : lines) {
        const auto known = std::ranges::find_if(first, [&](const series* other) {
            return !f.panels.empty() && !other->label.empty() && other->label == s.source->label;
        });
        appearances.push_back(static_cast<std::size_t>(known - first.begin()));
        if (known == first.end()) first.push_back(s.source);
    }
    return appearances;
}

/// The marks of the figure and of a panel that the x axis can show, from left to right.
[[nodiscard]] std::vector<figure_mark> shown_marks(const figure& f, const figure_panel* panel) {
    std::vector<figure_mark> marks = f.marks;
    if (panel != nullptr) marks.insert(marks.end(), panel->marks.begin(), panel->marks.end());
    std::erase_if(marks, [&](const figure_mark& m) { return !has_place(f.x, m.x); });
    std::ranges::sort(marks, {}, &figure_mark::x);
    return marks;
}

/// The panels, or the figure as one, with the series and points that can be shown: positive ones on logarithmic axes.
[[nodiscard]] std::vector<shown_panel> shown_panels_of(const figure& f) {
    const std::vector<numbered_series> series_list = numbered_series_of(f);
    const std::vector<std::size_t> appearances = appearances_of(f, series_list);
    std::vector<shown_panel> panels;
    for (std::size_t i = 0; i < std::max<std::size_t>(f.panels.size(), 1); ++i) {
        const figure_panel* const panel = f.panels.empty() ? nullptr : &f.panels[i];
        shown_panel& to = panels.emplace_back(panel == nullptr ? "" : panel->title);
        to.marks = shown_marks(f, panel);
        for (std::size_t k = 0; k < series_list.size(); ++k) {
            if (series_list[k].panel != nullptr && series_list[k].panel != panel) continue;
            shown_series s{series_list[k].source, appearances[k], points_of(*series_list[k].source), /*varies=*/false};
            std::erase_if(s.points, [&](const figure_point& p) {
                return !has_place(f.y, p.y) || (!s.is(series_style::level) && !has_place(f.x, p.x));
            });
            s.varies = std::ranges::any_of(s.points, [](const figure_point& p) { return p.low < p.high; });
            if (!s.points.empty()) to.lines.push_back(std::move(s));
        }
    }
    return panels;
}

/// The legend's entries, one per appearance; a line is a point if every panel has only a single point of it.
[[nodiscard]] std::vector<shown_label> labels_of(const std::vector<shown_panel>& panels) {
    std::vector<shown_label> labels;
    for (const shown_panel& panel : panels)
        for (const shown_series& s : panel.lines) {
            const bool is_single_point = !s.is(series_style::level) && !s.is_joined();
            const series_style style = is_single_point ? series_style::points : s.source->style;
            const auto known = std::ranges::find(labels, s.appearance, &shown_label::appearance);
            if (known == labels.end())
                labels.push_back({s.source->label, s.appearance, style});
            else if (s.is_joined())
                known->style = style;
        }
    return labels;
}

/// Scales an axis to its values or, with half a distance on either side, to its names.
/// @param end whether a linear axis ends near the values or on a tick
[[nodiscard]] scale axis_scale(const figure_axis& axis, extent values, scale_end end) {
    std::vector<tick> names;
    const double half = half_gap(axis);  // a factor on a logarithmic axis
    for (const auto& [at, name] : axis.names) {
        if (!has_place(axis, at)) continue;
        names.push_back({at, name, /*power=*/{}});
        values.include(axis.logarithmic ? at / half : at - half);
        values.include(axis.logarithmic ? at * half : at + half);
    }
    if (values.least > values.greatest) values = axis.logarithmic ? extent{1, 10} : extent{0, 1};
    if (names.empty()) return scale_of(values.least, values.greatest, axis.logarithmic, end);
    return {values.least, values.greatest, axis.logarithmic, names, /*named=*/true};
}

/// A prepared figure; it refers to the original, which must outlive it.
struct drawing {
    /// Selects what can be shown, and scales both axes to points, quartiles and marks; a level has no x.
    explicit drawing(const figure& source) : f(source), panels(shown_panels_of(source)), labels(labels_of(panels)) {
        extent x_values;
        extent y_values;
        for (const shown_panel& panel : panels) {
            for (const shown_series& s : panel.lines)
                for (const figure_point& p : s.points) {
                    if (!s.is(series_style::level)) x_values.include(p.x);
                    if (!s.has_band())
                        for (const double value : {p.x_low, p.x_high})
                            if (has_place(f.x, value)) x_values.include(value);
                    for (const double value : {p.low, p.y, p.high})
                        if (has_place(f.y, value)) y_values.include(value);
                }
            for (const figure_mark& m : panel.marks) x_values.include(m.x);
        }
        x = axis_scale(f.x, x_values, scale_end::near_values);
        y = axis_scale(f.y, y_values, scale_end::on_ticks);
        if (y.named)
            for (tick& name : y.ticks) name.label = with_breaks(name.label, y_name_length);
    }

    const figure& f;
    std::vector<shown_panel> panels;
    std::vector<shown_label> labels;
    scale x;
    scale y;

    [[nodiscard]] bool empty() const {
        return std::ranges::all_of(panels, [](const shown_panel& panel) { return panel.lines.empty(); });
    }
};

}  // namespace aabblab
