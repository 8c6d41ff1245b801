module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
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
    return mesh_of(c) == "noise_sphere:triangles=100000";
}

namespace {

std::vector<const condition*> all_sizes(const measurements& m) {
    std::vector<const condition*> all;
    for (const char* experiment : {"figure2", "figure2_million"})
        for (const condition& c : m.of(experiment)) all.push_back(&c);
    std::ranges::stable_sort(all, {}, &condition::triangles);
    return all;
}

std::vector<const condition*> generated_sizes(const measurements& m) {
    std::vector<const condition*> generated;
    std::ranges::copy_if(all_sizes(m), std::back_inserter(generated),
                         [](const condition* c) { return is_generated(*c); });
    return generated;
}

candidate compressed_over_canonical(const condition& c, const std::string& metric, const std::string& leaf_test) {
    return candidate_of(c, tree("compressed:leaf_test=" + leaf_test), tree("canonical"), metric,
                        {{"leaf_test", leaf_test}, {"triangles", std::to_string(std::llround(c.triangles()))}});
}

}  // namespace

draft less_memory(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C7a";
    claim.claim = "Compressed storage takes less memory";
    claim.measured = "bytes of the compressed tree over those of the canonical one";
    claim.experiments = {"figure2", "figure2_million"};
    for (const condition* c : all_sizes(m)) {
        made.candidates.push_back(
            told(compressed_over_canonical(*c, "tree_bytes", "triangle_box"), "", "", quantity::bytes));
        made.candidates.back().primary = is_primary_of_c7(*c);
    }
    claim.figures = {size_figure("figure2_bytes", "Bytes of trees for each triangle, as allocated.", "bytes a triangle",
                                 measured("tree_bytes"), generated_sizes(m))};
    claim.figures.back().y.logarithmic = false;
    return made;
}

draft less_time(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C7b";
    claim.claim = "Compressed storage takes less time";
    claim.measured = "time a query of the compressed tree over that of the canonical one";
    claim.experiments = {"figure2", "figure2_million"};
    const std::pair<const char*, const char*> leaf_tests[] = {
        {"triangle_box", ""},
        {"triangle_aabb", "where a box is made of the leaf's triangle on the fly"},
        {"none", "where the leaf's triangle goes straight to the triangle test"}};
    for (const auto& [leaf_test, subject] : leaf_tests)
        for (const condition* c : all_sizes(m)) {
            made.candidates.push_back(told(compressed_over_canonical(*c, "detect_cpu_ms", leaf_test), subject));
            made.candidates.back().primary = is_primary_of_c7(*c) && std::string(leaf_test) == "triangle_box";
        }
    claim.figures = {
        size_figure("figure2",
                    "Time of local detection against the number of triangles: the canonical tree, the compressed one, "
                    "and the half-steps between. Two noise spheres; medians and quartiles.",
                    "time a query (ms)", measured("detect_cpu_ms"), generated_sizes(m))};
    return made;
}

}  // namespace aabblab
