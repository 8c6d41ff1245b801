/// Lays out the parts of a figure, in ems of its font, so that no legend, name or mark covers data.
module aabblab.figures:arrangement;

import aabb.std;
import :drawing;
import :point_labels;
import :sheet;

namespace aabblab {

struct arrangement {
    double width, height;  ///< of the whole figure

    /// The edges of a plot, measured from the left and lower edges of the figure.
    struct box {
        double left, right, bottom, top;
        bool has_x_ticks, has_y_ticks;
        std::vector<double> mark_tops;  ///< the upper ends of the lines of its marks
        std::vector<std::pair<place, place>>
            gaps;  ///< lower left and upper right corners of texts that hide these lines
    };
    std::vector<box> plots;  ///< one per panel

    std::vector<tick> x_ticks;  ///< labels that would overlap are removed
    std::size_t x_name_length;  ///< the maximum line length of names below the plot, in characters
    int x_name_angle;           ///< of these names, in degrees; 0 if they fit side by side

    /// The sample of a series beside its label: starts at `at` in a legend, is centred there at the end of a line.
    struct sample {
        place at;
        const shown_label* label;
        bool is_end;
    };
    std::vector<sample> samples;
    std::vector<words> texts;  ///< all except tick labels

    /// A line from a point to its label that is not beside it, in the colour of the series.
    struct leader {
        segment line;
        std::size_t appearance;
    };
    std::vector<leader> leaders;
};

// In ems.
inline constexpr double tick_room = 0.9;  ///< length of a tick with the gap to its label
constexpr double figure_width = 36;       // about 10 pixels per em on a phone of 400 pixels
constexpr double legend_row = 1.4;
constexpr double legend_sample = 6;    // of a line in the legend, including gaps
constexpr double end_sign_room = 1.6;  // of the sign before a label at a line's end, including gaps
constexpr double gap = 0.6;

/// The lines of a tick label: names are broken into short lines, numbers are not.
[[nodiscard]] std::vector<std::string> lines_of(const scale& axis, const tick& t, std::size_t length) {
    return axis.named ? lines_of(t.label, length) : std::vector{t.label};
}

/// The centres of lines of text below a place.
[[nodiscard]] std::vector<place> lines_below(place top, std::size_t count) {
    std::vector<place> centres;
    for (std::size_t i = 0; i < count; ++i)
        centres.push_back({top.x, top.y - line_height * (static_cast<double>(i) + 0.5)});
    return centres;
}

// Maximum lengths of lines in labels, in characters.
constexpr std::size_t longest_name = 54;
constexpr std::size_t end_label_length = 18;

double width_of(const std::vector<std::string>& lines) {
    double widest = 0;
    for (const std::string& line : lines) widest = std::max(widest, width_of(line));
    return widest;
}

double height_of(const std::vector<std::string>& lines) {
    return line_height * static_cast<double>(lines.size());
}

std::size_t length_in(double width) {
    return static_cast<std::size_t>(std::max(width / character_width, 1.));
}

double width_of(const scale& axis, const tick& t, std::size_t name_length) {
    return axis.named ? width_of(lines_of(axis, t, name_length)) : width_of(t.label + t.power);
}

/// The maximum width and height of the labels of an axis, in ems.
/// @param name_length the maximum number of characters in a line of a name
std::pair<double, double> extent_of_labels(const scale& axis, std::size_t name_length) {
    double width = 0, height = 0;
    for (const tick& t : axis.ticks) {
        if (t.label.empty()) continue;
        width = std::max(width, width_of(axis, t, name_length));
        height = std::max(height, height_of(lines_of(axis, t, name_length)));
    }
    return {width, height};
}

struct end_label {
    const shown_label* label;
    std::vector<std::string> lines;
    double wanted;      ///< preferred centre above the plot's lower edge
    double middle = 0;  ///< its actual centre
};

struct legend {
    std::vector<std::vector<std::string>> entries;  ///< the lines of each label; empty if it has none
    double left = 0;
    double column_width = 0;
    std::size_t rows = 0;
    bool has_long_entries = false;
    bool is_in_cell = false;  ///< in the place of a panel, not below all plots

