module aabblab.errors;

import aabb.registry;
import aabblab.fmt;
import aabblab.metrics;
import aabblab.numbers;

namespace aabblab {

namespace {

/// A composition with the values of its metrics.
struct plotted_composition {
    const candidate_summary* summary;
    std::string label;
    figure_point at;  ///< the values, with the intervals of times
};

std::string value_text(const metric& m, double value) {
    return fmt::format("{:.3g}{}", value, m.unit.empty() ? "" : " " + m.unit);
}

/// A plot of two metrics of the compositions that ran in one scene.
class plotted_scene {
public:
    /// Collects the compositions of the curves that ran in the scene, each as a point of two metrics.
    /// @param rows of all scenes
    plotted_scene(const scene_summary& scene, const metric_plot& plot, const study_record& record,
                  std::span<const row> rows)
        : scene_(scene), x_(metric_named(plot.x)), y_(metric_named(plot.y)) {
        for (const row& r : rows)
            if (r.experiment == scene.experiment && without_seed(r.scene) == scene.scene) rows_[r.name].push_back(&r);
        for (const curve_point& point : record.points) add(point, record);
        for (series& line : curves_) set_labels(line);
    }

    /// A sentence about the compositions at both ends of the Pareto front, with the ratio of their times, or that no
    /// composition has errors. It is empty if one composition is best in both metrics, or if a metric has no better
    /// direction.
    [[nodiscard]] std::string statement() const {
        if (plotted_.empty() || !has_front()) return {};
        const std::vector<std::size_t> front = front_of_plotted();
        const plotted_composition& first = plotted_[front.front()];
        const plotted_composition& last = plotted_[front.back()];
        if (is_errorless())
            return fmt::format("In {}, {} is 0 for all {} compositions, so it has no figure; {} has the best {}, {}.",
                               title(), y_.name, plotted_.size(), first.label, x_.name, value_text(x_, first.at.x));
        if (front.size() < 2) return {};
        return fmt::format("In {}, {} has the best {}, {}, with a {} of {}; {} has the best {}, {}, with a {} of {}{}.",
                           title(), first.label, x_.name, value_text(x_, first.at.x), y_.name,
                           value_text(y_, first.at.y), last.label, y_.name, value_text(y_, last.at.y), x_.name,
                           value_text(x_, last.at.x), ratio_text(first, last));
    }

    /// Whether the plot is of errors, and nothing that ran has any: all points would lie on one level.
    [[nodiscard]] bool is_errorless() const {
        return y_.group == metric_group::error &&
               std::ranges::all_of(plotted_, [](const plotted_composition& c) { return c.at.y == 0; });
    }

    /// A figure of one metric over the other, with one curve per method over its parameter. The Pareto front is added
    /// if both metrics have a better direction, and a level for methods without errors.
    [[nodiscard]] figure drawn(const std::string& name) const {
        // A logarithmic axis cannot show zero.
        const bool positive_x = std::ranges::all_of(plotted_, [](const plotted_composition& c) { return c.at.x > 0; });
        const bool positive_y = std::ranges::all_of(plotted_, [](const plotted_composition& c) { return c.at.y > 0; });
        const std::optional<double> floor = floor_of_errors();
        figure f{.name = name,
                 .caption = fmt::format("In {}, {} over {}: each method over its parameter, whose value is at each "
                                        "point. Bars are 95 % intervals of times.",
                                        title(), quantity_of(y_), quantity_of(x_)),
                 .x = {label_of(x_), positive_x},
                 .y = {label_of(y_), positive_y || floor},
                 .lines = curves_};
        if (has_front()) {
            series front{"Pareto front"};
            for (const std::size_t i : front_of_plotted()) front.points.push_back({plotted_[i].at.x, plotted_[i].at.y});
            // Drawn first, below the curves.
            f.lines.insert(f.lines.begin(), std::move(front));
            f.caption += " A line joins the Pareto front.";
        }
        if (floor) {
            for (series& line : f.lines)
                for (figure_point& p : line.points)
                    if (p.y < *floor) p.y = p.low = p.high = *floor;
            const bool is_share = y_.name == "wrong_share";
            f.lines.push_back({is_share ? "no errors (1/N)" : "zero", series_style::level, {{.x = 1, .y = *floor}}});
            f.caption += is_share ? fmt::format(
                                        " A method without errors is drawn on the line of one wrong pair in "
                                        "N = {}.",
                                        grouped(exact_pairs()))
                                  : " Zero is drawn on a line below the least other value.";
        }
        if (!absent_.empty()) f.caption += " Without a row or value here: " + absent_ + ".";
        return f;
    }

