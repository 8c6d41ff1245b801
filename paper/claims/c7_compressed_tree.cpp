module aabblab.claims;

namespace aabblab {

namespace {

selection tree(const std::string& name) {
    return {{kind::tree, name}};
}

std::vector<const condition*> conditions_by_size(const measurements& m) {
    std::vector<const condition*> conditions;
    for (const char* experiment : {"figure2", "figure2_million"})
        for (const condition& c : m.conditions_of(experiment)) conditions.push_back(&c);
    std::ranges::stable_sort(conditions, {}, &condition::triangles);
    return conditions;
}

/// The bytes or times of four tree layouts against the number of triangles, on spheres with noise of many sizes.
figure size_figure(const measurements& m, const std::string& name, const std::string& caption, const std::string& y,
                   const row_value& value) {
    const method layouts[] = {{"canonical", tree("canonical")},
                              {"leafless", tree("leafless:leaf_test=triangle_box")},
                              {"shared planes", tree("shared_planes")},
                              {"compressed", tree(compressed)}};
    std::vector<const condition*> generated = conditions_by_size(m);
    std::erase_if(generated, [](const condition* c) { return !mesh_of(*c).starts_with("noise_sphere"); });
    return log_log(name, caption, "triangles", y, series_of(layouts, generated, &condition::triangles, value));
}

endpoint compressed_over_canonical(const condition& c, const std::string& metric, const std::string& leaf_test) {
    return endpoint_of(c, tree("compressed:leaf_test=" + leaf_test), tree("canonical"), metric,
                       {{"leaf_test", leaf_test}, {"triangles", std::to_string(std::llround(c.triangles()))}});
}

}  // namespace

/// Drafts C7a: the bytes of the compressed tree over those of the canonical one, per mesh.
draft c7a_claim(const measurements& m) {
    draft c7a{.claim = {.lead = "The compressed tree, compared with the canonical one",
                        .experiments = {"figure2", "figure2_million"}}};
    for (const condition* c : conditions_by_size(m))
        c7a.add(compressed_over_canonical(*c, "tree_bytes", "triangle_box"), /*subject=*/"", /*along=*/"",
                quantity::bytes);
    c7a.claim.figures.push_back(size_figure(m, "figure2_bytes", "Allocated bytes of trees per triangle.",
                                            "bytes per triangle", measured("tree_bytes")));
    c7a.claim.figures.back().y.logarithmic = false;
    return c7a;
}

/// Drafts C7b: the query time of the compressed tree over that of the canonical one, per mesh and leaf test, which
/// replaces the test of the box that its leaves do not store.
draft c7b_claim(const measurements& m) {
    draft c7b{.claim = {.lead = "Queries of the compressed tree, in which a leaf's triangle is tested against boxes, "
                                "compared with the canonical one",
                        .experiments = {"figure2", "figure2_million"}}};
    const std::pair<const char*, const char*> leaf_tests[] = {
        {"triangle_box", ""},
        {"triangle_aabb", "if a leaf is tested by the box of its triangle, computed on the fly"},
        {"none", "if a leaf is tested only by its parent's box"}};
    for (const auto& [leaf_test, subject] : leaf_tests)
        for (const condition* c : conditions_by_size(m))
            c7b.add(compressed_over_canonical(*c, "detect_cpu_ms", leaf_test), subject);
    c7b.claim.figures.push_back(
        size_figure(m, "figure2",
                    "Time of the narrow phase against the number of triangles: the canonical tree, the compressed one, "
                    "and each half of the compression. Two noise spheres; medians and quartiles.",
                    "time per query (ms)", measured("detect_cpu_ms")));
    return c7b;
}

}  // namespace aabblab
