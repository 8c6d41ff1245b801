module;
#include <functional>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import :measurements;
import aabblab.statistics;

namespace aabblab {

namespace {

using alternatives = std::vector<open_choice::alternative>;

void add(alternatives& to, const std::string& label, const candidate& measured,
         expectation expected = expectation::less) {
    if (!measured.log_ratio.draws.empty()) to.push_back({label, endpoint_of(measured, expected)});
}

/// Claim C1 in the one condition of the experiment on choices: time of Shell sort with a cut over insertion sort
/// without.
alternatives of_search(const measurements& m,
                       const std::vector<std::pair<std::string, std::pair<selection, selection>>>& named) {
    alternatives all;
    for (const condition& c : m.of("choices"))
        for (const auto& [label, arms] : named) add(all, label, candidate_of(c, arms.first, arms.second, frame_ms()));
    return all;
}

selection search(const std::string& sort, const std::string& partition, const std::string& sweep = "one_axis") {
    return {sort, partition, sweep, "", ""};
}

/// The improved search against the traditional one over the scenes of figure 1 that are named.
alternatives over_scenes(const measurements& m, const std::function<std::string(const condition&)>& label_of) {
    alternatives all;
    for (const condition& c : m.of("figure1"))
        if (const std::string label = label_of(c); !label.empty())
            add(all, label, candidate_of(c, improved, traditional, frame_ms()));
    return all;
}

alternatives over_leaf_tests(const measurements& m) {
    alternatives all;
    for (const condition& c : m.of("figure2")) {
        if (!mesh_of(c).starts_with("noise_sphere")) continue;
        all.clear();
        for (const char* test : {"triangle_box", "triangle_aabb", "none"})
            add(all, test,
                candidate_of(c, {"", "", "", "", std::string("compressed:leaf_test=") + test},
                             {"", "", "", "", "canonical"}, detect_ms()));
    }
    return all;
}

alternatives over_trees(const measurements& m, const std::vector<std::pair<std::string, std::string>>& named,
                        const std::string& base_build) {
    alternatives all;
    for (const condition& c : m.of("table1")) {
        if (&c != m.of("table1").data()) break;
        for (const auto& [label, tree] : named)
            add(all, label,
                candidate_of(c, {"", "", "", "", tree},
                             {"", "", "", "", "canonical:build=" + (base_build.empty() ? label : base_build)},
                             detect_ms()));
    }
    return all;
}

alternatives over_models(const measurements& m) {
    selection arm = improved;
    arm.tree = "compressed:leaf_test=triangle_box";
    selection base = traditional;
    base.tree = "canonical";
    alternatives all;
    for (const condition& c : m.of("c11"))
        add(all, value_of(c.of(), "objects") + " × " + mesh_of(c), candidate_of(c, arm, base, frame_ms()));
    return all;
}

alternatives with_first_frame(const measurements& m) {
    alternatives all;
    for (const condition& c : m.of("figure1"))
        if (value_of(c.of(), "scene") == "brownian" && value_of(c.of(), "objects") == "10000" &&
            value_of(c.of(), "displacement") == "0.1") {
            add(all, "without it", candidate_of(c, improved, traditional, frame_ms()));
            add(all, "with it", candidate_of(c, improved, traditional, whole_ms()));
        }
    return all;
}

}  // namespace

std::vector<open_choice> open_choices(const measurements& m) {
    const selection shell_cut = search("shell:gaps=ciura", "axial_cut:axes=2");
    const selection plain = search("insertion", "none");
    const std::string displacement = "displacement";
    const auto is_drifting = [](const condition& c) {
        return value_of(c.of(), "scene") == "brownian" && value_of(c.of(), "objects") == "10000";
    };
    const auto tree = [](const std::string& layout, const std::string& build) {
        return layout + ":build=" + build + ",leaf_test=triangle_box";
    };
    return {
        {"Which axes are sorted and swept?", "one_axis: the axis on which centres vary most, the other two tested",
         "three sorted lists (all_axes) report a pair that overlaps on each; one list does the same with less memory, "
         "and both arms have it alike",
         "C1",
         of_search(
             m,
             {{"best axis", {shell_cut, plain}},
              {"x", {search("shell", "axial_cut", "one_axis:axis=x"), search("insertion", "none", "one_axis:axis=x")}},
              {"all axes", {search("shell", "axial_cut", "all_axes"), search("insertion", "none", "all_axes")}}})},
        {"How many axes are cut?", "two: those on which centres vary most, the swept one last",
         "\"each axis is cut\" allows three; the swept axis needs no cut", "C1",
         of_search(m, {{"2", {shell_cut, plain}},
                       {"1", {search("shell:gaps=ciura", "axial_cut:axes=1"), plain}},
                       {"3", {search("shell:gaps=ciura", "axial_cut:axes=3"), plain}}})},
        {"How many segments?", "auto: what a model of evenly spread boxes finds cheapest",
         "the paper names a limit and no number; claim C4 has the whole curve", "C1",
         of_search(m,
                   {{"auto", {shell_cut, plain}}, {"8", {search("shell:gaps=ciura", "axial_cut:segments=8"), plain}}})},
        {"How are Shell sort's gaps chosen?", "Ciura's sequence", "the best known by experiment; the paper names none",
         "C1",
         of_search(m, {{"Ciura", {shell_cut, plain}},
                       {"Tokuda", {search("shell:gaps=tokuda", "axial_cut:axes=2"), plain}},
                       {"Shell", {search("shell:gaps=shell", "axial_cut:axes=2"), plain}}})},
        {"How far do objects move in a frame?", "up to a tenth of an edge", "\"only slightly from last time step\"",
         "C1",
         over_scenes(m, [&](const condition& c) { return is_drifting(c) ? value_of(c.of(), displacement) : ""; })},
        {"How do objects lie?", "drifting cubes, a tenth of the volume filled", "the scene that most comparisons use",
         "C1",
         over_scenes(m,
                     [&](const condition& c) {
                         if (is_drifting(c) && value_of(c.of(), displacement) == "0.1") return std::string("brownian");
                         const bool other =
                             value_of(c.of(), "unit") == "extent" || value_of(c.of(), displacement).empty();
                         return other ? value_of(c.of(), "scene") : std::string();
                     })},
        {"Does the first frame count?", "no: it is sorted by std::sort and timed apart",
         "nothing is almost sorted in it, and insertion sort would be quadratic", "C1", with_first_frame(m)},
        {"What stands in for a leaf's box?",
         "the triangle is tested against the other box (Möller's test with a margin that keeps it exact)",
         "\"we can directly adopt triangle to test\"; its box made on the fly, or nothing, are other readings", "C7",
         over_leaf_tests(m)},
        {"Twelve bytes of scope values: for whom?", "six planes for two siblings, without loss",
         "three planes a node cannot hold every box: larger boxes are the literal reading", "C7",
         over_trees(
             m,
             {{"without loss", tree("compressed", "median")}, {"to the letter", tree("compressed_literal", "median")}},
             "median")},
        {"Where is a node split \"in term of centroids\"?", "at their median, along the longest axis",
         "the tree is to be balanced", "C7",
         over_trees(m,
                    {{"median", tree("compressed", "median")},
                     {"mean", tree("compressed", "mean")},
                     {"sah", tree("compressed", "sah")}},
                    "")},
        {"What are \"different models\"?", "scanned animals in a crowd, and many small generated ones",
         "the paper names none; the stages share the time otherwise with every number and size of models", "C11",
         over_models(m)},
    };
}

}  // namespace aabblab
