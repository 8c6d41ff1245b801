module;
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.picture;

import aabb.geometry;
import :panel;
import :survey;

namespace aabblab {

namespace {

constexpr double wide_panel = 2 * panel_side + left_margin + gap;
constexpr double narrowest = 1.0 / 8;  // a panel's one side over the other

/// 1, 2 or 5 times a power of ten, so that at most `most` of them fit into the length.
double tick_step(double length, double most) {
    double step = std::pow(10, std::floor(std::log10(length / most)));
    for (const double factor : {2.0, 2.5, 2.0})
        if (length / step > most) step *= factor;
    return step;
}

std::vector<double> ticks(const view_plane& view, int axis, double pixels, double pixels_each) {
    const double least = view.least(axis);
    const double step = tick_step(view.length(axis), std::max(2.0, pixels / pixels_each));
    std::vector<double> values;
    // Counted, since far from 0 the next tick may be rounded to the same value.
    for (int i = 0; i <= view.length(axis) / step; ++i) {
        const double value = (std::ceil(least / step) + i) * step;
        if (value <= least + view.length(axis)) values.push_back(value + 0.0);  // -0 is 0
    }
    return values;
}

std::string axes_of(const view_plane& view) {
    std::string svg;
    for (const double value : ticks(view, view.across(), view.width(), 80))
        fmt::format_to(std::back_inserter(svg),
                       "<path class=\"tick\" d=\"M{0:.1f} {1:.1f}v5\"/>"
                       "<text x=\"{0:.1f}\" y=\"{2:.1f}\" text-anchor=\"middle\">{3:g}</text>\n",
                       view.x(value), view.height(), view.height() + 19, value);
    for (const double value : ticks(view, view.up(), view.height(), 40))
        fmt::format_to(std::back_inserter(svg),
                       "<path class=\"tick\" d=\"M0 {0:.1f}h-5\"/>"
                       "<text x=\"-9\" y=\"{1:.1f}\" text-anchor=\"end\">{2:g}</text>\n",
                       view.y(value), view.y(value) + 4, value);
    constexpr std::array<std::string_view, 3> names = {"x", "y", "z"};
    fmt::format_to(std::back_inserter(svg),
                   "<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
                   "<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                   view.width() / 2, view.height() + 36, names[static_cast<std::size_t>(view.across())],
                   8 - left_margin, view.height() / 2 + 4, names[static_cast<std::size_t>(view.up())]);
    return svg;
}

struct rectangle {
    double left, top, width, height;
};

rectangle shown(const view_plane& view, const aabb::box& b) {
    const double left = view.x(b.min[view.across()]);
    const double top = view.y(b.max[view.up()]);
    // What is smaller than a pixel is still to be seen.
    return {left, top, std::max(1.0, view.x(b.max[view.across()]) - left),
            std::max(1.0, view.y(b.min[view.up()]) - top)};
}

void draw_box(std::string& svg, const rectangle& r, std::string_view kind) {
    fmt::format_to(std::back_inserter(svg),
                   "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", kind, r.left,
                   r.top, r.width, r.height);
}

std::string boxes_of(const view_plane& view, const survey::frame& frame, const frame_drawing& drawing) {
    double area = 0;
    std::string boxes;
    std::string outlines;
    for (std::size_t i = 0; i < drawing.drawn.size(); ++i) {
        const std::size_t object = drawing.drawn[i];
        const rectangle r = shown(view, frame.boxes[object]);
        area += r.width * r.height;
        draw_box(boxes, r, drawing.overlapping[object] != 0 ? "overlapping" : "apart");
        if (i < drawing.huge) draw_box(outlines, r, "huge");
    }
    // The more boxes lie behind one another, the more is seen through each.
    const double depth = area / (view.width() * view.height());
    return fmt::format("<g fill-opacity=\"{:.2f}\" stroke-opacity=\"{:.2f}\">\n{}</g>\n{}",
                       std::clamp(0.6 / depth, 0.03, 0.35), std::clamp(1.5 / depth, 0.1, 0.8), boxes, outlines);
}

void draw_path(std::string& svg, const view_plane& view, const survey::path& path) {
    std::string d;
    bool pen_down = false;
    for (const auto& place : path) {
        if (place)
            fmt::format_to(std::back_inserter(d), "{}{:.1f} {:.1f}", pen_down ? 'L' : 'M',
                           view.x((*place)[view.across()]), view.y((*place)[view.up()]));
        pen_down = place.has_value();
    }
    if (!d.empty()) fmt::format_to(std::back_inserter(svg), "<path class=\"way\" d=\"{}\"/>\n", d);
}

}  // namespace

view_plane::view_plane(const aabb::box& world, const aabb::vec3d& sides) {
    for (int k = 0; k < 3; ++k) {
        const bool is_empty = world.min[k] > world.max[k];
        least_[k] = is_empty ? 0 : double{world.min[k]};
        length_[k] = is_empty ? 0 : double{world.max[k]} - least_[k];
        if (length_[k] > 0) continue;
        least_[k] -= 0.5;
        length_[k] = 1;
    }
    // A single box has no flat axis to leave out.
    aabb::vec3d weight = sides == aabb::vec3d{} ? length_ : sides;
    weight[2] *= 4;
    int left_out = 2;
    for (const int k : {1, 0})
        if (weight[k] < weight[left_out]) left_out = k;
    across_ = left_out == 0 ? 1 : 0;
    up_ = left_out == 2 ? 1 : 2;
    const double ratio = length_[up_] / length_[across_];
    const double shown = std::clamp(ratio, narrowest, 1 / narrowest);
    equal_scales_ = ratio == shown;
    width_ = shown < 0.4 ? wide_panel : shown <= 1 ? panel_side : panel_side / shown;
    height_ = width_ * shown;
    scale_[across_] = width_ / length_[across_];
    scale_[up_] = height_ / length_[up_];
}

std::string panel_of(const view_plane& view, pixel corner, std::string_view title, const survey::frame& frame,
                     const frame_drawing& drawing, std::span<const survey::path> paths) {
    std::string svg = fmt::format(
        "<g transform=\"translate({:.1f} {:.1f})\">\n<text class=\"title\" x=\"0\" y=\"-10\">{}</text>\n"
        "<rect class=\"world\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
        corner.x, corner.y, title, view.width(), view.height());
    svg += axes_of(view);
    svg += boxes_of(view, frame, drawing);
    for (const survey::path& path : paths) draw_path(svg, view, path);
    return svg + "</g>\n";
}

std::size_t clear_paths(const view_plane& view, std::span<const survey::path> paths) {
    const double most = 8 * (view.width() + view.height());
    double length = 0;
    std::size_t count = 0;
    while (count < paths.size() && length < most) {
        const survey::path& path = paths[count++];
        for (std::size_t i = 1; i < path.size(); ++i)
            if (path[i - 1] && path[i])
                length += std::hypot(view.x((*path[i])[view.across()]) - view.x((*path[i - 1])[view.across()]),
                                     view.y((*path[i])[view.up()]) - view.y((*path[i - 1])[view.up()]));
    }
    return count;
}

}  // namespace aabblab