    [[nodiscard]] double height() const { return rows == 0 ? 0 : legend_row * static_cast<double>(rows) + gap; }
};

/// The text beside the vertical line of a mark, like a flag at its pole; `begin` and `end` are its horizontal extent.
struct flag {
    double line_x, begin, end;
    std::size_t row = 0;  ///< counted from below
};

/// Whether the line of one mark, if it is high enough, runs through the text of another.
bool crosses(const flag& line, const flag& text) {
    return text.begin < line.line_x && line.line_x < text.end;
}

/// Assigns rows to the texts of marks, whose lines end in the row of their text: texts that overlap get different rows,
/// and one that is crossed by another's line a higher row. Returns the number of rows.
std::size_t assign_rows(std::vector<flag>& flags) {
    // Each round settles at least one row, except for texts that cross each other's lines.
    for (std::size_t round = 0; round < flags.size(); ++round)
        for (flag& a : flags)
            for (flag& b : flags) {
                if (&a == &b) continue;
                const bool must_be_above = crosses(b, a) && (!crosses(a, b) || &a < &b);
                const bool meet = &a < &b && a.begin < b.end && b.begin < a.end;
                if (must_be_above && a.row <= b.row)
                    a.row = b.row + 1;
                else if (meet && a.row == b.row)
                    ++b.row;
            }
    std::size_t rows = 0;
    for (const flag& f : flags) rows = std::max(rows, f.row + 1);
    return rows;
}

/// Lays out from the outside to the inside: margins and the legend first, because they determine the size of plots.
class arranger {
public:
    explicit arranger(const drawing& d)
        : drawing_(d),
          panel_count_(d.panels.size()),
          has_point_labels_(has_point_labels(d)),
          column_count_(std::min<std::size_t>(panel_count_, has_point_labels_ ? 1 : 2)),
          row_count_((panel_count_ + column_count_ - 1) / column_count_) {}

    /// Places all parts of the figure. Margins depend on labels, the plots on margins and the legend, and the places of
    /// texts on the plots. Lengths are in ems, heights are measured from the lower edge.
    arrangement arranged() && {
        place_left();
        const std::vector<end_label> ends = place_ends();
        const double below_plot = tick_room + place_x_ticks();
        std::vector<std::vector<flag>> flags;  // the texts of marks, by panel
        std::size_t flag_rows = 0;
        for (std::size_t i = 0; i < panel_count_; ++i) {
            flags.push_back(flags_of(i));
            flag_rows = std::max(flag_rows, assign_rows(flags.back()));
        }
        const bool titled = std::ranges::any_of(drawing_.panels, [](const shown_panel& p) { return !p.title.empty(); });
        const double marks = line_height * static_cast<double>(flag_rows);  // the height of their texts
        const double row = plot_height_ + marks + (titled ? line_height + gap / 2 : 0);
        const legend labels = ends.empty() ? placed_legend(row, below_plot) : legend{};
        const double low = (labels.is_in_cell ? 0 : labels.height()) + gap / 2;  // the upper edge of the legend
        const double bottom = add_x_label(low) + gap / 2 + below_plot;           // the lower edge of the lowest plots
        constexpr double row_gap = 1.2;
        const auto rows = static_cast<double>(row_count_);  // of panels
        layout_.width = figure_width;
        layout_.height = bottom + rows * row + (rows - 1) * row_gap + (titled ? gap / 2 : 1);
        for (std::size_t i = 0; i < panel_count_; ++i) {
            const std::size_t from_above = i / column_count_;
            const auto from_below = static_cast<double>(row_count_ - 1 - from_above);
            add_plot(i, bottom + from_below * (row + row_gap), marks, flags[i]);
        }
        add_y_label((bottom + layout_.plots.front().top) / 2);
        for (std::size_t i = 0; i < panel_count_; ++i) add_point_labels(i);
        add_ends(ends, bottom);
        add_legend(labels, labels.is_in_cell ? bottom + plot_height_ - labels.height() : gap / 2);
        return std::move(layout_);
    }

private:
    [[nodiscard]] static bool has_point_labels(const drawing& d) {
        for (const shown_panel& panel : d.panels)
            for (const shown_series& s : panel.lines)
                if (std::ranges::any_of(s.points, [](const figure_point& p) { return !p.label.empty(); })) return true;
        return false;
    }
    [[nodiscard]] double plot_width() const {
        const auto count = static_cast<double>(column_count_);
        return (figure_width - left_margin_ - right_margin_ - column_gap_ * (count - 1)) / count;
    }
    [[nodiscard]] double plot_left(std::size_t panel) const {
        return left_margin_ + static_cast<double>(panel % column_count_) * (plot_width() + column_gap_);
    }

