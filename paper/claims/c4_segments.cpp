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

/// Whether more wanted segments give more real ones, which the limit of one cut per box may prevent.
bool is_finer(const condition& c, int axes, int wanted, int before) {
    const auto segments = segments_got(c, axes, wanted);
    const auto coarser = segments_got(c, axes, before);
    return segments && coarser && *segments > 1.1 * *coarser;
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
    constexpr int beyond_limit = segments_wanted.back();  // more than the limit allows anywhere
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

}  // namespace

/// Drafts C4: the time of a finer cut over that of a coarser one, and of the automatic number of segments over "the
/// limit": the most segments with at most one cut per box, which a request for more yields.
draft c4_claim(const measurements& m) {
    draft c4{
        .claim = {.claim = "More segments are faster until a box spans a whole one; tiny segments are not needed",
                  .measured = "time per frame at the limit of one cut per box over that with eight segments per axis; "
                              "with each number of segments over that with the next smaller one, up to the limit; and "
                              "with the automatic number over that at the limit",
                  .experiments = {"c4"}},
        .primary = {{{"scene", "brownian"}, {"axes", "2"}, {"segments", "the limit"}},
                    {{"scene", "brownian"}, {"axes", "3"}, {"segments", "the limit"}},
                    {{"scene", "brownian"}, {"axes", "2"}, {"segments", "auto"}},
                    {{"scene", "brownian"}, {"axes", "3"}, {"segments", "auto"}}}};
    const std::vector<condition>& conditions = m.conditions_of("c4");
    const auto for_each_cut = [&](auto add_ratios_of) {
        for (const condition& c : conditions)
            for (int axes = 1; axes <= 3; ++axes) add_ratios_of(c, axes);
    };
    /// A number of segments and its name among the factors: the number itself, or "the limit".
    struct segments {
        std::string number;
        std::string name;
    };
    const segments limit{std::to_string(segments_wanted.back()), "the limit"};  // more than the limit allows anywhere
    const auto ratio = [](const condition& c, int axes, const segments& finer, const segments& coarser) {
        return endpoint_of(c, cut_into(axes, finer.number), cut_into(axes, coarser.number), "frame_cpu_ms",
                           {{"axes", std::to_string(axes)}, {"segments", finer.name}, {"over", coarser.name}});
    };
    const auto boxes_of = [](const condition& c) {
        return number_text(value_of(c.scene(), "objects")) +
               (is_brownian(c) ? " drifting cubes" : " cubes in clusters");
    };
    for_each_cut([&](const condition& c, int axes) {
        const std::string gloss = is_brownian(c) ? " (the most segments such that no box spans a whole one)" : "";
        c4.add(ratio(c, axes, limit, {"8", "8"}),
               boxes_of(c) + " at the limit" + gloss + ", compared with eight segments per axis", "axes");
    });
    for_each_cut([&](const condition& c, int axes) {
        for (std::size_t i = 1; i < segments_wanted.size(); ++i) {
            const std::string finer = std::to_string(segments_wanted[i]);
            const std::string coarser = std::to_string(segments_wanted[i - 1]);
            if (is_finer(c, axes, segments_wanted[i], segments_wanted[i - 1]))
                c4.add(ratio(c, axes, {finer, finer}, {coarser, coarser}));
        }
    });
    // Segments need not be tiny: the automatic number is as good as the most that the limit allows.
    for_each_cut([&](const condition& c, int axes) {
        c4.add(ratio(c, axes, {"auto", "auto"}, limit),
               boxes_of(c) + ", automatic number of segments, compared with the limit", "axes")
            .expected = expectation::not_more;
    });
    if (conditions.empty()) return c4;
    c4.claim.tables.push_back({"c4_auto", "Segments per axis and time, with the automatic number and at the limit.",
                               automatic_table(conditions)});
    for (const condition& c : conditions)
        c4.claim.figures.push_back(figure_of(&c == conditions.data() ? "c4" : "c4_" + value_of(c.scene(), "scene"), c));
    return c4;
}

}  // namespace aabblab
