module aabblab.picture;

import aabb.pipeline;
import aabb.validation;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.scale;
import aabblab.svg;
import aabblab.text;

namespace aabblab {

namespace {

constexpr double panel_side = 490;
constexpr double left_margin = 84;  // for the labels of an axis, like the next
constexpr double bottom_margin = 44;
constexpr double gap = 30;  // between panels
constexpr double wide_panel = 2 * panel_side + left_margin + gap;
constexpr double narrowest = 1.0 / 8;  // ratio of the sides of a panel

/// The two axes that are shown, and their scales in pixels.
struct view_plane {
    /// Chooses the two axes that the picture shows, and their scales: it omits the shortest axis. Objects fall and pile
    /// up along z, so z is omitted only if it is less than a quarter as long as both others. If one of the two axes is
    /// more than 8 times as long as the other, each has its own scale.
    /// @param sides of the world, 0 on axes on which all boxes are equal
    view_plane(const aabb::box& world, const aabb::vec3d& sides) {
        for (int k = 0; k < 3; ++k) {
            const bool is_empty = world.min[k] > world.max[k];
            least[k] = is_empty ? 0 : double{world.min[k]};
            length[k] = is_empty ? 0 : double{world.max[k]} - least[k];
            if (length[k] > 0) continue;
            // Scales divide by the length, so an axis without one is shown as a unit.
            least[k] -= 0.5;
            length[k] = 1;
        }
        // The sides decide which axis is omitted; if all are 0, as with a single box, the lengths of the box do.
        aabb::vec3d importance = sides == aabb::vec3d{} ? length : sides;
        importance[2] *= 4;
        int omitted_axis = 2;
        for (const int k : {1, 0})
            if (importance[k] < importance[omitted_axis]) omitted_axis = k;
        across = omitted_axis == 0 ? 1 : 0;
        up = omitted_axis == 2 ? 1 : 2;
        const double true_aspect = length[up] / length[across];
        const double aspect = std::clamp(true_aspect, narrowest, 1 / narrowest);
        has_equal_scales = aspect == true_aspect;
        // A panel fits into a square, but one much wider than high has the width of two squares.
        width = aspect < 0.4 ? wide_panel : aspect <= 1 ? panel_side : panel_side / aspect;
        height = width * aspect;
        scale[across] = width / length[across];
        scale[up] = height / length[up];
    }

    /// Pixels from the left edge of the panel, and from its upper edge.
    [[nodiscard]] double x(double value) const { return (value - least[across]) * scale[across]; }
    [[nodiscard]] double y(double value) const { return height - (value - least[up]) * scale[up]; }

