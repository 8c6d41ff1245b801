module aabblab.claims;

namespace aabblab {

namespace {

/// The classic incremental sweep and prune (Cohen et al., I-COLLIDE, 1995), which keeps its pairs from frame to frame.
const selection incremental = traditional.with(kind::sweep, "incremental");

/// The traditional method with a grid in place of the cut, whose cell size adapts to the scene.
const selection automatic_grid = traditional.with(kind::partition, "uniform_grid:cell_size=auto");

const std::vector<method> methods{{"insertion sort (traditional)", traditional},
                                  {"insertion sort, axial cut", cut},
                                  {"Shell sort", uncut},
                                  {"Shell sort, axial cut (improved)", improved},
                                  {"insertion sort, incremental", incremental},
                                  {"insertion sort, automatic grid", automatic_grid}};

selection three_lists(const selection& one_list) {
    return one_list.with(kind::sweep, "all_axes");
}

/// The phrase by which sentences name a scene other than the drifting one: its boxes, and their displacement if they
/// drift.
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

/// The conditions of drifting cubes: of all sizes at one displacement, and of one size at all others.
struct drifts {
    std::vector<const condition*> of_all_sizes, of_all_displacements;
};
drifts drifts_in(const std::vector<condition>& conditions) {
    return {matching(conditions, {{"scene", "brownian"}, {"displacement", "0.1"}}),
            matching(conditions, {{"scene", "brownian"}, {"objects", "10000"}})};
}

/// Adds the ratio of two compositions in every scene, with one sorted list and with the paper's three. The sentence on
/// the claim reports the ratios of a subject together, ordered along a factor.
void add_all_scenes(draft& claim, const measurements& m, const selection& tested, const selection& baseline) {
    const std::vector<condition>& conditions = m.conditions_of("figure1");
    const auto add = [&](const condition& c, const std::string& subject, const std::string& along = "") {
        claim.add(endpoint_of(c, tested, baseline, "frame_cpu_ms"), subject, along);
    };
    const auto [of_all_sizes, of_all_displacements] = drifts_in(conditions);
    for (const condition* c : of_all_sizes) add(*c, "on cubes that drift by up to 0.1 edges per frame", "objects");
    for (const condition* c : of_all_displacements)
        if (!matches(c->scene(), drifting)) add(*c, "on 10,000 drifting cubes at other displacements", "displacement");
    for (const condition& c : m.conditions_of("three_lists"))
        claim.add(endpoint_of(c, three_lists(tested), three_lists(baseline), "frame_cpu_ms", {{"sweep", "all_axes"}}),
                  "on 10,000 drifting cubes, both with three sorted lists (sweep all_axes)", "displacement");
    for (const condition& c : conditions)
        if (!is_brownian(c)) add(c, subject_of(c));
}

}  // namespace

/// Drafts C1a: the time of the improved broad phase over that of the traditional one, of incremental sweep and prune,
/// and of a grid whose cells adapt to the scene.
draft c1a_claim(const measurements& m) {
    draft c1a{.claim = {.experiments = {"figure1", "three_lists"}}};
    add_all_scenes(c1a, m, improved, traditional);
    const std::vector<condition>& conditions = m.conditions_of("figure1");
    const auto [of_all_sizes, of_all_displacements] = drifts_in(conditions);
    for (const auto& [other, name, subject] :
         {std::tuple{incremental, "incremental",
                     "on 10,000 drifting cubes, compared with the classic incremental sweep"},
          {automatic_grid, "uniform_grid", "on 10,000 drifting cubes, compared with a grid of automatic cell size"}})
        for (const condition* c : of_all_displacements)
            c1a.add(endpoint_of(*c, improved, other, "frame_cpu_ms", {{"over", name}}), subject, "displacement");
    table changes = factors_table(factors_of(conditions));
    add_ratios(changes, conditions, methods);
    c1a.claim.tables.push_back(
        {"figure1",
         std::string("Time per frame over that of the traditional method, with 95 % intervals.") + unit_legend,
         changes});
    c1a.claim.figures.push_back(log_log(
        "figure1",
        "Time of the broad phase against the number of objects: the traditional method, the improved one, and each "
        "change alone. Cubes drift by up to a tenth of their edge per frame; medians and quartiles.",
        "objects", "time per frame (ms)", series_of(methods, of_all_sizes, objects_of, measured("frame_cpu_ms"))));
    // Earlier archives lack the grid.
    std::erase_if(c1a.claim.figures.back().lines, [](const series& line) { return line.points.empty(); });
    return c1a;
}

/// Drafts C1b: the time with the axial cut alone over that of the traditional broad phase.
draft c1b_claim(const measurements& m) {
    draft c1b{.claim = {.lead = "The cut, both with insertion sort", .experiments = {"figure1", "three_lists"}}};
    add_all_scenes(c1b, m, cut, traditional);
    return c1b;
}

/// Drafts C1c: what Shell sort adds to the cut, the time of both over that of the cut with insertion sort.
draft c1c_claim(const measurements& m) {
    draft c1c{.claim = {.lead = "Shell sort, both with the cut", .experiments = {"figure1", "three_lists"}}};
    add_all_scenes(c1c, m, improved, cut);
    return c1c;
}

}  // namespace aabblab
