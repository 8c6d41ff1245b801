module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.figures;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

const std::vector<std::string>& gap_sequences() {
    static const std::vector<std::string> all{"ciura", "tokuda", "shell"};
    return all;
}

struct compared {
    double displacement;
    double log_ratio;
};

/// The least displacement at which the ratio falls to 1, between the two that enclose it, on logarithmic scales.
std::optional<double> crossover(std::vector<compared> along) {
    std::ranges::sort(along, {}, &compared::displacement);
    for (std::size_t i = 1; i < along.size(); ++i) {
        const compared& a = along[i - 1];
        const compared& b = along[i];
        if (a.log_ratio > 0 && b.log_ratio <= 0)
            return a.displacement *
                   std::pow(b.displacement / a.displacement, a.log_ratio / (a.log_ratio - b.log_ratio));
    }
    return std::nullopt;
}

}  // namespace

claim_result shell_sort(const measurements& m) {
    claim_result claim;
    claim.id = "C3";
    claim.claim = "Shell sort beats insertion sort under temporal coherence";
    claim.measured =
        "time to take and sort the boxes of a frame, shell over insertion, where objects move by an edge at most";
    claim.experiments = {"c3"};
    const std::vector<condition>& conditions = m.of("c3");
    std::vector<candidate> candidates;
    figure f{
        "c3",
        "Who sorts faster, over the number of objects and the way that they move in a frame, on brownian: the marks "
        "are the conditions measured, with Ciura's gaps; for each sequence of gaps it is shown where Shell sort "
        "begins to win, where it does.",
        {"objects", true, {}},
        {"displacement a frame (edges)", true, {}},
        {},
        {}};
    series shell_wins{"Shell sort wins", series_style::points, {}};
    series insertion_wins{"insertion sort wins", series_style::points, {}};
    series nobody{"no difference, or undecided", series_style::points, {}};
    for (const std::string& gaps : gap_sequences()) {
        std::map<std::pair<std::string, double>, std::vector<compared>> along;
        for (const condition& c : conditions) {
            candidate one = candidate_of(c, {{kind::sort, "shell:gaps=" + gaps}}, {{kind::sort, "insertion"}},
                                         measured("update_ms"), {{"gaps", gaps}});
            const double objects = number_of(c.of(), "objects");
            const double displacement = number_of(c.of(), "displacement");
            const std::string scene = value_of(c.of(), "scene");
            one.primary =
                gaps == "ciura" && scene == "brownian" && objects == 10000 && value_of(c.of(), "displacement") == "0.1";
            along[{scene, objects}].push_back({displacement, one.log_ratio.value});
            candidates.push_back(std::move(one));
        }
        series line{"begins to win, gaps " + gaps, series_style::line, {}};
        for (const auto& [place, points] : along)
            if (place.first == "brownian")
                if (const std::optional<double> at = crossover(points))
                    line.points.push_back({place.second, *at, *at, *at});
        f.lines.push_back(line);
    }
    // The map is of all conditions; the claim of those in which an object still touches where it was.
    claim_result map = claim;
    judge(map, candidates);
    std::erase_if(candidates, [](const candidate& one) { return number_of(one.where, "displacement") > 1; });
    judge(claim, std::move(candidates));
    claim.tables.push_back(
        {"c3_map",
         "Who wins, over all conditions, coherent or not. Outcomes are by Holm's rule, intervals are "
         "each one's own.",
         map.tables.front().content});
    std::vector<endpoint> decided = map.secondary;
    if (map.has_primary) decided.push_back(map.primary);
    for (const endpoint& one : decided) {
        if (value_of(one.where, "gaps") != "ciura" || value_of(one.where, "scene") != "brownian") continue;
        series& where = one.found == support::favours       ? shell_wins
                        : one.found == support::contradicts ? insertion_wins
                                                            : nobody;
        const double displacement = number_of(one.where, "displacement");
        where.points.push_back({number_of(one.where, "objects"), displacement, displacement, displacement});
    }
    f.lines.insert(f.lines.end(), {shell_wins, insertion_wins, nobody});
    claim.figures.push_back(f);
    return claim;
}

}  // namespace aabblab