    int across = 0;
    int up = 1;
    double width = 0;
    double height = 0;
    bool has_equal_scales = true;
    aabb::vec3d least{};   // by axis, as are the following
    aabb::vec3d length{};  // shown
    aabb::vec3d scale{};   // pixels per unit of length
};

/// "x", "y" or "z"
std::string_view name_of_axis(int axis) {
    return std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1);
}

struct frame_drawing {
    std::vector<std::size_t> drawn_objects;  // objects by descending size
    std::size_t huge = 0;                    // the number of them that are outlined on top
    std::vector<std::uint8_t> overlapping;   // by object
    std::size_t present_objects = 0;
    std::size_t overlapping_pairs = 0;
};

std::vector<double> ticks(const view_plane& view, int axis, double pixels, double pixels_each) {
    const double length = view.length[axis];
    return round_values(view.least[axis], view.least[axis] + length,
                        round_step(length, std::max(2.0, pixels / pixels_each)));
}

/// Draws ticks with their values below and to the left of a panel, and the names of the axes. Lengths are in pixels.
void add_axes(svg_picture& to, const view_plane& view) {
    const double below = view.height;
    for (const double value : ticks(view, view.across, view.width, /*pixels_each=*/80)) {
        to.line("tick", {view.x(value), below}, {view.x(value), below + 5});
        to.text("", {view.x(value), below + 19}, fmt::format("{:g}", value), {{"text-anchor", "middle"}});
    }
    for (const double value : ticks(view, view.up, view.height, /*pixels_each=*/40)) {
        to.line("tick", {0, view.y(value)}, {-5, view.y(value)});
        to.text("", {-9, view.y(value) + 4}, fmt::format("{:g}", value), {{"text-anchor", "end"}});
    }
    to.text("axis", {view.width / 2, below + 36}, name_of_axis(view.across), {{"text-anchor", "middle"}});
    to.text("axis", {8 - left_margin, below / 2 + 4}, name_of_axis(view.up));
}

/// The rectangle of a box, at least one pixel wide and high so that it stays visible.
svg_box rectangle_of(const view_plane& view, const aabb::box& b) {
    const double left = view.x(b.min[view.across]);
    const double top = view.y(b.max[view.up]);
    return {left, top, std::max(1.0, view.x(b.max[view.across]) - left), std::max(1.0, view.y(b.min[view.up]) - top)};
}

/// Draws the boxes, in one colour those that overlap another, and outlines of the first `drawing.huge` ones.
void add_boxes(svg_picture& to, const view_plane& view, const picture_data::frame& frame,
               const frame_drawing& drawing) {
    double area = 0;
    svg_picture boxes;
    for (const std::size_t object : drawing.drawn_objects) {
        const svg_box r = rectangle_of(view, frame.boxes[object]);
        area += r.width * r.height;
        boxes.rectangle(drawing.overlapping[object] != 0 ? "overlapping" : "apart", r);
    }
    // The mean number of boxes over a pixel: the more there are, the more transparent each is.
    const double depth = area / (view.width * view.height);
    to.group(boxes, {{"fill-opacity", std::clamp(0.6 / depth, 0.03, 0.35)},
                     {"stroke-opacity", std::clamp(1.5 / depth, 0.1, 0.8)}});
    for (std::size_t i = 0; i < drawing.huge; ++i)
        to.rectangle("huge", rectangle_of(view, frame.boxes[drawing.drawn_objects[i]]));
}

/// The drawing of one frame: title, axes, boxes, and the paths of some objects, empty for none.
svg_picture panel_of(const view_plane& view, std::string_view title, const picture_data::frame& frame,
                     const frame_drawing& drawing, const std::vector<polylines>& paths) {
    svg_picture panel;
    panel.text(
        "title", {0, -10},
        fmt::format("{}: boxes {}, overlapping pairs {}", title, drawing.present_objects, drawing.overlapping_pairs));
    panel.rectangle("world", {0, 0, view.width, view.height});
    add_axes(panel, view);
    add_boxes(panel, view, frame, drawing);
    for (const polylines& path : paths)
        if (!path.empty()) panel.path("way", path);
    return panel;
}

/// Projects a path to the plane, in pixels. A new line begins after each absence of the object.
polylines projected_path(const view_plane& view, const picture_data::path& path) {
    polylines lines;
    bool is_new = true;
    for (const auto& place : path) {
        if (place && is_new) lines.emplace_back();
        if (place) lines.back().push_back({view.x((*place)[view.across]), view.y((*place)[view.up])});
        is_new = !place;
    }
    return lines;
}

/// Projects paths, at least one, until their total length is so great that more of them would hide the boxes.
std::vector<polylines> projected_paths(const view_plane& view, std::span<const picture_data::path> paths) {
    const double greatest_length = 8 * (view.width + view.height);  // pixels
    double length = 0;
    std::vector<polylines> projected;
    for (const picture_data::path& path : paths) {
        if (length >= greatest_length) break;
        projected.push_back(projected_path(view, path));
        for (const std::vector<place>& line : projected.back())
            for (std::size_t i = 1; i < line.size(); ++i)
                length += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    }
    return projected;
}

constexpr std::size_t most_boxes = 4000;
constexpr std::size_t line_length = 135;  // characters
constexpr double line_height = 19;
constexpr double huge_extents = 5;         // a box above this multiple of the mean extent is huge
constexpr std::size_t most_outlined = 10;  // if more boxes are huge, none is outlined

// Blue and vermilion of Okabe and Ito (2008), which are distinguishable with any colour vision.
constexpr std::string_view style =
    "text{fill:#222}.name{font-size:18px;font-weight:bold}.title,.axis{font-weight:bold}"
    ".world{fill:none;stroke:#999}.tick{stroke:#999}"
    ".apart{fill:#0072b2;stroke:#0072b2;stroke-width:.6}.overlapping{fill:#d55e00;stroke:#d55e00;stroke-width:.6}"
    ".huge{fill:none;stroke:#000;stroke-width:2.5;stroke-dasharray:8 4}"
    ".way{fill:none;stroke:#000;stroke-width:1.2;stroke-opacity:.7}";

double extent_of(const aabb::box& b) {
    const int k = aabb::longest_axis(b);
    return double{b.max[k]} - double{b.min[k]};
}

/// Sorts the objects by descending extent. @returns the number of huge ones, longer than five mean extents
std::size_t sort_by_size(std::vector<std::size_t>& objects, const std::vector<aabb::box>& boxes) {
    double sum = 0;
    for (const std::size_t i : objects) sum += extent_of(boxes[i]);
    const double longest_usual = huge_extents * sum / static_cast<double>(objects.size());
    std::ranges::sort(objects, [&](std::size_t a, std::size_t b) {
        return std::tuple(-extent_of(boxes[a]), a) < std::tuple(-extent_of(boxes[b]), b);
    });
    return static_cast<std::size_t>(
        std::ranges::count_if(objects, [&](std::size_t i) { return extent_of(boxes[i]) > longest_usual; }));
}

/// Limits the number of boxes: keeps the largest huge ones and a sample of the others that is uniform in size order.
void sample(std::vector<std::size_t>& objects, std::size_t huge) {
    if (objects.size() <= most_boxes) return;
    const std::size_t kept = std::min(huge, most_boxes / 2);
    for (std::size_t i = kept; i < most_boxes; ++i)
        objects[i] = objects[kept + (i - kept) * (objects.size() - kept) / (most_boxes - kept)];
    objects.resize(most_boxes);
}

/// Finds the overlapping boxes of a frame by CGAL, and selects the boxes to draw: the huge ones first, then a sample.
frame_drawing drawing_of(const picture_data::frame& frame) {
    frame_drawing drawing;
    const std::unique_ptr<aabb::global_stage> search = aabb::make_box_engine("cgal");
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
        if (!frame.has(i)) continue;
        drawing.drawn_objects.push_back(i);
        search->insert(static_cast<std::uint32_t>(i));
    }
    drawing.present_objects = drawing.drawn_objects.size();
    std::vector<aabb::index_pair> overlapping_pairs;
    if (drawing.present_objects > 0) {
        search->update(frame.boxes);
        search->search(overlapping_pairs);
    }
    drawing.overlapping_pairs = overlapping_pairs.size();
    drawing.overlapping.resize(frame.boxes.size());
    for (const auto [a, b] : overlapping_pairs) drawing.overlapping[a] = drawing.overlapping[b] = 1;
    drawing.huge = sort_by_size(drawing.drawn_objects, frame.boxes);  // the number of huge ones, which come first
    sample(drawing.drawn_objects, drawing.huge);
    if (drawing.huge > most_outlined) drawing.huge = 0;  // more outlines would hide the rest
    return drawing;
}

