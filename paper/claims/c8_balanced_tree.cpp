module aabblab.claims;

namespace aabblab {

namespace {

selection canonical(const std::string& build) {
    return {{kind::tree, "canonical"}, {kind::build, build}};
}

/// One row per mesh and split rule: median times to build a canonical tree and to query it, and counted work.
table builds_table(const std::vector<condition>& conditions) {
    table t = empty_table({"meshes", "build"},
                          {"build (ms)", "query (ms)", "box tests per query", "triangle tests per query"});
    for (const condition& c : conditions)
        for (const char* build : {"median", "mean", "midpoint", "sah"}) {
            std::vector<std::string> cells{mesh_of(c), build};
            for (const row_value& value : {measured("build_cpu_ms"), measured("detect_cpu_ms"), measured("box_tests"),
                                           measured("triangle_tests")})
                cells.push_back(digits_cell(median_of(c, canonical(build), value)));
            t.rows.push_back(cells);
        }
    return t;
}

}  // namespace

/// Drafts C8: the query time of a canonical tree split at the median over that with another rule, per mesh and rule.
draft c8_claim(const measurements& m) {
    draft c8{.claim = {.lead = "Queries of trees split at the median", .experiments = {"table1"}}};
    const std::vector<condition>& conditions = m.conditions_of("table1");
    figure f{"c8",
             "Time of a query in the canonical tree split at the median, over that of one split at the mean, at the "
             "middle of the box, and by the surface area heuristic; 95 % intervals. Above 1 the median is slower.",
             {"meshes"},
             {"time, median over other splits"}};
    const std::pair<const char*, const char*> others[] = {
        {"mean", "compared with splits at the mean"},
        {"midpoint", "compared with splits at the middle of the box"},
        {"sah", "compared with splits by the surface area heuristic"}};
    for (const auto& [build, subject] : others) {
        series& s = f.lines.emplace_back(series{std::string("over ") + build, series_style::points});
        for (const condition& c : conditions) {
            const endpoint& ratio = c8.add(
                endpoint_of(c, canonical("median"), canonical(build), "detect_cpu_ms", {{"over", build}}), subject);
            if (ratio.is_known()) s.points.push_back(point_of(static_cast<double>(&c - conditions.data()), ratio));
        }
    }
    c8.claim.tables.push_back({"c8_builds", "Medians of time and work of canonical trees, for each rule of splitting.",
                               builds_table(conditions)});
    for (std::size_t i = 0; i < conditions.size(); ++i)
        f.x.names.emplace_back(static_cast<double>(i), mesh_of(conditions[i]));
    f.lines.push_back(level_of("equal", /*x=*/0));
    c8.claim.figures.push_back(f);
    return c8;
}

}  // namespace aabblab
