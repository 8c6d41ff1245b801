module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

namespace {

/// All of the program: the paper names none.
const std::pair<std::string, const char*> gap_sequences[] = {{"ciura", "with Ciura's gaps"},
                                                             {"ciura_eight", "with Ciura's eight gaps"},
                                                             {"four_one", "with the gaps 4 and 1"},
                                                             {"tokuda", "with Tokuda's gaps"},
                                                             {"shell", "with Shell's own gaps"}};

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
    for (const auto& [gaps, subject] : gap_sequences) t.columns.push_back({gaps});
    for (const condition* c : ordered) {
        std::vector<std::string>& cells = t.rows.emplace_back(
            std::vector{three_digits(disorder_of(*c)), value_of(c->scene(), "scene"),
                        number_text(value_of(c->scene(), "objects")), value_of(c->scene(), "displacement")});
        for (const auto& [gaps, subject] : gap_sequences) cells.push_back(ratio_cell(over_insertion(*c, gaps)));
    }
    return t;
}

/// The time of Shell sort over that of insertion sort against the inversions per element: one panel per gap sequence,
/// one series for boxes in space and one for boxes on a line, one point per condition (scene).
figure figure_of(const std::vector<condition>& conditions) {
    figure f = log_log("c3",
                       "Time of Shell sort over that of insertion sort (the line at 1) against inversions per element, "
                       "a plot for each gap sequence; 95 % intervals.",
                       "inversions per element", "time over that of insertion sort");
    for (const auto& [gaps, subject] : gap_sequences) {
        figure_panel& panel = f.panels.emplace_back();
        panel.title = gaps;
        for (const bool in_space : {true, false}) {
            series s{in_space ? "in space" : "on a line", series_style::points};
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

/// Drafts C3: the time of Shell sort over that of insertion sort. Where boxes move slightly, every gap sequence has its
/// clause. Elsewhere inversions per element decide which sort is faster.
draft c3_claim(const measurements& m) {
    draft c3{.claim = {.lead = "Time to update and sort the boxes, Shell sort compared with insertion sort",
                       .experiments = {"c3"}}};
    const std::vector<condition>& conditions = m.conditions_of("c3");
    const auto moves_slightly = [](const condition& c) { return number_of(c.scene(), "displacement") <= 0.1; };
    for (const auto& [gaps, subject] : gap_sequences)
        for (const condition& c : conditions)
            if (moves_slightly(c))
                c3.add(over_insertion(c, gaps), std::string(subject) + ", at up to 0.1 edges per frame");
    for (const bool in_space : {true, false})
        for (const condition& c : conditions)
            if (is_brownian(c) == in_space && !moves_slightly(c))
                c3.add(over_insertion(c, "ciura"),
                       "with Ciura's gaps, at one edge per frame or more, on " +
                           number_text(value_of(c.scene(), "objects")) +
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
