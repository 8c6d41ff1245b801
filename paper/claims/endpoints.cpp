module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

bool matches(const factors& where, const factors& wanted) {
    return std::ranges::all_of(wanted, [&](const auto& f) { return value_of(where, f.first) == f.second; });
}

std::vector<const condition*> matching(const std::vector<condition>& conditions, const factors& wanted) {
    std::vector<const condition*> selected;
    for (const condition& c : conditions)
        if (matches(c.scene(), wanted)) selected.push_back(&c);
    return selected;
}

/// A ratio of a claim in one scene: a metric of `tested` over that of `baseline`; NaN if it was not measured.
/// @param more factors that identify the endpoint, in addition to the condition's
endpoint endpoint_of(const condition& c, const selection& tested, const selection& baseline, const std::string& metric,
                     factors more) {
    endpoint ratio;
    ratio.where = c.scene();
    ratio.where.insert(ratio.where.end(), more.begin(), more.end());
    ratio.source = c.experiment() + ": " + metric + " of " + text_of(tested) + " over " + text_of(baseline);
    const cells ratios = c.log_ratios(tested, baseline, measured(metric));
    ratio.log_ratios = {ratios.empty() ? estimate{std::nan("")} : bootstrap(ratios)};
    return ratio;
}

estimate difference_of_means(const cells& above, const cells& below) {
    if (above.empty() || below.empty()) return {std::nan("")};
    return bootstrap(above.size(), [&](const resample& d) { return d.mean_of(above) - d.mean_of(below); });
}

endpoint& draft::add(endpoint e, const std::string& subject, const std::string& along, quantity compared) {
    e.subject = subject;
    e.along = along;
    e.compared = compared;
    return add(std::move(e));
}

std::optional<double> median_of(const condition& c, const selection& tested, const row_value& value) {
    const std::optional<quartiles> spread = c.spread(tested, value);
    return spread ? std::optional(spread->median) : std::nullopt;
}

std::optional<double> inversions_of(const condition& c) {
    return median_of(c, {{kind::sort, "insertion"}}, per_object(measured("inversions")));
}

std::string digits_cell(const std::optional<double>& value) {
    return value ? three_digits(*value) : "-";
}

/// Adds a column per method but the first to a table with a row per scene: its time per frame over that of the first.
void add_ratios(table& t, const std::vector<condition>& conditions, std::span<const method> methods) {
    for (const method& m : methods.subspan(1)) {
        t.columns.push_back({m.label});
        for (std::size_t i = 0; i < conditions.size(); ++i)
            t.rows[i].push_back(
                ratio_cell(endpoint_of(conditions[i], m.tested, methods.front().tested, "frame_cpu_ms")));
    }
}

figure_point point_of(double x, const endpoint& e) {
    const estimate ratio = e.log_ratio();
    const interval range = ratio.range();
    return {x, std::exp(ratio.value), std::exp(range.low), std::exp(range.high)};
}

/// A line of a figure: a composition's medians, one point per condition (scene), at the position `x` of the condition.
series series_of(const std::string& label, std::span<const condition* const> conditions, const condition_number& x,
                 const selection& tested, const row_value& value) {
    series s{label};
    for (const condition* c : conditions)
        if (const auto point = c->point(x(*c), tested, value)) s.points.push_back(*point);
    std::ranges::sort(s.points, {}, &figure_point::x);
    return s;
}

std::vector<series> series_of(std::span<const method> methods, std::span<const condition* const> conditions,
                              const condition_number& x, const row_value& value) {
    std::vector<series> lines;
    for (const method& m : methods) lines.push_back(series_of(m.label, conditions, x, m.tested, value));
    return lines;
}

/// Lines of a figure: ratios against the number of huge boxes, one per edge length, and the baseline's level, 1.
/// @param wanted factors that a ratio must have to be drawn
std::vector<series> lines_by_span(std::span<const endpoint> ratios, const factors& wanted, const std::string& level) {
    std::map<std::string, series> by_span;
    for (const endpoint& e : ratios) {
        const std::string span = value_of(e.where, "span");
        if (span.empty() || !e.is_known() || !matches(e.where, wanted)) continue;
        series& line = by_span[span];
        line.label = "edge " + span + " of the world";
        line.points.push_back(point_of(number_of(e.where, "huge"), e));
    }
    std::vector<series> lines;
    for (auto& [span, line] : by_span) lines.push_back(std::move(line));
    lines.push_back(level_of(level));
    return lines;
}

}  // namespace aabblab
