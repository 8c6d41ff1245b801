module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

module aabblab.figures;

import :drawing;
import :layout;
import :scale;
import :text;

namespace aabblab {

namespace {

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

[[nodiscard]] std::vector<shown_series> shown(const figure& f) {
    std::vector<shown_series> all;
    for (std::size_t i = 0; i < f.lines.size(); ++i) {
        shown_series s{&f.lines[i], i + 1, points_of(f.lines[i]), false};
        std::erase_if(s.points, [&](const figure_point& p) {
            return !has_place(f.y, p.y) || (!s.is(series_style::level) && !has_place(f.x, p.x));
        });
        s.varies = std::ranges::any_of(s.points, [](const figure_point& p) { return p.low < p.high; });
        if (!s.points.empty()) all.push_back(std::move(s));
    }
    return all;
}

[[nodiscard]] std::vector<figure_mark> shown_marks(const figure& f) {
    std::vector<figure_mark> marks = f.marks;
    std::erase_if(marks, [&](const figure_mark& m) { return !has_place(f.x, m.x); });
    std::ranges::sort(marks, {}, &figure_mark::x);
    return marks;
}

[[nodiscard]] scale axis_scale(const figure_axis& axis, extent values, scale_end end) {
    std::vector<tick> names;
    const double half = half_gap(axis);
    for (const auto& [at, name] : axis.names) {
        if (!has_place(axis, at)) continue;
        names.push_back({at, name});
        values.include(axis.logarithmic ? at / half : at - half);
        values.include(axis.logarithmic ? at * half : at + half);
    }
    if (values.least > values.greatest) values = axis.logarithmic ? extent{1, 10} : extent{0, 1};
    if (names.empty()) return scale_of(values.least, values.greatest, axis.logarithmic, end);
    return {values.least, values.greatest, axis.logarithmic, names, true};
}

/// The labels of the ticks as wide as they look.
[[nodiscard]] std::vector<placed_text> placed(const scale& s) {
    std::vector<placed_text> texts;
    for (const tick& t : s.ticks) {
        std::string text = t.label;
        if (!s.named) std::erase_if(text, [](char c) { return c == '^' || c == '{' || c == '}'; });
        if (!text.empty()) texts.emplace_back(s.place(t.at), text);
    }
    return texts;
}

}  // namespace

std::vector<figure_point> points_of(const series& s) {
    std::vector<figure_point> points;
    for (figure_point p : s.points) {
        if (!std::isfinite(p.y) || (s.style != series_style::level && !std::isfinite(p.x))) continue;
        if (!std::isfinite(p.low) || !std::isfinite(p.high) || !(p.low < p.high)) p.low = p.high = p.y;
        points.push_back(p);
        if (s.style == series_style::level) break;
    }
    return points;
}

double half_gap(const figure_axis& axis) {
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < axis.names.size(); ++i) {
        const double one = axis.names[i - 1].first;
        const double next = axis.names[i].first;
        gap = std::min(gap, axis.logarithmic ? std::sqrt(next / one) : (next - one) / 2);
    }
    if (std::isfinite(gap)) return gap;
    return axis.logarithmic ? 2 : 0.5;
}

drawing::drawing(const figure& of) : f(of), lines(shown(of)), marks(shown_marks(of)) {
    extent x_values;
    extent y_values;
    for (const shown_series& s : lines)
        for (const figure_point& p : s.points) {
            if (!s.is(series_style::level)) x_values.include(p.x);
            for (const double value : {p.low, p.y, p.high})
                if (has_place(f.y, value)) y_values.include(value);
        }
    for (const figure_mark& m : marks) x_values.include(m.x);
    x = axis_scale(f.x, x_values, scale_end::near_values);
    y = axis_scale(f.y, y_values, scale_end::on_ticks);
    if (y.named)
        for (tick& name : y.ticks) name.label = with_breaks(name.label, y_name_length);
    contents parts;
    parts.x_label = f.x.label;
    parts.y_label = f.y.label;
    parts.x_named = x.named;
    parts.y_named = y.named;
    parts.x_ticks = placed(x);
    parts.y_ticks = placed(y);
    for (const shown_series& s : lines) parts.legend.push_back(s.source->label);
    for (const figure_mark& m : marks) parts.marks.emplace_back(x.place(m.x), m.label);
    room = layout_of(parts);
}

}  // namespace aabblab
