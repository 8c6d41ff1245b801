module;
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

module aabblab.report;

namespace aabblab {

namespace {

constexpr double character_width = 7;  // of the labels, about
constexpr double plot_width = 520;
constexpr double row_height = 24;
constexpr double top = 40;

/// A logarithmic axis from the decade below the least value to the one above the greatest.
struct log_axis {
    log_axis(double begin, double least, double greatest)
        : begin_(begin),
          first_(static_cast<int>(std::floor(std::log10(least)))),
          last_(std::max(first_ + 1, static_cast<int>(std::ceil(std::log10(greatest))))) {}

    [[nodiscard]] double operator()(double value) const {
        return begin_ + plot_width * (std::log10(value) - first_) / (last_ - first_);
    }
    [[nodiscard]] int first() const { return first_; }
    [[nodiscard]] int last() const { return last_; }

private:
    double begin_;
    int first_;
    int last_;
};

}  // namespace

std::string figure_of(const scene_summary& scene) {
    std::vector<const summary_line*> lines;
    for (const summary_line& line : scene.lines)
        if (line.ms_a_frame && line.ms_a_frame->low > 0) lines.push_back(&line);
    if (lines.empty()) return {};
    double least = lines[0]->ms_a_frame->low;
    double greatest = lines[0]->ms_a_frame->high;
    for (const summary_line* line : lines) {
        least = std::min(least, line->ms_a_frame->low);
        greatest = std::max(greatest, line->ms_a_frame->high);
    }
    std::size_t longest = 0;
    for (const summary_line* line : lines) longest = std::max(longest, line->label.size());
    const double label_width = character_width * static_cast<double>(longest) + 20;
    const log_axis x(label_width, least, greatest);
    const double bottom = top + row_height * static_cast<double>(lines.size());
    const double width = label_width + plot_width + 30;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" "
        "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        "<text x=\"10\" y=\"22\" font-weight=\"bold\">{2}: ms a frame, median and quartiles</text>\n",
        width, bottom + 30, scene.scene);
    std::vector<double> ticks;
    for (int decade = x.first(); decade <= x.last(); ++decade)
        for (const int step : {1, 2, 5})
            if (step == 1 || decade < x.last()) ticks.push_back(step * std::pow(10, decade));
    for (const double value : ticks)
        svg += fmt::format(
            "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"#ccc\"/>\n"
            "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4:g}</text>\n",
            x(value), top, bottom, bottom + 18, value);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const quartiles& q = *lines[i]->ms_a_frame;
        const double y = top + row_height * (static_cast<double>(i) + 0.5);
        svg += fmt::format(
            "<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"end\">{2}</text>\n"
            "<line x1=\"{3:.1f}\" y1=\"{4:.1f}\" x2=\"{5:.1f}\" y2=\"{4:.1f}\" stroke=\"{7}\" stroke-width=\"2\"/>\n"
            "<circle cx=\"{6:.1f}\" cy=\"{4:.1f}\" r=\"4\" fill=\"{7}\"/>\n",
            label_width - 10, y + 4, lines[i]->label, x(q.low), y, x(q.high), x(q.median),
            lines[i]->name.engine.empty() ? "#1f5fa8" : "#b35c1e");
    }
    return svg + "</svg>\n";
}

}  // namespace aabblab
