module;
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

selection canonical(const std::string& build) {
    return {{kind::tree, "canonical"}, {kind::build, build}};
}

/// What each build costs and brings.
table builds(const std::vector<condition>& conditions) {
    table t{{{"meshes", false},
             {"build", false},
             {"build (ms)"},
             {"query (ms)"},
             {"box tests a query"},
             {"triangle tests a query"}},
            {}};
    for (const condition& c : conditions)
        for (const char* build : {"median", "mean", "midpoint", "sah"}) {
            std::vector<std::string> cells{mesh_of(c), build};
            for (const row_value& of : {measured("build_cpu_ms"), measured("detect_cpu_ms"), measured("box_tests"),
                                        measured("triangle_tests")}) {
                const auto value = c.spread(canonical(build), of);
                cells.push_back(value ? three_digits(value->median) : "-");
            }
            t.rows.push_back(cells);
        }
    return t;
}

}  // namespace

draft balanced_tree(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C8";
    claim.claim = "The balanced (median) tree is searched faster than an unbalanced one";
    claim.measured = "time a query, canonical tree split at the median over the same split otherwise";
    claim.lead = "Split at the median";
    claim.experiments = {"table1"};
    const std::vector<condition>& conditions = m.of("table1");
    const std::pair<const char*, const char*> others[] = {
        {"mean", "against the mean"}, {"midpoint", "against the middle of the box"}, {"sah", "against surface area"}};
    for (const auto& [build, subject] : others)
        for (const condition& c : conditions) {
            made.candidates.push_back(told(
                candidate_of(c, canonical("median"), canonical(build), "detect_cpu_ms", {{"over", build}}), subject));
            made.candidates.back().primary = mesh_of(c) == "noise_sphere:triangles=20000";
        }
    claim.tables.push_back(
        {"c8_builds", "Medians of time and work of canonical trees, by where nodes are split.", builds(conditions)});
    figure f{"c8",
             "Time of a query in the canonical tree split at the median, over that of one split at the mean, at the "
             "middle of the box, and by surface area, with 95 % intervals: above 1 the median is slower.",
             {"meshes", false, {}},
             {"time, median over other splits", false, {}},
             {},
             {}};
    for (const char* build : {"mean", "midpoint", "sah"}) {
        series s{std::string("over ") + build, series_style::points, {}};
        for (std::size_t i = 0; i < conditions.size(); ++i) {
            const candidate ratio = candidate_of(conditions[i], canonical("median"), canonical(build), "detect_cpu_ms");
            if (!ratio.known()) continue;
            s.points.push_back(point_of(static_cast<double>(i), ratio));
        }
        f.lines.push_back(s);
    }
    for (std::size_t i = 0; i < conditions.size(); ++i)
        f.x.names.emplace_back(static_cast<double>(i), mesh_of(conditions[i]));
    f.lines.push_back({"equal", series_style::level, {{0, 1, 1, 1}}});
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