    /// Sets the height of the plots, which grows with names on the y axis, and the left margin for its labels.
    void place_left() {
        const auto [width, height] = extent_of_labels(drawing_.y, y_name_length);
        plot_height_ = panel_count_ == 1 || has_point_labels_ ? 17 : 10;
        if (drawing_.y.named)
            plot_height_ = std::max(plot_height_, (height + gap) * static_cast<double>(drawing_.y.ticks.size()));
        y_label_ = lines_of(drawing_.f.y.label, length_in(plot_height_ * static_cast<double>(row_count_) + 1.5));
        left_margin_ = gap / 2 + height_of(y_label_) + gap + width + tick_room;
    }

    /// Keeps the labels of every second tick of the x axis, or every third, and so on, so that no two overlap.
    void thin_x_ticks() {
        std::vector<tick*> labelled;
        for (tick& t : layout_.x_ticks)
            if (!t.label.empty()) labelled.push_back(&t);
        const auto fits = [&](std::size_t step) {  // every step-th label
            for (std::size_t i = step; i < labelled.size(); i += step) {
                const tick& previous = *labelled[i - step];
                const tick& next = *labelled[i];
                if ((drawing_.x.place(next.at) - drawing_.x.place(previous.at)) * plot_width() <
                    (width_of(drawing_.x, previous, 0) + width_of(drawing_.x, next, 0)) / 2 + gap)
                    return false;
            }
            return true;
        };
        std::size_t step = 1;
        while (step < labelled.size() && !fits(step)) ++step;
        for (std::size_t i = 0; i < labelled.size(); ++i)
            if (i % step != 0) labelled[i]->label.clear();
    }

    /// Places the labels of the x axis, and returns their height. Of numbers that would overlap, some are omitted;
    /// names that do not fit side by side are turned.
    double place_x_ticks() {
        layout_.x_name_length = longest_name;
        layout_.x_ticks = drawing_.x.ticks;
        if (column_count_ > 1) column_gap_ = 1.5;  // at least
        std::vector<tick> labelled;
        std::ranges::copy_if(drawing_.x.ticks, std::back_inserter(labelled),
                             [](const tick& t) { return !t.label.empty(); });
        if (labelled.empty()) return 0;
        double nearest = 1;  // distance of two labels, as a share of the axis
        for (std::size_t i = 1; i < labelled.size(); ++i)
            nearest = std::min(nearest, drawing_.x.place(labelled[i].at) - drawing_.x.place(labelled[i - 1].at));
        const double slot = plot_width() * nearest - gap;  // room for the width of a label
        if (drawing_.x.named) layout_.x_name_length = length_in(slot);
        const auto [width, height] = extent_of_labels(drawing_.x, layout_.x_name_length);
        const bool fits = width <= slot && height <= 3 * line_height;
        if (drawing_.x.named && !fits) return turn_x_names(labelled, slot);
        make_room_for_overhang(labelled.front(), labelled.back());
        if (!drawing_.x.named) thin_x_ticks();
        return height;
    }

    /// Widens the right margin and the gap between plots for labels, centred at outer ticks, that extend beyond.
    void make_room_for_overhang(const tick& first, const tick& last) {
        const double plot = plot_width();
        const auto overhang = [&](const tick& t, double to_edge) {
            return width_of(drawing_.x, t, layout_.x_name_length) / 2 - to_edge * plot;
        };
        const double left_overhang = overhang(first, drawing_.x.place(first.at));
        const double right_overhang = overhang(last, 1 - drawing_.x.place(last.at));
        right_margin_ = std::max(right_margin_, right_overhang + gap / 2);
        if (column_count_ > 1)
            column_gap_ = std::max(column_gap_, std::max(left_overhang, 0.) + std::max(right_overhang, 0.) + gap);
    }

