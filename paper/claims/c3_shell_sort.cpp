module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

namespace {

const std::vector<std::string> gap_sequences{"ciura", "ciura_eight", "four_one", "tokuda", "shell"};

/// Inversions per element; 0 if they were not counted.
double disorder_of(const condition& c) {
    return inversions_of(c).value_or(0);
}

endpoint over_insertion(const condition& c, const std::string& gaps) {
    endpoint ratio = endpoint_of(c, {{kind::sort, "shell:gaps=" + gaps}}, {{kind::sort, "insertion"}}, "update_cpu_ms",
                                 {{"gaps", gaps}});
    ratio.observed = {{"inversions", three_digits(disorder_of(c))}};
    return ratio;
}

/// The time of Shell sort over that of insertion sort, per scene, ordered by inversions, and gap sequence.
table gaps_table(const std::vector<condition>& conditions) {
    std::vector<const condition*> ordered = matching(conditions, {});
    std::ranges::stable_sort(ordered, {}, [](const condition* c) { return disorder_of(*c); });
    table t{{{"inversions per element"}, {"scene", /*is_number=*/false}, {"objects"}, {"displacement"}}, {}};
    for (const std::string& gaps : gap_sequences) t.columns.push_back({gaps});
    for (const condition* c : ordered) {
        std::vector<std::string>& cells = t.rows.emplace_back(
            std::vector{three_digits(disorder_of(*c)), value_of(c->scene(), "scene"),
                        number_text(value_of(c->scene(), "objects")), value_of(c->scene(), "displacement")});
        for (const std::string& gaps : gap_sequences) cells.push_back(ratio_cell(over_insertion(*c, gaps)));
    }
    return t;
}

/// The time of Shell sort over that of insertion sort against the inversions per element: one panel for boxes in space
/// and one for boxes on a line, one series per gap sequence, one point per condition (scene).
figure figure_of(const std::vector<condition>& conditions) {
    figure f = log_log("c3",
                       "Time of Shell sort over that of insertion sort (the line at 1) against inversions per element, "
                       "for each gap sequence; 95 % intervals.",
                       "inversions per element", "time over that of insertion sort");
    for (const bool in_space : {true, false}) {
        figure_panel& panel = f.panels.emplace_back();
        panel.title = in_space ? "in space" : "on a line";
        for (const std::string& gaps : gap_sequences) {
            series s{gaps, series_style::points};
            for (const condition& c : conditions)
                if (const endpoint ratio = over_insertion(c, gaps);
                    is_brownian(c) == in_space && ratio.is_known() && disorder_of(c) > 0)
                    s.points.push_back(point_of(disorder_of(c), ratio));
            std::ranges::sort(s.points, {}, &figure_point::x);
            panel.lines.push_back(s);
        }
    }
    f.lines.push_back(level_of("insertion sort"));
    return f;
}

}  // namespace

/// Drafts C3: the time of Shell sort over that of insertion sort; inversions per element decide which is faster.
draft c3_claim(const measurements& m) {
    // In full runs, the first primary condition has few inversions (4 per element), and the second many (150): boxes on
    // a line that move by up to 300 of their edge lengths per frame. In space, 100,000 boxes that move by one edge
    // length have about as many (186), but a frame takes ten times as long: more boxes overlap on the swept axis.
    draft c3{
        .claim = {.claim = "Shell sort beats insertion sort under temporal coherence",
                  .measured = "time per frame to update and sort the boxes, shell with Ciura's gaps over insertion",
                  .lead = "Time to update and sort the boxes, Shell sort compared with insertion sort",
                  .experiments = {"c3"}},
        .primary = {drifting, {{"scene", "line"}, {"objects", "100000"}, {"displacement", "300"}}}};
    const std::vector<condition>& conditions = m.conditions_of("c3");
    for (const bool in_space : {true, false})
        for (const condition& c : conditions)
            if (is_brownian(c) == in_space)
                c3.add(over_insertion(c, "ciura"),
                       "on " + number_text(value_of(c.scene(), "objects")) +
                           (in_space ? " boxes in space" : " boxes on a line"),
                       "inversions");
    if (conditions.empty()) return c3;
    c3.claim.tables.push_back({"c3_map",
                               "Time of Shell sort over that of insertion sort, for each gap sequence, by inversions.",
                               gaps_table(conditions)});
    c3.claim.figures.push_back(figure_of(conditions));
    return c3;
}

}  // namespace aabblab
