module;
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.figures;
import aabblab.numbers;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

const std::vector<std::string>& gap_sequences() {
    static const std::vector<std::string> all{"ciura", "ciura_eight", "four_one", "tokuda", "shell"};
    return all;
}

/// In the list that is sorted, an element; 0 where they were not counted.
double inversions_of(const condition& c) {
    const auto found = c.spread({{kind::sort, "insertion"}}, an_object(measured("inversions")));
    return found ? found->median : 0;
}

candidate over_insertion(const condition& c, const std::string& gaps) {
    candidate ratio = candidate_of(c, {{kind::sort, "shell:gaps=" + gaps}}, {{kind::sort, "insertion"}},
                                   "update_cpu_ms", {{"gaps", gaps}});
    ratio.observed = {{"inversions", three_digits(inversions_of(c))}};
    return ratio;
}

/// Every sequence of gaps in every condition, by inversions.
table map_of(const std::vector<condition>& conditions) {
    std::vector<const condition*> ordered;
    for (const condition& c : conditions) ordered.push_back(&c);
    std::ranges::stable_sort(ordered, {}, [](const condition* c) { return inversions_of(*c); });
    table t{{{"inversions an element"}, {"scene", false}, {"objects"}, {"displacement"}}, {}};
    for (const std::string& gaps : gap_sequences()) t.columns.push_back({gaps});
    for (const condition* c : ordered) {
        std::vector<std::string>& cells =
            t.rows.emplace_back(std::vector{three_digits(inversions_of(*c)), value_of(c->of(), "scene"),
                                            value_of(c->of(), "objects"), value_of(c->of(), "displacement")});
        for (const std::string& gaps : gap_sequences()) {
            const candidate ratio = over_insertion(*c, gaps);
            cells.push_back(ratio.known() ? ratio_text(endpoint_of(ratio, expectation::less)) : "-");
        }
    }
    return t;
}

figure figure_of(const std::vector<condition>& conditions) {
    figure f{"c3",
             "Time of Shell sort over that of insertion sort (the level 1) against inversions an element, "
             "for each sequence of gaps; 95 % intervals.",
             {"inversions an element", true, {}},
             {"time over that of insertion sort", true, {}},
             {},
             {}};
    for (const bool in_space : {true, false}) {
        figure_panel& panel = f.panels.emplace_back();
        panel.title = in_space ? "in space" : "on a line";
        for (const std::string& gaps : gap_sequences()) {
            series s{gaps, series_style::points, {}};
            for (const condition& c : conditions)
                if (const candidate ratio = over_insertion(c, gaps);
                    is_brownian(c) == in_space && ratio.known() && inversions_of(c) > 0)
                    s.points.push_back(point_of(inversions_of(c), ratio));
            std::ranges::sort(s.points, {}, &figure_point::x);
            panel.lines.push_back(s);
        }
    }
    f.lines.push_back({"insertion sort", series_style::level, {{1, 1, 1, 1}}});
    return f;
}

}  // namespace

draft shell_sort(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C3";
    claim.claim = "Shell sort beats insertion sort under temporal coherence";
    claim.measured = "time to take and sort the boxes of a frame, shell with Ciura's gaps over insertion";
    claim.experiments = {"c3"};
    const std::vector<condition>& conditions = m.of("c3");
    for (const bool in_space : {true, false})
        for (const condition& c : conditions)
            if (is_brownian(c) == in_space) {
                candidate one = told(over_insertion(c, "ciura"),
                                     "on " + number_text(value_of(c.of(), "objects")) +
                                         (in_space ? " boxes in space" : " boxes on a line"),
                                     "inversions");
                // Few inversions and many. As many as boxes on a line that move by 300 edges have 100,000 in space
                // that move by one (186 an element, in full runs), for a hundredth of the time.
                one.primary = is_drifting(c) || (!in_space && value_of(c.of(), "objects") == "100000" &&
                                                 value_of(c.of(), "displacement") == "300");
                made.candidates.push_back(std::move(one));
            }
    if (conditions.empty()) return made;
    claim.tables.push_back(
        {"c3_map", "Time over that of insertion sort, with each sequence of gaps, by inversions.", map_of(conditions)});
    claim.figures.push_back(figure_of(conditions));
    return made;
}

}  // namespace aabblab
