module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.statistics;

namespace aabblab {

namespace {

struct alternative {
    std::string label;
    candidate measured;

    [[nodiscard]] expectation expected() const { return measured.expected.value_or(expectation::less); }
};
using alternatives = std::vector<alternative>;

void add(alternatives& to, const std::string& label, const candidate& measured) {
    if (measured.known()) to.push_back({label, measured});
}

/// The ratios of a claim under several choices, and where they were measured.
struct measured_choices {
    std::string where;
    alternatives all;
    std::string ours;  ///< the label of what we chose
};

/// Claim C1 in the one condition of the experiment on choices: time of Shell sort with a cut over insertion sort
/// without.
measured_choices of_search(const measurements& m,
                           const std::vector<std::pair<std::string, std::pair<selection, selection>>>& named) {
    measured_choices found{"", {}, named.front().first};
    for (const condition& c : m.of("choices")) {
        found.where = text_of(c.of()) + " (a run of its own)";
        for (const auto& [label, arms] : named)
            add(found.all, label, candidate_of(c, arms.first, arms.second, "frame_cpu_ms"));
    }
    return found;
}

selection search(const std::string& sort, const std::string& partition, const std::string& sweep = "one_axis") {
    return {{kind::sort, sort}, {kind::partition, partition}, {kind::sweep, sweep}};
}

measured_choices over_displacements(const measurements& m) {
    measured_choices found{"brownian, objects 10,000", {}, "0.1"};
    for (const condition& c : m.of("figure1"))
        if (is_brownian(c) && value_of(c.of(), "objects") == "10000")
            add(found.all, value_of(c.of(), "displacement"), candidate_of(c, improved, traditional, "frame_cpu_ms"));
    return found;
}

/// Other scenes of that displacement beside the drifting one that is nearest to them in size.
measured_choices over_scenes(const measurements& m) {
    measured_choices found{"displacement 0.1 of the extent", {}, ""};
    const auto is_slow = [](const condition& c) { return value_of(c.of(), "displacement") == "0.1"; };
    std::vector<const condition*> others;
    for (const condition& c : m.of("figure1"))
        if (is_slow(c) && value_of(c.of(), "unit") == "extent") others.push_back(&c);
    if (others.empty()) return found;
    const double objects = number_of(others.front()->of(), "objects");
    const condition* drifting = nullptr;
    const auto distance = [&](const condition& c) {
        return std::abs(std::log(number_of(c.of(), "objects") / objects));
    };
    for (const condition& c : m.of("figure1"))
        if (is_slow(c) && is_brownian(c) && (drifting == nullptr || distance(c) < distance(*drifting))) drifting = &c;
    const auto label_of = [](const condition& c) {
        return value_of(c.of(), "scene") + " of " + value_of(c.of(), "objects");
    };
    if (drifting != nullptr) {
        others.insert(others.begin(), drifting);
        found.ours = label_of(*drifting);
    }
    for (const condition* c : others)
        add(found.all, label_of(*c), candidate_of(*c, improved, traditional, "frame_cpu_ms"));
    return found;
}

measured_choices over_leaf_tests(const measurements& m) {
    measured_choices found{"", {}, "triangle_box"};
    for (const condition& c : m.of("figure2")) {
        if (!is_primary_of_c7(c)) continue;
        found.where = text_of(c.of());
        for (const char* test : {"triangle_box", "triangle_aabb", "none"})
            add(found.all, test,
                candidate_of(c, {{kind::tree, std::string("compressed:leaf_test=") + test}},
                             {{kind::tree, "canonical"}}, "detect_cpu_ms"));
    }
    return found;
}

/// Query times of a tree over those of the canonical one, on the generated mesh of table 1.
measured_choices over_trees(const measurements& m,
                            const std::vector<std::pair<std::string, std::pair<selection, selection>>>& named) {
    measured_choices found{"", {}, named.front().first};
    for (const condition& c : m.of("table1")) {
        if (mesh_of(c) != "noise_sphere:triangles=20000") continue;
        found.where = text_of(c.of());
        for (const auto& [label, trees] : named)
            add(found.all, label, candidate_of(c, trees.first, trees.second, "detect_cpu_ms"));
    }
    return found;
}

/// Growth of work an element, as claim C2 has it.
measured_choices over_numbers_of_gaps(const measurements& m) {
    measured_choices found{"line, displacement 0.1", {}, "as many as N asks for"};
    for (candidate c : linear_sort(m).candidates) {
        c.expected = expectation::not_more;
        const std::string sort = value_of(c.where, "sort");
        if (value_of(c.where, "displacement") != "0.1" || sort == "insertion") continue;
        add(found.all,
            sort == "shell:gaps=ciura"         ? "as many as N asks for"
            : sort == "shell:gaps=ciura_eight" ? "Ciura's eight"
            : sort == "shell:gaps=four_one"    ? "two: 4 and 1"
                                               : sort,
            c);
    }
    return found;
}

measured_choices over_models(const measurements& m) {
    const selection arm = improved.with(kind::tree, "compressed:leaf_test=triangle_box");
    const selection base = traditional.with(kind::tree, "canonical");
    measured_choices found{"displacement 0.05", {}, ""};
    for (const condition& c : m.of("c11")) {
        const std::string label =
            value_of(c.of(), "objects") + " of " + mesh_of(c) + ", density " + value_of(c.of(), "density");
        if (is_primary_of_c11(c)) found.ours = label;
        add(found.all, label, candidate_of(c, arm, base, "frame_cpu_ms"));
    }
    return found;
}

measured_choices with_first_frame(const measurements& m) {
    measured_choices found{"", {}, "without it"};
    for (const condition& c : m.of("figure1"))
        if (is_drifting(c)) {
            found.where = text_of(c.of());
            add(found.all, "without it", candidate_of(c, improved, traditional, "frame_cpu_ms"));
            add(found.all, "with it", candidate_of(c, improved, traditional, "whole_cpu_ms"));
        }
    return found;
}

/// Ours stands first and is decided by itself, the others together, as the endpoints of a claim are. Where ours was not
/// measured, there is nothing to hold the others against.
open_choice choice(const std::string& question, const std::string& ours, const std::string& why,
                   const std::string& claim, measured_choices measured) {
    open_choice made{question, ours, why, claim, measured.where, {}};
    std::ranges::stable_partition(measured.all, [&](const alternative& a) { return a.label == measured.ours; });
    if (measured.all.empty() || measured.all.front().label != measured.ours) return made;
    std::vector<tested> others;
    for (const alternative& a : measured.all) {
        if (!made.alternatives.empty()) others.push_back({a.expected(), tails_of(a.measured.log_ratio())});
        made.alternatives.push_back({a.label, endpoint_of(a.measured, a.expected())});
    }
    const std::vector<double> levels = levels_together(others);
    for (std::size_t i = 0; i < levels.size(); ++i)
        made.alternatives[i + 1].measured.found = support_of(others[i].expected, others[i].p, levels[i]);
    return made;
}

}  // namespace

std::vector<open_choice> open_choices(const measurements& m) {
    const selection shell_cut = search("shell:gaps=ciura", "axial_cut:axes=2");
    const selection plain = search("insertion", "none");
    const auto tree = [](const std::string& layout, const std::string& build) {
        return selection{{kind::tree, layout + ":leaf_test=triangle_box"}, {kind::build, build}};
    };
    const auto canonical = [](const std::string& build) {
        return selection{{kind::tree, "canonical"}, {kind::build, build}};
    };
    return {
        choice("Which axes are sorted and swept?",
               "one_axis: the axis on which centres vary most, the other two tested",
               "three sorted lists (all_axes) report a pair that overlaps on each; one list does the same with less "
               "memory, and both arms have it alike",
               "C1",
               of_search(
                   m, {{"best axis", {shell_cut, plain}},
                       {"x",
                        {search("shell", "axial_cut:axes=2", "one_axis:axis=x"),
                         search("insertion", "none", "one_axis:axis=x")}},
                       {"all axes",
                        {search("shell", "axial_cut:axes=2", "all_axes"), search("insertion", "none", "all_axes")}}})),
        choice("How many axes are cut?", "two: those on which centres vary most, the swept one last",
               "\"each axis is cut\" allows three; the swept axis needs no cut", "C1",
               of_search(m, {{"2", {shell_cut, plain}},
                             {"1", {search("shell:gaps=ciura", "axial_cut:axes=1"), plain}},
                             {"3", {search("shell:gaps=ciura", "axial_cut:axes=3"), plain}}})),
        choice("How many segments?", "auto: what a model of evenly spread boxes finds cheapest",
               "the paper names a limit and no number; claim C4 has the whole curve", "C1",
               of_search(m, {{"auto", {shell_cut, plain}},
                             {"8", {search("shell:gaps=ciura", "axial_cut:axes=2,segments=8"), plain}}})),
        choice("How are Shell sort's gaps chosen?", "Ciura's sequence",
               "the best known by experiment; the paper names none", "C1",
               of_search(m, {{"Ciura", {shell_cut, plain}},
                             {"Tokuda", {search("shell:gaps=tokuda", "axial_cut:axes=2"), plain}},
                             {"Shell", {search("shell:gaps=shell", "axial_cut:axes=2"), plain}}})),
        choice("How many gaps?", "as many as N asks for: Ciura's eight, then each 2.25 times the one before",
               "the paper says no number; with a fixed one the work an element stays level, and O(N) is true", "C2",
               over_numbers_of_gaps(m)),
        choice("How far do objects move in a frame?", "up to a tenth of an edge",
               "\"only slightly from last time step\"", "C1", over_displacements(m)),
        choice("How do objects lie?", "drifting cubes, a tenth of the volume filled",
               "the scene of Broadmark, which other systems are compared on", "C1", over_scenes(m)),
        choice("Does the first frame count?", "no: it is sorted by std::sort and timed apart",
               "nothing is almost sorted in it, and insertion sort would be quadratic", "C1", with_first_frame(m)),
        choice("What stands in for a leaf's box?",
               "the triangle is tested against the other box (Möller's test with a margin that keeps it exact)",
               "\"we can directly adopt triangle to test\"; its box made on the fly, or nothing, are other readings",
               "C7b", over_leaf_tests(m)),
        choice("Twelve bytes of scope values: for whom?", "six planes for two siblings, without loss",
               "three planes a node cannot hold every box: larger boxes are the literal reading", "C7b",
               over_trees(m, {{"without loss", {tree("compressed", "median"), canonical("median")}},
                              {"to the letter", {tree("compressed_literal", "median"), canonical("median")}}})),
        choice("Where is a node split \"in term of centroids\"?", "at their median, along the longest axis",
               "the tree is to be balanced", "C7b",
               over_trees(m, {{"median", {tree("compressed", "median"), canonical("median")}},
                              {"mean", {tree("compressed", "mean"), canonical("mean")}},
                              {"sah", {tree("compressed", "sah"), canonical("sah")}}})),
        choice("What are \"different models\"?",
               "scanned animals in a crowd, many small generated ones, and simple ones far apart",
               "the paper names none; in the first two nearly all of the time is local detection's, in the last two "
               "thirds and more are global search's",
               "C11", over_models(m)),
    };
}

}  // namespace aabblab