    /// Slants names below the plots, each ending at its tick, or makes them vertical if lines would overlap, or the
    /// left margin would narrow the plots too much. Returns their height.
    /// @param slot the distance of two names in ems
    double turn_x_names(const std::vector<tick>& labelled, double slot) {
        constexpr int slant_degrees = 30;
        constexpr double slant = slant_degrees * std::numbers::pi / 180;
        constexpr double widest_margin = 16;    // nearly half of the figure
        constexpr double least_distance = 0.8;  // of the lines of slanted text
        layout_.x_name_length = longest_name;
        const double plot = plot_width();
        double left = left_margin_;
        double longest = 0;
        for (const tick& t : labelled) {
            longest = std::max(longest, width_of(t.label));
            left = std::max(left, width_of(t.label) * std::cos(slant) - drawing_.x.place(t.at) * plot + gap);
        }
        if (slot * std::sin(slant) >= least_distance && left <= widest_margin) {
            layout_.x_name_angle = slant_degrees;
            left_margin_ = left;
            return longest * std::sin(slant) + 0.5;
        }
        layout_.x_name_angle = 90;
        return longest;
    }

    /// The labels beside the ends of lines; none with panels, or if a line does not end near the right edge.
    [[nodiscard]] std::vector<end_label> wanted_ends() const {
        constexpr double near_edge = 0.9;
        std::vector<end_label> ends;
        if (panel_count_ > 1) return ends;
        for (std::size_t i = 0; i < drawing_.labels.size(); ++i) {
            if (drawing_.labels[i].text.empty()) continue;
            const shown_series& s = drawing_.panels.front().lines[i];
            const auto last = std::ranges::max_element(s.points, {}, &figure_point::x);
            // A level is a horizontal line across the whole figure.
            if (!s.is(series_style::level) && (!s.is_joined() || drawing_.x.place(last->x) < near_edge)) return {};
            ends.push_back({&drawing_.labels[i], lines_of(drawing_.labels[i].text, end_label_length),
                            drawing_.y.place(last->y) * plot_height_});
        }
        return ends;
    }

    /// Places labels beside the ends of lines, and moves them so that none overlap.
    /// @returns none, for a legend instead, if one is too long or wide, still overlaps, or is too far from its line
    std::vector<end_label> place_ends() {
        constexpr std::size_t most_lines = 3;
        constexpr double furthest = 2.2;      // from its line: further away, a label seems to belong to another
        constexpr double most_overlap = 0.1;  // not seen; the relaxation may not end at 0
        std::vector<end_label> ends = wanted_ends();
        double widest = 0;
        for (end_label& end : ends) {
            end.middle = end.wanted;
            widest = std::max(widest, width_of(end.lines));
            if (end.lines.size() > most_lines || widest > character_width * static_cast<double>(end_label_length))
                return {};
        }
        std::ranges::sort(ends, {}, &end_label::middle);
        // The overlap of two neighbouring labels.
        const auto overlap = [&](std::size_t upper) {
            const end_label& a = ends[upper - 1];
            const end_label& b = ends[upper];
            return (height_of(a.lines) + height_of(b.lines)) / 2 - (b.middle - a.middle);
        };
        // Relaxation: of two labels that overlap, one moves up and one down by half of it, until none do. All stay
        // above the labels of the x axis, and below the upper edge of the figure.
        constexpr double below_axis = 0.5;
        constexpr double above_plot = 0.9;
        const auto keep_inside = [&](end_label& end) {
            const double half = height_of(end.lines) / 2;
            end.middle = std::clamp(end.middle, half - below_axis, plot_height_ + above_plot - half);
        };
        constexpr int rounds = 200;
        for (int round = 0; round < rounds; ++round)
            for (std::size_t i = 1; i < ends.size(); ++i) {
                const double excess = std::max(overlap(i), 0.);
                ends[i - 1].middle -= excess / 2;
                ends[i].middle += excess / 2;
                keep_inside(ends[i - 1]);
                keep_inside(ends[i]);
            }
        for (std::size_t i = 0; i < ends.size(); ++i)
            if ((i > 0 && overlap(i) > most_overlap) || std::abs(ends[i].middle - ends[i].wanted) > furthest) return {};
        if (!ends.empty()) right_margin_ = std::max(right_margin_, end_sign_room + widest + gap / 2);
        return ends;
    }