    [[nodiscard]] std::string title() const {
        const std::string parameters = parameters_text(scene_.scene);
        return scene_.scene.kind + (parameters.empty() ? "" : " " + parameters);
    }
    [[nodiscard]] bool has_points() const { return !plotted_.empty(); }

private:
    [[nodiscard]] static std::string label_of(const metric& m) {
        return m.name + (m.unit.empty() ? "" : " (" + m.unit + ")");
    }

    /// A metric in words: its summary up to a colon or semicolon, after which details follow.
    [[nodiscard]] static std::string quantity_of(const metric& m) {
        return m.summary.substr(0, m.summary.find_first_of(":;"));
    }

    /// Adds a point to its curve; one that did not run in this scene is named in the caption.
    void add(const curve_point& point, const study_record& record) {
        auto line = std::ranges::find(curves_, point.curve, &series::label);
        if (line == curves_.end()) line = curves_.insert(line, {point.curve, series_style::curve});
        const auto candidate =
            std::ranges::find_if(scene_.candidates, [&](const candidate_summary& c) { return point.matches(c.name); });
        const std::optional<figure_point> at =
            candidate == scene_.candidates.end() ? std::nullopt : values_of(*candidate);
        if (!at) {
            absent_ += (absent_.empty() ? "" : ", ") + point.text();
            return;
        }
        line->points.push_back(*at);
        choices_[point.curve].push_back({candidate->name.choices.all.begin(), candidate->name.choices.all.end()});
        // A curve with a single composition keeps its label in the config.
        const bool is_alone = std::ranges::count(record.points, point.curve, &curve_point::curve) == 1;
        plotted_.push_back({&*candidate, is_alone ? point.curve : candidate->label, *at});
    }

    void set_labels(series& line) const {
        if (line.points.empty()) return;
        const std::vector<std::string> labels = knob_labels(line.label, choices_.at(line.label));
        for (std::size_t i = 0; i < labels.size(); ++i) line.points[i].label = labels[i];
    }

    /// The two metrics of a composition in this scene; empty if one was not measured.
    [[nodiscard]] std::optional<figure_point> values_of(const candidate_summary& candidate) const {
        const std::optional<double>& x = candidate.metrics[static_cast<std::size_t>(&x_ - metrics().data())];
        const std::optional<double>& y = candidate.metrics[static_cast<std::size_t>(&y_ - metrics().data())];
        if (!x || !y) return std::nullopt;
        figure_point p{.x = *x, .y = *y};
        if (const auto range = interval_in_rows(candidate, x_)) std::tie(p.x_low, p.x_high) = *range;
        if (const auto range = interval_in_rows(candidate, y_)) std::tie(p.low, p.high) = *range;
        return p;
    }

    /// Processes and seeds have a cell each; a value that is not positive has no logarithm.
    /// @param value_of the value of a row, if it has one
    [[nodiscard]] cells logarithms(const candidate_summary& candidate,
                                   const std::function<std::optional<double>(const row&)>& value_of) const {
        std::map<std::optional<std::uint64_t>, std::size_t> seeds;
        std::map<std::uint64_t, std::size_t> processes;
        for (const row* r : rows_.at(candidate.name)) {
            seeds.emplace(r->scene.seed, seeds.size());
            processes.emplace(r->process, processes.size());
        }
        cells values(processes.size(), seeds.size());
        for (const row* r : rows_.at(candidate.name))
            if (const double value = value_of(*r).value_or(0); value > 0)
                values.add(processes.at(r->process), seeds.at(r->scene.seed), std::log(value));
        return values;
    }

    /// The 95 % interval of a time; other metrics are counts, which do not vary over repeats.
    [[nodiscard]] std::optional<std::pair<double, double>> interval_in_rows(const candidate_summary& candidate,
                                                                            const metric& m) const {
        if (m.group != metric_group::time) return std::nullopt;
        const std::optional<interval> range = interval_of(logarithms(candidate, m.value));
        return range ? std::optional(std::pair(range->low, range->high)) : std::nullopt;
    }

