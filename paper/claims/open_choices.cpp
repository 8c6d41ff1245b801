module aabblab.claims;

namespace aabblab {

namespace {

using alternative = open_choice::alternative;

/// A claim's ratio under each of several choices.
struct measured_choices {
    std::string where;                        ///< the condition of the measurements
    std::string ours;                         ///< the label of our choice
    std::vector<alternative> alternatives{};  ///< the measured ones

    void add(const std::string& label, const endpoint& measured) {
        if (measured.is_known()) alternatives.push_back({label, measured});
    }
    /// Adds claim C1a's ratio.
    void add_search(const std::string& label, const condition& c) {
        add(label, endpoint_of(c, improved, traditional, "frame_cpu_ms"));
    }
};

/// The two compositions whose ratio is measured under a choice.
struct tried_choice {
    std::string label;
    selection tested;
    selection baseline;
};

/// A claim's ratio of a metric in the condition, under each choice for an open question of the paper, ours first.
/// @param conditions at most one; without one, the result has no ratios
/// @param note is appended to the text of the condition
measured_choices ratios_in_condition(const std::vector<const condition*>& conditions, const std::string& metric,
                                     const std::string& note, const std::vector<tried_choice>& choices) {
    measured_choices measured{.where = "", .ours = choices.front().label};
    for (const condition* c : conditions) {
        measured.where = text_of(c->scene()) + note;
        for (const auto& [label, tested, baseline] : choices)
            measured.add(label, endpoint_of(*c, tested, baseline, metric));
    }
    return measured;
}

/// Claim C1a's ratio in the only condition of the experiment on choices.
measured_choices search_choices(const measurements& m, const std::vector<tried_choice>& choices) {
    return ratios_in_condition(matching(m.conditions_of("choices"), {}), "frame_cpu_ms", " (a separate run)", choices);
}

/// Query times of a tree over those of the canonical one, on the generated mesh of table 1.
measured_choices tree_choices(const measurements& m, const std::vector<tried_choice>& choices) {
    return ratios_in_condition(matching(m.conditions_of("table1"), {{"meshes", "noise_sphere:triangles=20000"}}),
                               "detect_cpu_ms", "", choices);
}

measured_choices displacement_choices(const measurements& m) {
    measured_choices measured{.where = "brownian, objects 10,000", .ours = "0.1"};
    for (const condition* c : matching(m.conditions_of("figure1"), {{"scene", "brownian"}, {"objects", "10000"}}))
        measured.add_search(value_of(c->scene(), "displacement"), *c);
    return measured;
}

/// Claim C1a's ratio in each scene in which boxes move by 0.1 of their extent per frame, as alternatives to our choice,
/// the drifting cubes of the scene `brownian`. Of the sizes of that scene, the nearest to theirs is compared.
measured_choices scene_choices(const measurements& m) {
    measured_choices measured{.where = "displacement 0.1 of the extent", .ours = ""};
    std::vector<const condition*> scenes =
        matching(m.conditions_of("figure1"), {{"displacement", "0.1"}, {"unit", "extent"}});
    if (scenes.empty()) return measured;
    const double objects = objects_of(*scenes.front());
    const std::vector<const condition*> drifts =
        matching(m.conditions_of("figure1"), {{"scene", "brownian"}, {"displacement", "0.1"}});
    const auto nearest = std::ranges::min_element(
        drifts, {}, [&](const condition* c) { return std::abs(std::log(objects_of(*c) / objects)); });
    const auto label_of = [](const condition& c) {
        return value_of(c.scene(), "scene") + " of " + number_text(value_of(c.scene(), "objects"));
    };
    if (nearest != drifts.end()) {
        scenes.insert(scenes.begin(), *nearest);
        measured.ours = label_of(**nearest);
    }
    for (const condition* c : scenes) measured.add_search(label_of(*c), *c);
    return measured;
}

measured_choices leaf_test_choices(const measurements& m) {
    std::vector<tried_choice> tests;
    for (const std::string test : {"triangle_box", "triangle_aabb", "none"})
        tests.push_back({test, {{kind::tree, "compressed:leaf_test=" + test}}, {{kind::tree, "canonical"}}});
    return ratios_in_condition(matching(m.conditions_of("figure2"), large_spheres), "detect_cpu_ms", "", tests);
}

/// The growth of Shell sort's work per element when N grows tenfold, for fixed and for growing numbers of gaps.
measured_choices gap_count_choices(const measurements& m) {
    measured_choices measured{.where = "line, displacement 0.1", .ours = "enough for N"};
    for (endpoint e : c2_claim(m).endpoints) {
        e.expected = expectation::not_more;
        const std::string sort = value_of(e.where, "sort");
        if (value_of(e.where, "displacement") != "0.1" || sort == "insertion") continue;
        measured.add(sort == "shell:gaps=ciura"         ? "enough for N"
                     : sort == "shell:gaps=ciura_eight" ? "Ciura's eight"
                     : sort == "shell:gaps=four_one"    ? "two: 4 and 1"
                                                        : sort,
                     e);
    }
    return measured;
}

/// Claim C11's ratio in each of its scenes: the paper's "different models" may mean any of them.
measured_choices model_choices(const measurements& m) {
    measured_choices measured{.where = "displacement 0.05", .ours = ""};
    for (const condition& c : m.conditions_of("c11")) {
        const std::string label = number_text(value_of(c.scene(), "objects")) + " of " + mesh_of(c) + ", density " +
                                  value_of(c.scene(), "density");
        if (matches(c.scene(), large_crowd)) measured.ours = label;
        measured.add(label, endpoint_of(c, improved.with(kind::tree, compressed),
                                        traditional.with(kind::tree, "canonical"), "frame_cpu_ms"));
    }
    return measured;
}

/// Claim C1a's ratio with and without the time of the first frame. Our choice is without.
measured_choices first_frame_choices(const measurements& m) {
    measured_choices measured{.where = "", .ours = "without the first frame"};
    for (const condition* c : matching(m.conditions_of("figure1"), drifting)) {
        measured.where = text_of(c->scene());
        measured.add_search("without the first frame", *c);
        measured.add("with the first frame", endpoint_of(*c, improved, traditional, "whole_cpu_ms"));
    }
    return measured;
}

/// Judges the alternatives to one of our choices: ours comes first and is decided alone, the others together, like the
/// ratios of a claim. Without ours, there are no alternatives, since nothing can be compared.
/// @param ours our choice in words; `measured.ours` is its label
open_choice judge(const std::string& question, const std::string& ours, const std::string& why,
                  const std::string& claim, measured_choices measured) {
    open_choice result{question, ours, why, claim, measured.where, /*alternatives=*/{}};
    std::ranges::stable_partition(measured.alternatives,
                                  [&](const alternative& a) { return a.label == measured.ours; });
    if (measured.alternatives.empty() || measured.alternatives.front().label != measured.ours) return result;
    std::vector<tested> others;
    for (const alternative& a : measured.alternatives) {
        // Without an expectation, a ratio below 1 counts as favourable, as in `decided_alone`.
        if (!result.alternatives.empty())
            others.push_back({a.measured.expected.value_or(expectation::less), tails_of(a.measured.log_ratio())});
        result.alternatives.push_back({a.label, decided_alone(a.measured)});
    }
    const std::vector<double> levels = levels_together(others);
    for (std::size_t i = 0; i < levels.size(); ++i)
        result.alternatives[i + 1].measured.corrected = support_of(others[i].expected, others[i].p, levels[i]);
    return result;
}

}  // namespace

/// The questions that the paper leaves open, our choices with reasons, and a claim's ratio under the alternatives.
std::vector<open_choice> open_choices(const measurements& m) {
    const auto shell = [](const std::string& gaps, const std::string& cut = "axial_cut:axes=2") {
        return improved.with(kind::sort, "shell:gaps=" + gaps).with(kind::partition, cut);
    };
    const selection shell_cut = shell("ciura");
    const auto tree = [](const std::string& layout, const std::string& build) {
        return selection{{kind::tree, layout + ":leaf_test=triangle_box"}, {kind::build, build}};
    };
    const auto canonical = [](const std::string& build) {
        return selection{{kind::tree, "canonical"}, {kind::build, build}};
    };
    return {
        judge(
            "Which axes are sorted and swept?", "one_axis: the axis on which centres vary most, the other two tested",
            "three sorted lists (all_axes) report a pair that overlaps on each; one list finds the same pairs with "
            "less memory, and both compositions use it",
            "C1a",
            search_choices(
                m,
                {{"best axis", shell_cut, traditional},
                 {"x", improved.with(kind::sweep, "one_axis:axis=x"), traditional.with(kind::sweep, "one_axis:axis=x")},
                 {"all axes", improved.with(kind::sweep, "all_axes"), traditional.with(kind::sweep, "all_axes")}})),
        judge("How many axes are cut?", "two: those on which centres vary most, the swept one last",
              "\"each axis is cut\" allows three; the swept axis needs no cut", "C1a",
              search_choices(m, {{"2", shell_cut, traditional},
                                 {"1", shell("ciura", "axial_cut:axes=1"), traditional},
                                 {"3", shell("ciura", "axial_cut:axes=3"), traditional}})),
        judge("How many segments?", "auto: the cheapest number by a cost model of uniformly distributed boxes",
              "the paper gives a limit and no number; claim C4a has the whole curve", "C1a",
              search_choices(m, {{"auto", shell_cut, traditional},
                                 {"8", shell("ciura", "axial_cut:axes=2,segments=8"), traditional}})),
        judge("How are Shell sort's gaps chosen?", "Ciura's sequence",
              "the best known by experiment; the paper names none", "C1a",
              search_choices(m, {{"Ciura", shell_cut, traditional},
                                 {"Tokuda", shell("tokuda"), traditional},
                                 {"Shell", shell("shell"), traditional}})),
        judge("How many gaps?", "enough for N: Ciura's eight, then each 2.25 times the previous one",
              "the paper gives no number; with a fixed one the work per element stays constant, and O(N) holds", "C2",
              gap_count_choices(m)),
        judge("How far do objects move per frame?", "up to a tenth of an edge", "\"only slightly from last time step\"",
              "C1a", displacement_choices(m)),
        judge("How are objects distributed?", "drifting cubes, a tenth of the volume filled",
              "the scene of Broadmark, on which other systems are compared", "C1a", scene_choices(m)),
        judge("Does the first frame count?", "no: it is sorted by std::sort and timed separately",
              "its list is not almost sorted, so insertion sort would be quadratic", "C1a", first_frame_choices(m)),
        judge("What replaces the box of a leaf?",
              "the triangle is tested against the other box (Möller's test with a margin that keeps it exact)",
              "\"we can directly adopt triangle to test\"; its box on the fly, or no test, are other readings", "C7b",
              leaf_test_choices(m)),
        judge("What do twelve bytes of scope values describe?", "six planes for two siblings, without loss",
              "three planes per node cannot represent every box: the literal reading has larger boxes", "C7b",
              tree_choices(m, {{"without loss", tree("compressed", "median"), canonical("median")},
                               {"literally", tree("compressed_literal", "median"), canonical("median")}})),
        judge("Where is a node split \"in term of centroids\"?", "at their median, along the longest axis",
              "the tree is to be balanced", "C7b",
              tree_choices(m, {{"median", tree("compressed", "median"), canonical("median")},
                               {"mean", tree("compressed", "mean"), canonical("mean")},
                               {"sah", tree("compressed", "sah"), canonical("sah")}})),
        judge(
            "What are \"different models\"?",
            "scanned animals in a crowd, many small generated ones, and simple ones far apart",
            "the paper names none; the narrow phase takes nearly all of the time in the first two, and the broad phase "
            "takes most of it in the last",
            "C11", model_choices(m)),
    };
}

}  // namespace aabblab