    /// The legend: in the free cell of an incomplete last row of panels, if it fits, otherwise below the plots.
    /// @param row_height of a row of panels
    /// @param below_plot the height of the tick labels
    [[nodiscard]] legend placed_legend(double row_height, double below_plot) const {
        legend in_cell = legend_of(plot_width());
        if (panel_count_ % column_count_ != 0 && in_cell.height() + below_plot <= row_height &&
            !in_cell.has_long_entries) {
            in_cell.left = plot_left(panel_count_) + gap;
            in_cell.is_in_cell = true;
            return in_cell;
        }
        legend below = legend_of(figure_width);
        below.left = std::min(below.left, std::max(gap, left_margin_));
        return below;
    }

    /// Breaks the legend's labels into lines, in as many columns, filled one after the other, as fit. Right-aligned.
    [[nodiscard]] legend legend_of(double width) const {
        legend result;
        const std::size_t most = length_in(width - legend_sample - gap);  // characters in a line
        std::size_t lines = 0;
        double widest = 0;
        for (const shown_label& label : drawing_.labels) {
            const auto& entry = result.entries.emplace_back(lines_of(with_breaks(label.text, most), most));
            lines += entry.size();
            result.has_long_entries |= entry.size() > 1;
            widest = std::max(widest, width_of(entry));
        }
        if (lines == 0) return result;
        result.column_width = legend_sample + widest;
        auto columns = std::max<std::size_t>(1, static_cast<std::size_t>((width - gap) / result.column_width));
        // A label of several lines must not be split between columns.
        if (result.has_long_entries) columns = 1;
        result.rows = (lines + columns - 1) / columns;
        columns = (lines + result.rows - 1) / result.rows;
        result.left = std::max(gap, width - result.column_width * static_cast<double>(columns));
        return result;
    }

    /// The horizontal extents of the texts of marks: right of the line, or left if the figure ends before.
    [[nodiscard]] std::vector<flag> flags_of(std::size_t panel) const {
        std::vector<flag> flags;
        for (const figure_mark& m : drawing_.panels[panel].marks) {
            const double line_x = plot_left(panel) + drawing_.x.place(m.x) * plot_width();
            const double length = width_of(m.label) + gap;
            const bool right = line_x + length <= figure_width;
            flags.push_back({line_x, right ? line_x : line_x - length, right ? line_x + length : line_x});
        }
        return flags;
    }

    void add(place position, const std::string& text, words::anchor end = words::anchor::left, int angle = 0) {
        layout_.texts.push_back({position, text, end, {}, angle});
    }
    void add(const std::vector<place>& centres, const std::vector<std::string>& lines, words::anchor end) {
        for (std::size_t i = 0; i < lines.size(); ++i) add(centres[i], lines[i], end);
    }

    /// Adds the label of the x axis; takes the height of its lower edge, and returns that of its upper edge.
    double add_x_label(double bottom) {
        const double middle = (left_margin_ + figure_width - right_margin_) / 2;
        const double room = 2 * std::min(middle, figure_width - middle);
        const std::vector<std::string> lines = lines_of(drawing_.f.x.label, length_in(room - gap));
        const double top = bottom + height_of(lines);
        add(lines_below({middle, top}, lines.size()), lines, words::anchor::middle);
        return top;
    }

    void add_y_label(double middle) {
        double left = gap / 2;
        for (const std::string& line : y_label_) {
            add({left + line_height / 2, middle}, line, words::anchor::middle, 90);
            left += line_height;
        }
    }

