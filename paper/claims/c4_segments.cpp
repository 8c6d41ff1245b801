module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

namespace {

constexpr std::array segments_wanted{2, 4, 8, 16, 32, 64, 256};

selection cut_into(int axes, const std::string& segments) {
    return {{kind::sort, "insertion"},
            {kind::partition, "axial_cut:axes=" + std::to_string(axes) + ",segments=" + segments},
            {kind::sweep, "one_axis"}};
}

/// The segments per cut axis; empty if not measured.
std::optional<double> segments_got(const condition& c, int axes, int wanted) {
    const auto got = median_of(c, cut_into(axes, std::to_string(wanted)), measured("segments_got"));
    return got ? std::optional(*got / axes) : std::nullopt;
}

/// The time in one scene against the requested segments per axis, a line per number of cut axes. A mark shows the
/// number of segments that the limit of one cut per box leaves of the greatest request.
figure figure_of(const std::string& name, const condition& c) {
    figure f = log_log(
        name,
        "Time of the broad phase against the requested segments per axis, with one, two and three axes cut, on " +
            value_of(c.scene(), "scene") +
            ". Marks show how many segments the limit of one cut per box allows. The level is without a cut.",
        "requested segments per axis", "time per frame (ms)");
    for (int axes = 1; axes <= 3; ++axes) {
        series s{std::to_string(axes) + (axes == 1 ? " axis" : " axes")};
        for (const int wanted : segments_wanted)
            if (const auto point = c.point(wanted, cut_into(axes, std::to_string(wanted)), measured("frame_cpu_ms")))
                s.points.push_back(*point);
        f.lines.push_back(s);
        if (const auto limit = segments_got(c, axes, segments_wanted.back()))
            f.marks.push_back({*limit, "limit, " + s.label});
    }
    if (const auto uncut = c.point(segments_wanted.front(), traditional, measured("frame_cpu_ms")))
        f.lines.push_back({"no cut", series_style::level, {*uncut}});
    return f;
}

/// The automatic number of segments per scene and number of cut axes, and its time over that with the limit's number.
table automatic_table(const std::vector<condition>& conditions) {
    table t = factors_table(factors_of(conditions));
    const std::vector<std::vector<std::string>> cells_of_factors = std::exchange(t.rows, {});  // by condition
    constexpr int beyond_limit = segments_wanted.back();
    t.columns.insert(t.columns.end(), {{"axes"}, {"segments, auto"}, {"segments, limit"}, {"time, auto over limit"}});
    for (const condition& c : conditions)
        for (int axes = 1; axes <= 3; ++axes) {
            const endpoint ratio =
                endpoint_of(c, cut_into(axes, "auto"), cut_into(axes, std::to_string(beyond_limit)), "frame_cpu_ms");
            const auto chosen = median_of(c, cut_into(axes, "auto"), measured("segments_got"));  // sum over the axes
            const auto limit = segments_got(c, axes, beyond_limit);
            if (!ratio.is_known() || !chosen || !limit) continue;
            std::vector<std::string>& cells =
                t.rows.emplace_back(cells_of_factors[static_cast<std::size_t>(&c - conditions.data())]);
            cells.insert(cells.end(),
                         {std::to_string(axes), three_digits(*chosen / axes), three_digits(*limit), ratio_cell(ratio)});
        }
    return t;
}

/// A number of segments as a parameter, and its name among the factors.
struct segments {
    std::string number;
    std::string name;
};
segments exactly(int number) {
    return {std::to_string(number), std::to_string(number)};
}
/// The most segments with at most one cut per box, which a request for more than the limit allows anywhere yields.
const segments the_limit{std::to_string(segments_wanted.back()), "the limit"};

endpoint ratio_of(const condition& c, int axes, const segments& tested, const segments& baseline) {
    return endpoint_of(c, cut_into(axes, tested.number), cut_into(axes, baseline.number), "frame_cpu_ms",
                       {{"axes", std::to_string(axes)}, {"segments", tested.name}, {"over", baseline.name}});
}

std::string boxes_of(const condition& c) {
    return "on " + number_text(value_of(c.scene(), "objects")) +
           (is_brownian(c) ? " drifting cubes" : " cubes in clusters");
}

}  // namespace

/// Drafts C4a: the time of a finer cut over that of one half as fine, up to the limit.
draft c4a_claim(const measurements& m) {
    draft c4a{.claim = {.lead = "Time with more segments per axis", .experiments = {"c4"}}};
    const std::vector<condition>& conditions = m.conditions_of("c4");
    std::vector<std::pair<segments, segments>> steps;  // finer and coarser
    for (const int coarser : {2, 4, 8, 16}) steps.emplace_back(exactly(2 * coarser), exactly(coarser));
    steps.emplace_back(the_limit, exactly(32));
    for (const condition& c : conditions)
        for (int axes = 1; axes <= 3; ++axes)
            for (const auto& [finer, coarser] : steps)
                c4a.add(ratio_of(c, axes, finer, coarser),
                        boxes_of(c) + ", " + finer.name + " instead of " + coarser.name, "axes");
    for (const condition& c : conditions)
        for (int axes = 1; axes <= 3; ++axes) c4a.add(ratio_of(c, axes, the_limit, exactly(8)));
    for (const condition& c : conditions)
        c4a.claim.figures.push_back(
            figure_of(&c == conditions.data() ? "c4" : "c4_" + value_of(c.scene(), "scene"), c));
    return c4a;
}

/// Drafts C4b: the time with the automatic number of segments over that at the limit.
draft c4b_claim(const measurements& m) {
    draft c4b{.claim = {.lead = "Time with the automatic number of segments, compared with the limit",
                        .experiments = {"c4"}}};
    const std::vector<condition>& conditions = m.conditions_of("c4");
    for (const condition& c : conditions)
        for (int axes = 1; axes <= 3; ++axes)
            c4b.add(ratio_of(c, axes, {"auto", "auto"}, the_limit), boxes_of(c), "axes");
    if (conditions.empty()) return c4b;
    c4b.claim.tables.push_back({"c4_auto", "Segments per axis and time, with the automatic number and at the limit.",
                                automatic_table(conditions)});
    return c4b;
}

}  // namespace aabblab
