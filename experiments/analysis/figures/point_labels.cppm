/// Finds room in a plot for the labels of its points.
module aabblab.figures:point_labels;

import aabb.std;
import aabblab.svg;
import aabblab.text;

namespace aabblab {

// In ems of the figure's font.
inline constexpr double line_height = 1.25;
constexpr double character_width = 0.6;  // of the widest common sans-serif fonts

double width_of(const std::string& line) {
    return character_width * static_cast<double>(characters(line));
}

/// The extent of a text in a plot.
struct text_box {
    double left, right, bottom, top;

    [[nodiscard]] bool overlaps(const text_box& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }
    [[nodiscard]] place middle() const { return {(left + right) / 2, (bottom + top) / 2}; }
    [[nodiscard]] place nearest_to(place p) const {
        return {std::clamp(p.x, left, right), std::clamp(p.y, bottom, top)};
    }
};

/// A straight line between two places.
struct segment {
    place from, to;

    /// Whether it meets a box: the part of the line between each pair of opposite sides is not empty (Liang and Barsky
    /// 1984).
    [[nodiscard]] bool meets(const text_box& box) const {
        double first = 0, last = 1;
        const auto keep_between = [&](double start, double change, double low, double high) {
            if (change == 0) return low < start && start < high;
            const auto [enters, leaves] = std::minmax((low - start) / change, (high - start) / change);
            first = std::max(first, enters);
            last = std::min(last, leaves);
            return first < last;
        };
        return keep_between(from.x, to.x - from.x, box.left, box.right) &&
               keep_between(from.y, to.y - from.y, box.bottom, box.top);
    }

    [[nodiscard]] bool crosses(const segment& other) const {
        const auto side = [](const segment& line, place p) {
            return (line.to.x - line.from.x) * (p.y - line.from.y) - (line.to.y - line.from.y) * (p.x - line.from.x);
        };
        return side(*this, other.from) * side(*this, other.to) < 0 && side(other, from) * side(other, to) < 0;
    }
};

struct point_label {
    static constexpr double size = 0.75;  ///< relative to the font size
    static constexpr double half_height = size * line_height / 2;
    static constexpr double sign = 0.4;  ///< half the extent of the sign of a point

    const std::string* text;
    place at;                ///< of its point
    std::size_t appearance;  ///< that of its series

    /// The extent of the label if its middle is at this offset from the point.
    [[nodiscard]] text_box box_at(double x, double y) const {
        return {at.x + x - half_width(), at.x + x + half_width(), at.y + y - half_height, at.y + y + half_height};
    }
    [[nodiscard]] double half_width() const { return size * width_of(*text) / 2; }
};

/// A label in its place, with the line to its point if it is not beside it.
struct placed_label {
    text_box box;
    std::optional<segment> leader{};
};

/// The room that is left in a plot for the labels of points.
class label_room {
public:
    label_room(const text_box& plot, std::vector<point_label> labels) : plot_(plot), labels_(std::move(labels)) {}

    /// Adds a point, which labels must not cover.
    void add_point(place at) {
        constexpr double sign = point_label::sign;
        signs_.push_back({at.x - sign, at.x + sign, at.y - sign, at.y + sign});
    }

    /// Places all labels: beside their points and, after all that fit there, at the nearest place with room.
    [[nodiscard]] std::vector<placed_label> placed() {
        std::vector<placed_label> result(labels_.size());
        std::vector<std::size_t> waiting;
        for (std::size_t i = 0; i < labels_.size(); ++i)
            if (const std::optional<text_box> box = beside(labels_[i]))
                take(result[i] = {*box});
            else
                waiting.push_back(i);
        for (const std::size_t i : waiting) {
            std::optional<placed_label> place;
            for (const crossing allowed : {crossing::none, crossing::points_and_lines, crossing::anything})
                if (!place) place = away_from(labels_[i], allowed);
            // In a plot that is full of labels, one over another still says that it is there.
            take(result[i] = place ? *place : placed_label{labels_[i].box_at(0, 0)});
        }
        return result;
    }

private:
    /// What the line of a label may cross. If anything, labels may also lie on lines.
    enum class crossing : unsigned char { none, points_and_lines, anything };

    /// The first free one of eight places around a point.
    [[nodiscard]] std::optional<text_box> beside(const point_label& label) const {
        constexpr double sign = point_label::sign;
        for (const auto& [right, up] :
             {std::pair{1, 1}, {1, 0}, {1, -1}, {0, 1}, {0, -1}, {-1, 1}, {-1, 0}, {-1, -1}}) {
            const text_box box = label.box_at(right * (sign + label.half_width() + 0.1),
                                              up * (point_label::half_height + (right == 0 ? sign : 0.1)));
            if (is_free(box) && !lies_on_line(box)) return box;
        }
        return std::nullopt;
    }

    /// The nearest free place, on growing ellipses, whose line to the point crosses nothing but what it may.
    [[nodiscard]] std::optional<placed_label> away_from(const point_label& label, crossing allowed) const {
        constexpr double step = 0.5;
        constexpr int directions = 24;
        const double furthest = plot_.right - plot_.left;
        for (double distance = point_label::sign + step; distance < furthest; distance += step)
            for (int i = 0; i < directions; ++i) {
                const double angle = 2 * std::numbers::pi * i / directions;
                const text_box box = label.box_at((distance + label.half_width()) * std::cos(angle),
                                                  (distance + point_label::half_height) * std::sin(angle));
                if (!is_free(box)) continue;
                const segment leader = leader_of(label, box);
                if (allowed == crossing::anything || (!lies_on_line(box) && is_clear(leader, allowed)))
                    return placed_label{box, leader};
            }
        return std::nullopt;
    }

    /// The line from the edge of a point's sign to its label.
    [[nodiscard]] static segment leader_of(const point_label& label, const text_box& box) {
        const place to = box.nearest_to(label.at);
        const double length = std::hypot(to.x - label.at.x, to.y - label.at.y);
        const double part = std::min(point_label::sign / length, 1.0);
        return {{label.at.x + part * (to.x - label.at.x), label.at.y + part * (to.y - label.at.y)}, to};
    }

    [[nodiscard]] bool is_clear(const segment& leader, crossing allowed) const {
        const auto meets = [&](const text_box& box) { return leader.meets(box); };
        const auto crosses = [&](const segment& other) { return leader.crosses(other); };
        if (std::ranges::any_of(texts_, meets)) return false;
        // It may begin in the corner of its own point.
        return allowed == crossing::points_and_lines ||
               (std::ranges::count_if(signs_, meets) <= 1 && std::ranges::none_of(leaders_, crosses));
    }
    [[nodiscard]] bool is_free(const text_box& box) const {
        const auto overlaps = [&](const text_box& other) { return box.overlaps(other); };
        return box.left >= plot_.left && box.right <= plot_.right && box.bottom >= plot_.bottom &&
               box.top <= plot_.top && std::ranges::none_of(signs_, overlaps) && std::ranges::none_of(texts_, overlaps);
    }
    [[nodiscard]] bool lies_on_line(const text_box& box) const {
        return std::ranges::any_of(leaders_, [&](const segment& line) { return line.meets(box); });
    }
    void take(const placed_label& label) {
        texts_.push_back(label.box);
        if (label.leader) leaders_.push_back(*label.leader);
    }

    text_box plot_;
    std::vector<point_label> labels_;
    std::vector<text_box> signs_;  // of points, with or without a label
    std::vector<text_box> texts_;  // of the labels that have a place
    std::vector<segment> leaders_;
};

}  // namespace aabblab