/// The lines above the drawing: what the scene is, how large it is, and what the picture shows of it.
std::vector<std::string> caption_lines(const picture_data& data, const picture_caption& caption, const view_plane& view,
                                       bool is_sampled) {
    std::vector<std::string> lines;
    const int omitted = 3 - view.across - view.up;  // axes 0, 1 and 2 sum to 3
    for (const std::string& text : {caption.summary, caption.parameters})
        for (const std::string& line : lines_of(text, line_length)) lines.push_back(line);
    lines.push_back(fmt::format("{}, {}; {}", counted(data.first().boxes.size(), "object"),
                                counted(data.frames(), "frame"), displacement_text(data)));
    lines.push_back(
        fmt::format("seen along {}: {} across, {} upwards{}{}", name_of_axis(omitted), name_of_axis(view.across),
                    name_of_axis(view.up), view.has_equal_scales ? "" : ", each with a scale of its own",
                    is_sampled ? fmt::format("; a sample of {} boxes is drawn, huge ones first", most_boxes) : ""));
    return lines;
}

/// Explains the colours and lines of the drawing. Lengths are in pixels.
svg_picture legend(std::size_t paths, bool has_huge) {
    svg_picture keys;
    keys.rectangle("apart", {0, -11, 13, 13});
    keys.text("", {20, 0}, "overlaps no other");
    keys.rectangle("overlapping", {170, -11, 13, 13});
    keys.text("", {190, 0}, "overlaps another");
    keys.line("way", {340, -4}, {370, -4});
    keys.text("", {378, 0}, fmt::format("paths of {} objects through all frames", paths));
    if (!has_huge) return keys;
    keys.line("huge", {680, -4}, {714, -4});
    keys.text("", {722, 0}, fmt::format("longer than {} mean extents", huge_extents));
    return keys;
}

}  // namespace

/// Draws the first and the last frame as SVG, under a caption and a legend. Lengths are in pixels.
std::string picture_of(const picture_data& data, const picture_caption& caption) {
    const view_plane view(data.world(), data.sides());
    const frame_drawing first = drawing_of(data.first());
    const frame_drawing last = drawing_of(data.last());
    const bool is_sampled = std::max(first.present_objects, last.present_objects) > most_boxes;
    svg_picture picture;
    picture.style(style);
    picture.text("name", {left_margin, 32}, caption.name);
    double y = 58;
    for (const std::string& line : caption_lines(data, caption, view, is_sampled)) {
        picture.text("", {left_margin, y}, line);
        y += line_height;
    }
    const std::vector<polylines> paths = projected_paths(view, data.paths());
    picture.put({left_margin, y + 6}, legend(paths.size(), first.huge + last.huge > 0));
    const place left = {left_margin, y + 46};
    const double panel_height = view.height + bottom_margin;
    // There is no room for another panel beside a wide one.
    const place right = view.width > panel_side ? place{left.x, left.y + panel_height + gap}
                                                : place{left.x + panel_side + left_margin + gap, left.y};
    picture.put(left, panel_of(view, "first frame (0)", data.first(), first, {}));
    picture.put(right, panel_of(view, fmt::format("last frame ({})", data.frames() - 1), data.last(), last, paths));
    return picture.file(2 * (panel_side + left_margin + gap), std::round(right.y + panel_height + 16), 13);
}

}  // namespace aabblab