    /// ", which is 3.1 times that of the former (95 %: 2.9 to 3.3)", from ratios of the same repeat and seed.
    [[nodiscard]] std::string ratio_text(const plotted_composition& first, const plotted_composition& last) const {
        if (x_.group != metric_group::time) return {};
        std::map<std::pair<std::optional<std::uint64_t>, std::uint64_t>, double> base;  // by seed and repeat
        for (const row* r : rows_.at(first.summary->name))
            if (const double value = x_.value(*r).value_or(0); value > 0)
                base.emplace(std::pair(r->scene.seed, r->repeat), value);
        const cells ratios = logarithms(*last.summary, [&](const row& r) -> std::optional<double> {
            const auto of_first = base.find({r.scene.seed, r.repeat});
            const std::optional<double> value = x_.value(r);
            return value && of_first != base.end() ? std::optional(*value / of_first->second) : std::nullopt;
        });
        if (ratios.empty()) return {};
        const std::optional<interval> range = interval_of(ratios);
        return fmt::format(", {:.3g} times as much{}", std::exp(bootstrap(ratios).value),
                           range ? fmt::format(" (95 %: {:.3g} to {:.3g})", range->low, range->high) : "");
    }

    [[nodiscard]] bool has_front() const { return x_.direction != better::neither && y_.direction != better::neither; }

    /// The place of points without errors, since log 0 is infinite: at one wrong pair, or, of other errors, below
    /// the least. Empty if the metric counts no errors, or if none is zero.
    [[nodiscard]] std::optional<double> floor_of_errors() const {
        if (y_.group != metric_group::error || is_errorless()) return std::nullopt;
        if (y_.name == "wrong_share")
            return exact_pairs() > 0 ? std::optional(1 / static_cast<double>(exact_pairs())) : std::nullopt;
        double least = std::numeric_limits<double>::infinity();
        bool has_zero = false;
        for (const plotted_composition& c : plotted_)
            if (c.at.y > 0)
                least = std::min(least, c.at.y);
            else
                has_zero = true;
        return has_zero ? std::optional(least / 3) : std::nullopt;
    }
    /// The number of true pairs, from the pairs and the errors of any candidate.
    [[nodiscard]] std::uint64_t exact_pairs() const {
        const candidate_summary& any = scene_.candidates[0];
        return any.contacts.value_or(any.pairs) + any.false_negatives.value_or(0) - any.false_positives.value_or(0);
    }

    [[nodiscard]] std::vector<std::size_t> front_of_plotted() const {
        const auto signed_by = [](const metric& m, double value) {
            return m.direction == better::more ? -value : value;
        };
        std::vector<cost> costs;
        for (const plotted_composition& c : plotted_) costs.push_back({signed_by(x_, c.at.x), signed_by(y_, c.at.y)});
        return front_of(costs);
    }

    const scene_summary& scene_;
    const metric& x_;
    const metric& y_;
    std::map<candidate_name, std::vector<const row*>> rows_;  // of this scene
    std::vector<series> curves_;
    std::map<std::string, std::vector<std::vector<std::string>>> choices_;  // of the points of each curve
    std::vector<plotted_composition> plotted_;                              // of all curves
    std::string absent_;
};

/// Calls the function with each scene and plot of a study.
template <class Take>
void for_each_plot(const study_record& record, std::span<const row> rows, Take take) {
    const std::vector<scene_summary> scenes = summarise(rows);
    for (const scene_summary& scene : scenes)
        for (const metric_plot& plot : record.plots) take(plot, plotted_scene(scene, plot, record, rows));
}

}  // namespace

/// A figure for each scene and each pair of metrics that the study plots.
std::vector<figure> metric_figures(const study_record& record, std::span<const row> rows) {
    std::vector<figure> figures;
    for_each_plot(record, rows, [&](const metric_plot& plot, const plotted_scene& plotted) {
        if (plotted.is_errorless() && plotted.has_points()) return;
        figures.push_back(plotted.drawn(unused_file_name(plot.y + "_over_" + plot.x + "_" + plotted.title(), figures)));
    });
    return figures;
}

/// A sentence per scene and plot about both ends of its Pareto front, unless one composition is best in both metrics.
std::vector<std::string> metric_statements(const study_record& record, std::span<const row> rows) {
    std::vector<std::string> statements;
    for_each_plot(record, rows, [&](const metric_plot&, const plotted_scene& plotted) {
        if (std::string text = plotted.statement(); !text.empty()) statements.push_back(std::move(text));
    });
    return statements;
}

}  // namespace aabblab
