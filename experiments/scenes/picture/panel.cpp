module;
#include <fmt/format.h>

module aabblab.picture;

import aabb.geometry;
import aabblab.markup;
import aabblab.scale;
import :panel;

namespace aabblab {

namespace {

constexpr double wide_panel = 2 * panel_side + left_margin + gap;
constexpr double narrowest = 1.0 / 8;  // a panel's one side over the other

std::vector<double> ticks(const view_plane& view, int axis, double pixels, double pixels_each) {
    const double length = view.length(axis);
    return round_values(view.least(axis), view.least(axis) + length,
                        round_step(length, std::max(2.0, pixels / pixels_each)));
}

std::string axes_of(const view_plane& view) {
    const double below = view.height();
    std::string svg;
    for (const double value : ticks(view, view.across(), view.width(), 80))
        svg += element("path", {{"class", "tick"},
                                {"d", "M" + short_number(view.x(value)) + " " + short_number(below) + "v5"}}) +
               words_at(view.x(value), below + 19, fmt::format("{:g}", value), "", "middle");
    for (const double value : ticks(view, view.up(), view.height(), 40))
        svg += element("path", {{"class", "tick"}, {"d", "M0 " + short_number(view.y(value)) + "h-5"}}) +
               words_at(-9, view.y(value) + 4, fmt::format("{:g}", value), "", "end");
    return svg + words_at(view.width() / 2, below + 36, name_of_axis(view.across()), "axis", "middle") +
           words_at(8 - left_margin, below / 2 + 4, name_of_axis(view.up()), "axis");
}

/// What is smaller than a pixel is still to be seen.
box_on_plane shown(const view_plane& view, const aabb::box& b) {
    const double left = view.x(b.min[view.across()]);
    const double top = view.y(b.max[view.up()]);
    return {left, top, std::max(1.0, view.x(b.max[view.across()]) - left),
            std::max(1.0, view.y(b.min[view.up()]) - top)};
}

std::string boxes_of(const view_plane& view, const survey::frame& frame, const frame_drawing& drawing) {
    double area = 0;
    std::string boxes;
    std::string outlines;
    for (std::size_t i = 0; i < drawing.drawn.size(); ++i) {
        const std::size_t object = drawing.drawn[i];
        const box_on_plane r = shown(view, frame.boxes[object]);
        area += r.width * r.height;
        boxes += rectangle(drawing.overlapping[object] != 0 ? "overlapping" : "apart", r);
        if (i < drawing.huge) outlines += rectangle("huge", r);
    }
    // The more boxes lie behind one another, the more is seen through each.
    const double depth = area / (view.width() * view.height());
    return element("g",
                   {{"fill-opacity", std::clamp(0.6 / depth, 0.03, 0.35)},
                    {"stroke-opacity", std::clamp(1.5 / depth, 0.1, 0.8)}},
                   boxes) +
           outlines;
}

std::string path_of(const view_plane& view, const survey::path& path) {
    std::string d;
    bool pen_down = false;
    for (const auto& place : path) {
        if (place)
            d += (pen_down ? "L" : "M") + short_number(view.x((*place)[view.across()])) + " " +
                 short_number(view.y((*place)[view.up()]));
        pen_down = place.has_value();
    }
    return d.empty() ? "" : element("path", {{"class", "way"}, {"d", d}}) + "\n";
}

}  // namespace

std::string words_at(double x, double y, std::string_view text, std::string_view kind, std::string_view anchor) {
    return element("text", {{"class", kind}, {"x", x}, {"y", y}, {"text-anchor", anchor}}, markup_text(text)) + "\n";
}

std::string rectangle(std::string_view kind, const box_on_plane& r) {
    return element("rect", {{"class", kind}, {"x", r.left}, {"y", r.top}, {"width", r.width}, {"height", r.height}}) +
           "\n";
}

std::string_view name_of_axis(int axis) {
    return std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1);
}

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
    std::string svg = "\n" + words_at(0, -10, title, "title") +
                      rectangle("world", {0, 0, view.width(), view.height()}) + axes_of(view) +
                      boxes_of(view, frame, drawing);
    for (const survey::path& path : paths) svg += path_of(view, path);
    return element("g", {{"transform", fmt::format("translate({:.1f} {:.1f})", corner.x, corner.y)}}, svg) + "\n";
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