    /// Adds the plot of a panel with its title and the texts of its marks, whose room is the same in all panels.
    /// @param bottom the height of the plot's lower edge
    void add_plot(std::size_t panel, double bottom, double height_of_marks, const std::vector<flag>& flags) {
        const double left = plot_left(panel);
        const double top = bottom + plot_height_;
        const bool is_lowest = panel + column_count_ >= panel_count_;
        const bool is_leftmost = panel % column_count_ == 0;
        // Only outer plots have labels at their ticks, which the inner ones share.
        arrangement::box& plot =
            layout_.plots.emplace_back(left, left + plot_width(), bottom, top, is_lowest, is_leftmost);
        const shown_panel& shown = drawing_.panels[panel];
        if (!shown.title.empty()) add({left, top + height_of_marks + gap / 2 + line_height / 2}, shown.title);
        for (std::size_t i = 0; i < flags.size(); ++i) {
            const flag& f = flags[i];
            const double height = top + line_height * (static_cast<double>(f.row) + 0.5);
            plot.mark_tops.push_back(height + 0.4);  // at the top of its text
            if (f.line_x == f.begin)
                add({f.line_x + gap / 2, height}, shown.marks[i].label);
            else
                add({f.line_x - gap / 2, height}, shown.marks[i].label, words::anchor::right);
            // Of two texts that cross each other's lines, the upper one's line has to pass the lower one's text.
            if (std::ranges::any_of(flags, [&](const flag& other) { return other.row > f.row && crosses(other, f); }))
                plot.gaps.emplace_back(place{f.begin + gap / 4, height - line_height / 2},
                                       place{f.end - gap / 4, height + line_height / 2});
        }
    }

    /// Adds the labels of a panel's points, beside them or joined to them by lines.
    void add_point_labels(std::size_t panel) {
        const arrangement::box& plot = layout_.plots[panel];
        std::vector<place> points;
        std::vector<point_label> labels;
        for (const shown_series& s : drawing_.panels[panel].lines)
            for (const figure_point& p : s.points) {
                if (s.is(series_style::level)) continue;
                points.push_back({plot.left + drawing_.x.place(p.x) * (plot.right - plot.left),
                                  plot.bottom + drawing_.y.place(p.y) * (plot.top - plot.bottom)});
                if (!p.label.empty()) labels.push_back({&p.label, points.back(), s.appearance});
            }
        label_room room({plot.left, plot.right, plot.bottom, plot.top}, labels);
        for (const place& at : points) room.add_point(at);
        const std::vector<placed_label> placed = room.placed();
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const auto& [box, leader] = placed[i];
            layout_.texts.push_back({box.middle(), *labels[i].text, words::anchor::middle, {}, 0, point_label::size});
            if (leader) layout_.leaders.push_back({*leader, labels[i].appearance});
        }
    }

    /// Adds the labels at ends of lines, each after its line's sign, since it may be slightly above or below.
    void add_ends(const std::vector<end_label>& ends, double bottom) {
        const double left = layout_.plots.front().right + 0.7;  // the centre of a sign; a label begins 0.8 after it
        for (const end_label& end : ends) {
            const double middle = bottom + end.middle;
            const bool has_sign = end.label->style != series_style::level;
            if (has_sign) layout_.samples.push_back({{left, middle}, end.label, /*is_end=*/true});
            const place top{left + (has_sign ? 0.8 : -0.2), middle + height_of(end.lines) / 2};
            add(lines_below(top, end.lines.size()), end.lines, words::anchor::left);
        }
    }

    /// Adds the legend by columns. An entry of several lines has its sample beside the first.
    void add_legend(const legend& labels, double bottom) {
        std::size_t line = 0;
        for (std::size_t i = 0; i < labels.entries.size(); ++i)
            for (const std::string& text : labels.entries[i]) {
                const std::size_t column = line / labels.rows;
                const auto from_below = static_cast<double>(labels.rows - 1 - line % labels.rows);
                const place at{labels.left + static_cast<double>(column) * labels.column_width,
                               bottom + (from_below + 0.5) * legend_row};
                if (&text == labels.entries[i].data())
                    layout_.samples.push_back({at, &drawing_.labels[i], /*is_end=*/false});
                add({at.x + legend_sample - 0.8, at.y}, text);
                ++line;
            }
    }

    const drawing& drawing_;
    arrangement layout_{};
    std::size_t panel_count_;
    bool has_point_labels_;  // which need room: panels are below each other then, as high as single ones
    std::size_t column_count_, row_count_;
    double left_margin_ = 0;
    double right_margin_ = 1.5;
    double column_gap_ = 0, plot_height_ = 0;
    std::vector<std::string> y_label_;
};

}  // namespace aabblab
