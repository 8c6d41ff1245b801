module aabblab.claims;

namespace aabblab {

/// Drafts C12: the box tests counted with the axial cut over those without it, both with Shell sort, per scene.
draft c12_claim(const measurements& m) {
    draft c12{.claim = {.lead = "The axial cut, compared with no cut", .experiments = {"figure1", "three_lists"}}};
    for (const condition& c : m.conditions_of("figure1"))
        c12.add(endpoint_of(c, improved, uncut, "box_tests"), is_brownian(c) ? "on drifting cubes" : "in other scenes",
                /*along=*/is_brownian(c) ? "objects" : "", quantity::box_tests);
    for (const condition& c : m.conditions_of("three_lists"))
        c12.add(endpoint_of(c, improved.with(kind::sweep, "all_axes"), uncut.with(kind::sweep, "all_axes"), "box_tests",
                            {{"sweep", "all_axes"}}),
                "on 10,000 drifting cubes, both with three sorted lists (sweep all_axes)", /*along=*/"",
                quantity::box_tests);
    const method methods[] = {{"no cut", uncut}, {"axial cut", improved}};
    c12.claim.figures.push_back(log_log(
        "c12", "Box tests per frame against the number of objects, with the axial cut and without.", "objects",
        "box tests per frame",
        series_of(methods, matching(m.conditions_of("figure1"), {{"scene", "brownian"}, {"displacement", "0.1"}}),
                  objects_of, measured("box_tests"))));
    return c12;
}

}  // namespace aabblab
