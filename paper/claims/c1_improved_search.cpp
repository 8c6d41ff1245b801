module aabblab.claims;

namespace aabblab {

namespace {

/// The classic incremental sweep and prune (Cohen et al., I-COLLIDE, 1995), which keeps its pairs from frame to frame.
const selection incremental = traditional.with(kind::sweep, "incremental");

const std::vector<method> methods{{"insertion sort (traditional)", traditional},
                                  {"insertion sort, axial cut", traditional.with(kind::partition, "axial_cut:axes=2")},
                                  {"Shell sort", uncut},
                                  {"Shell sort, axial cut (improved)", improved},
                                  {"insertion sort, incremental", incremental}};

/// The phrase by which the sentence on claim C1 names a scene other than the drifting one: its boxes, and their
/// displacement if they drift.
std::string subject_of(const condition& c) {
    const std::string scene = value_of(c.scene(), "scene");
    const std::string boxes = "on " + number_text(value_of(c.scene(), "objects")) + " boxes";
    if (scene == "still") return boxes + " at rest";
    if (scene == "teleport") return boxes + " that all jump in every frame";
    const std::string place = scene == "clustered"     ? " in clusters"
                              : scene == "mixed_sizes" ? " of mixed sizes"
                                                       : ", one of them huge,";
    const bool is_in_spacings = value_of(c.scene(), "unit") == "spacing";
    return boxes + place + " at 0.1 mean " + (is_in_spacings ? "spacings" : "edges") + " per frame";
}

}  // namespace

/// Drafts C1: the time of the improved broad phase over that of the traditional one, or of incremental sweep and prune,
/// per scene. The ratios with the factors in `primary` decide; those of each change alone only explain the verdict.
draft c1_claim(const measurements& m) {
    draft c1{
        .claim = {.claim = "Shell sort with axial cut takes less time in the broad phase than insertion sort alone",
                  .measured = "time per frame of shell + axial_cut over that of insertion + none, both with the sweep "
                              "one_axis or both with all_axes; and over that of insertion + incremental",
                  .experiments = {"figure1", "three_lists"}},
        .primary = {{{"scene", "brownian"}, {"objects", "10000"}, {"displacement", "0.1"}, {"over", ""}},
                    {{"scene", "brownian"}, {"objects", "10000"}, {"displacement", "0.001"}, {"over", "incremental"}}}};
    const std::vector<condition>& conditions = m.conditions_of("figure1");
    // The sentence on the claim reports the ratios of a subject together, ordered along a factor.
    const auto add = [&](const condition& c, const std::string& subject, const std::string& along = "") {
        c1.add(endpoint_of(c, improved, traditional, "frame_cpu_ms"), subject, along);
    };
    const std::vector<const condition*> of_all_sizes =
        matching(conditions, {{"scene", "brownian"}, {"displacement", "0.1"}});
    const std::vector<const condition*> large = matching(conditions, {{"scene", "brownian"}, {"objects", "10000"}});
    for (const condition* c : of_all_sizes) add(*c, "on cubes that drift by up to 0.1 edges per frame", "objects");
    for (const condition* c : large)
        if (!matches(c->scene(), drifting)) add(*c, "on 10,000 drifting cubes at other displacements", "displacement");
    // Both compositions with the paper's three lists, each sorted and swept.
    for (const condition& c : m.conditions_of("three_lists"))
        c1.add(endpoint_of(c, improved.with(kind::sweep, "all_axes"), traditional.with(kind::sweep, "all_axes"),
                           "frame_cpu_ms", {{"sweep", "all_axes"}}),
               "on 10,000 drifting cubes, both with three sorted lists (sweep all_axes)", "displacement");
    for (const condition* c : large)
        c1.add(endpoint_of(*c, improved, incremental, "frame_cpu_ms", {{"over", "incremental"}}),
               "on 10,000 drifting cubes, compared with the classic incremental sweep", "displacement");
    for (const condition& c : conditions)
        if (!is_brownian(c)) add(c, subject_of(c));
    for (const condition* c : matching(conditions, drifting))
        for (const auto& [changed, subject] :
             {std::pair{methods[1].tested,
                        "with the cut alone, on 10,000 cubes that drift by up to 0.1 edges per frame"},
              {uncut, "with Shell sort alone"}})
            c1.unjudged.emplace_back(endpoint_of(*c, changed, traditional, "frame_cpu_ms")).subject = subject;
    table changes = factors_table(factors_of(conditions));
    add_ratios(changes, conditions, methods);
    c1.claim.tables.push_back(
        {"figure1",
         std::string("Time per frame over that of the traditional method, with 95 % intervals.") + unit_legend,
         changes});
    c1.claim.figures.push_back(log_log(
        "figure1",
        "Time of the broad phase against the number of objects: the traditional method, the improved one, and each "
        "change alone. Cubes drift by up to a tenth of their edge per frame; medians and quartiles.",
        "objects", "time per frame (ms)", series_of(methods, of_all_sizes, objects_of, measured("frame_cpu_ms"))));
    return c1;
}

}  // namespace aabblab
