module;
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.figures;
import aabblab.statistics;

namespace aabblab {

namespace {

struct layout {
    const char* label;
    const char* tree;
};
constexpr layout layouts[] = {{"canonical", "canonical"},
                              {"leafless", "leafless:leaf_test=triangle_box"},
                              {"shared planes", "shared_planes"},
                              {"compressed", "compressed:leaf_test=triangle_box"}};

selection tree(const std::string& name) {
    return {{kind::tree, name}};
}

bool is_generated(const condition& c) {
    return mesh_of(c).starts_with("noise_sphere");
}

figure size_figure(const std::string& name, const std::string& caption, const std::string& y, const row_value& of,
                   const std::vector<const condition*>& generated) {
    figure f{name, caption, {"triangles", true, {}}, {y, true, {}}, {}, {}};
    for (const layout& one : layouts)
        f.lines.push_back(series_of(one.label, generated, "triangles", tree(one.tree), of));
    return f;
}

}  // namespace

bool is_primary_of_c7(const condition& c) {
    return mesh_of(c) == "noise_sphere:triangles=100000" || mesh_of(c) == "noise_sphere:triangles=30000";
}

claim_result compressed_tree(const measurements& m) {
    claim_result claim;
    claim.id = "C7";
    claim.claim = "Compressed storage takes less memory and less time";
    claim.measured = "compressed with the leaf's triangle tested against the box, over canonical";
    claim.experiments = {"figure2", "figure2_million"};
    std::vector<const condition*> all;
    std::vector<const condition*> generated;
    for (const char* experiment : {"figure2", "figure2_million"})
        for (const condition& c : m.of(experiment)) all.push_back(&c);
    std::ranges::copy_if(all, std::back_inserter(generated), [](const condition* c) { return is_generated(*c); });
    std::vector<candidate> candidates;
    for (const condition* c : all) {
        const auto add = [&](const char* what, const row_value& of, const std::string& leaf_test) {
            candidates.push_back(candidate_of(*c, tree("compressed:leaf_test=" + leaf_test), tree("canonical"), of,
                                              {{"quantity", what}, {"leaf_test", leaf_test}}));
        };
        add("time", measured("detect_ms"), "triangle_box");
        candidates.back().primary = is_primary_of_c7(*c);
        add("time", measured("detect_ms"), "triangle_aabb");
        add("time", measured("detect_ms"), "none");
        add("bytes", measured("tree_bytes"), "triangle_box");
    }
    judge(claim, std::move(candidates));
    claim.figures = {
        size_figure("figure2",
                    "Time of local detection against the number of triangles: the canonical tree, the compressed one, "
                    "and the half-steps between. Two noise spheres; medians and quartiles.",
                    "time a query (ms)", measured("detect_ms"), generated),
        size_figure("figure2_bytes", "Bytes of the same trees for each triangle, as allocated.", "bytes a triangle",
                    measured("tree_bytes"), generated)};
    claim.figures.back().y.logarithmic = false;
    return claim;
}

}  // namespace aabblab
