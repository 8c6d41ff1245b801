module;
#include <fmt/format.h>

module aabblab.picture;

import aabb.geometry;
import aabb.pipeline;
import aabb.validation;
import aabblab.markup;
import aabblab.numbers;
import aabblab.text;
import :panel;

namespace aabblab {

namespace {

constexpr std::size_t most_boxes = 4000;
constexpr std::size_t line_length = 135;  // characters that fit beside one another
constexpr double line_height = 19;
constexpr double huge_extents = 5;         // above so many mean extents a box is huge
constexpr std::size_t most_outlined = 10;  // where more are huge, none stands out

// Blue and vermilion of Okabe and Ito (2008), which people with any colour vision tell apart.
constexpr std::string_view style =
    "text{fill:#222}.paper{fill:#fff}.name{font-size:18px;font-weight:bold}.title,.axis{font-weight:bold}"
    ".world{fill:none;stroke:#999}.tick{stroke:#999}"
    ".apart{fill:#0072b2;stroke:#0072b2;stroke-width:.6}.overlapping{fill:#d55e00;stroke:#d55e00;stroke-width:.6}"
    ".huge{fill:none;stroke:#000;stroke-width:2.5;stroke-dasharray:8 4}"
    ".way{fill:none;stroke:#000;stroke-width:1.2;stroke-opacity:.7}";

double extent_of(const aabb::box& b) {
    const int k = aabb::longest_axis(b);
    return double{b.max[k]} - double{b.min[k]};
}

/// Sorts the objects by size and says how many are huge.
std::size_t sort_by_size(std::vector<std::size_t>& objects, const std::vector<aabb::box>& boxes) {
    double sum = 0;
    for (const std::size_t i : objects) sum += extent_of(boxes[i]);
    const double huge = huge_extents * sum / static_cast<double>(objects.size());
    std::ranges::sort(objects, [&](std::size_t a, std::size_t b) {
        return std::tuple(-extent_of(boxes[a]), a) < std::tuple(-extent_of(boxes[b]), b);
    });
    return static_cast<std::size_t>(
        std::ranges::count_if(objects, [&](std::size_t i) { return extent_of(boxes[i]) > huge; }));
}

/// Of more than can be shown, keeps the largest of the huge ones and some of the others, evenly spread over the sizes.
void sample(std::vector<std::size_t>& objects, std::size_t huge) {
    if (objects.size() <= most_boxes) return;
    const std::size_t kept = std::min(huge, most_boxes / 2);
    for (std::size_t i = kept; i < most_boxes; ++i)
        objects[i] = objects[kept + (i - kept) * (objects.size() - kept) / (most_boxes - kept)];
    objects.resize(most_boxes);
}

frame_drawing drawing_of(const survey::frame& frame) {
    frame_drawing drawing;
    const std::unique_ptr<aabb::global_stage> search = aabb::make_box_engine("cgal");
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
        if (!frame.has(i)) continue;
        drawing.drawn.push_back(i);
        search->insert(static_cast<std::uint32_t>(i));
    }
    drawing.present = drawing.drawn.size();
    std::vector<aabb::index_pair> pairs;
    if (drawing.present > 0) {
        search->update(frame.boxes);
        search->search(pairs);
    }
    drawing.pairs = pairs.size();
    drawing.overlapping.resize(frame.boxes.size());
    for (const auto [a, b] : pairs) drawing.overlapping[a] = drawing.overlapping[b] = 1;
    drawing.huge = sort_by_size(drawing.drawn, frame.boxes);
    sample(drawing.drawn, drawing.huge);
    if (drawing.huge > most_outlined) drawing.huge = 0;
    return drawing;
}

std::string title_of(std::string_view which, std::size_t number, const frame_drawing& drawing) {
    return fmt::format("{} frame ({}): boxes {}, overlapping pairs {}", which, number, drawing.present, drawing.pairs);
}

std::vector<std::string> caption_lines(const survey& seen, const picture_caption& caption, const view_plane& view,
                                       bool is_sampled) {
    std::vector<std::string> lines;
    for (const std::string& text : {caption.summary, caption.parameters})
        for (const std::string& line : lines_of(text, line_length)) lines.push_back(line);
    lines.push_back(fmt::format("{}, {}; {}", counted(seen.first().boxes.size(), "object"),
                                counted(seen.frames(), "frame"), displacement_text(seen)));
    lines.push_back(
        fmt::format("seen along {}: {} across, {} upwards{}{}", name_of_axis(3 - view.across() - view.up()),
                    name_of_axis(view.across()), name_of_axis(view.up()),
                    view.has_equal_scales() ? "" : ", each with a scale of its own",
                    is_sampled ? fmt::format("; a sample of {} boxes is drawn, huge ones first", most_boxes) : ""));
    return lines;
}

std::string legend(double y, std::size_t paths, bool has_huge) {
    std::string svg = rectangle("apart", {0, -11, 13, 13}) + words_at(20, 0, "overlaps no other") +
                      rectangle("overlapping", {170, -11, 13, 13}) + words_at(190, 0, "overlaps another") +
                      element("path", {{"class", "way"}, {"d", "M340 -4h30"}}) +
                      words_at(378, 0, fmt::format("paths of {} objects through all frames", paths));
    if (has_huge)
        svg += element("path", {{"class", "huge"}, {"d", "M680 -4h34"}}) +
               words_at(722, 0, fmt::format("longer than {} mean extents", huge_extents));
    return element("g", {{"transform", fmt::format("translate({} {:.1f})", left_margin, y)}}, svg) + "\n";
}

}  // namespace

std::string picture_of(const survey& seen, const picture_caption& caption) {
    const view_plane view(seen.world(), seen.sides());
    const frame_drawing first = drawing_of(seen.first());
    const frame_drawing last = drawing_of(seen.last());
    const bool is_sampled = std::max(first.present, last.present) > most_boxes;

    std::string body = words_at(left_margin, 32, caption.name, "name");
    double y = 58;
    for (const std::string& line : caption_lines(seen, caption, view, is_sampled)) {
        body += words_at(left_margin, y, line);
        y += line_height;
    }
    const auto paths = seen.paths().first(clear_paths(view, seen.paths()));
    body += legend(y + 6, paths.size(), first.huge + last.huge > 0);
    const pixel left = {left_margin, y + 46};
    const double panel_height = view.height() + bottom_margin;
    const pixel right = view.is_wide() ? pixel{left.x, left.y + panel_height + gap}
                                       : pixel{left.x + panel_side + left_margin + gap, left.y};
    body += panel_of(view, left, title_of("first", 0, first), seen.first(), first, {});
    body += panel_of(view, right, title_of("last", seen.frames() - 1, last), seen.last(), last, paths);
    const double width = 2 * (panel_side + left_margin + gap);
    const double height = std::round(right.y + panel_height + 16);
    return element("svg",
                   {{"xmlns", "http://www.w3.org/2000/svg"},
                    {"viewBox", fmt::format("0 0 {} {}", width, height)},
                    {"width", width},
                    {"height", height},
                    {"font-family", "sans-serif"},
                    {"font-size", 13}},
                   "\n" + rectangle("paper", {0, 0, width, height}) + element("style", {}, style) + "\n" + body) +
           "\n";
}

}  // namespace aabblab
