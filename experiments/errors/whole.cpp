module;
#include <fmt/format.h>

module aabblab.errors;

import :front;
import aabb.registry;
import aabblab.metrics;
import aabblab.numbers;
import aabblab.trials;
import aabblab.results;

namespace aabblab {

namespace {

/// Where a composition stands in a plot.
struct place {
    std::string label;
    double x;
    double y;
};

class plotted_scene {
public:
    plotted_scene(const scene_summary& scene, const metric_plot& plot)
        : scene_(scene), x_(metric_named(plot.x)), y_(metric_named(plot.y)) {}

    /// Empty where there is nothing to choose from.
    [[nodiscard]] std::string statement_of(std::span<const error_curve> curves) const {
        std::vector<place> all;
        for (const error_curve& curve : curves)
            for (const aabb::composition& c : curve.compositions)
                if (std::optional<place> at = place_of(c)) {
                    // A curve of one composition is named as its config names it.
                    if (curve.compositions.size() == 1) at->label = curve.label;
                    all.push_back(*std::move(at));
                }
        const std::vector<std::size_t> front = front_of(costs_of(all));
        if (front.size() < 2 || !has_front()) return {};
        const place& first = all[front.front()];
        const place& last = all[front.back()];
        return fmt::format("In {}, {} has the best {}, {}, with a {} of {}; {} has the best {}, {}, with a {} of {}.",
                           title(), first.label, x_.name, value_text(x_, first.x), y_.name, value_text(y_, first.y),
                           last.label, y_.name, value_text(y_, last.y), x_.name, value_text(x_, last.x));
    }

    [[nodiscard]] figure figure_of(std::span<const error_curve> curves) const {
        figure f{.name = "",
                 .caption = fmt::format("{} over {} in {}: each method over its knob.", y_.name, x_.name, title()),
                 .x = {label_of(x_), false, {}},
                 .y = {label_of(y_), false, {}},
                 .lines = {},
                 .marks = {}};
        std::vector<place> all;
        for (const error_curve& curve : curves) {
            series line{curve.label, series_style::line, {}};
            for (const aabb::composition& c : curve.compositions)
                if (const std::optional<place> at = place_of(c)) {
                    line.points.push_back(point_of(*at));
                    all.push_back(*at);
                }
            f.lines.push_back(std::move(line));
        }
        // No logarithm shows a zero.
        f.x.logarithmic = std::ranges::all_of(all, [](const place& at) { return at.x > 0; });
        f.y.logarithmic = has_floor() || std::ranges::all_of(all, [](const place& at) { return at.y > 0; });
        if (has_front()) {
            // Below the curves.
            f.lines.insert(f.lines.begin(), front(all));
            f.caption += " What no other is better than in both is joined by a line.";
        }
        if (has_floor()) {
            const double floor = least_share();
            f.lines.push_back({"nothing wrong (1/N)", series_style::level, {{1, floor, floor, floor}}});
            f.caption += fmt::format(" What gets nothing wrong stands on the line of one wrong pair in N = {}.",
                                     grouped(exact_pairs()));
        }
        return f;
    }

    [[nodiscard]] std::string title() const {
        const std::string parameters = parameters_text(scene_.scene);
        return scene_.scene.kind + (parameters.empty() ? "" : " " + parameters);
    }

private:
    [[nodiscard]] static std::string label_of(const metric& m) {
        return m.name + (m.unit.empty() ? "" : " (" + m.unit + ")");
    }

    [[nodiscard]] std::optional<place> place_of(const aabb::composition& c) const {
        const contender_name name = contender_of(c, has_meshes(scene_.scene)).name;
        const auto line = std::ranges::find(scene_.lines, name, &summary_line::name);
        if (line == scene_.lines.end()) return std::nullopt;
        const auto value_of = [&](const metric& m) {
            const auto all = metrics();
            return line->metrics[static_cast<std::size_t>(std::ranges::find(all, m.name, &metric::name) - all.begin())];
        };
        const std::optional<double> x = value_of(x_);
        const std::optional<double> y = value_of(y_);
        return x && y ? std::optional(place{line->label, *x, *y}) : std::nullopt;
    }

    [[nodiscard]] bool has_front() const { return x_.direction != better::neither && y_.direction != better::neither; }
    [[nodiscard]] static std::string value_text(const metric& m, double value) {
        return fmt::format("{:.3g}{}", value, m.unit.empty() ? "" : " " + m.unit);
    }

    [[nodiscard]] bool has_floor() const { return y_.name == "wrong_share" && exact_pairs() > 0; }
    [[nodiscard]] std::uint64_t exact_pairs() const {
        const summary_line& line = scene_.lines[0];
        return line.contacts.value_or(line.pairs) + line.missing.value_or(0) - line.invented.value_or(0);
    }
    [[nodiscard]] double least_share() const { return 1 / static_cast<double>(exact_pairs()); }

    [[nodiscard]] figure_point point_of(const place& at) const {
        const double y = has_floor() ? std::max(at.y, least_share()) : at.y;
        return {at.x, y, y, y};
    }

    [[nodiscard]] std::vector<cost> costs_of(std::span<const place> all) const {
        const auto cost_of = [](const metric& m, double value) { return m.direction == better::more ? -value : value; };
        std::vector<cost> costs;
        for (const place& at : all) costs.push_back({cost_of(x_, at.x), cost_of(y_, at.y)});
        return costs;
    }

    [[nodiscard]] series front(std::span<const place> all) const {
        series line{"not dominated", series_style::line, {}};
        for (const std::size_t i : front_of(costs_of(all))) line.points.push_back(point_of(all[i]));
        return line;
    }

    const scene_summary& scene_;
    const metric& x_;
    const metric& y_;
};

}  // namespace

std::vector<figure> metric_figures(const error_study& study, std::span<const scene_summary> scenes) {
    std::vector<figure> figures;
    for (const scene_summary& scene : scenes)
        for (const metric_plot& plot : study.plots) {
            const plotted_scene plotted(scene, plot);
            figures.push_back(plotted.figure_of(study.curves));
            std::string name = plot.y + "_over_" + plot.x + "_" + file_name(plotted.title());
            while (std::ranges::find(figures, name, &figure::name) != figures.end()) name += "-again";
            figures.back().name = name;
        }
    return figures;
}

std::vector<std::string> metric_statements(const error_study& study, std::span<const scene_summary> scenes) {
    std::vector<std::string> statements;
    for (const scene_summary& scene : scenes)
        for (const metric_plot& plot : study.plots)
            if (std::string text = plotted_scene(scene, plot).statement_of(study.curves); !text.empty())
                statements.push_back(std::move(text));
    return statements;
}

}  // namespace aabblab
