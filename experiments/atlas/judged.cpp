module aabblab.atlas;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

using scene_filter = std::function<bool(const atlas_scene&)>;

/// A ratio of times over a set of scenes: of a candidate, expected to be the faster one, to another, its baseline.
struct stated_ratio {
    std::string where, candidate, baseline;
    scene_filter scenes;
    /// A divisor of the ratio, if set: the same ratio in these scenes, for statements of what a candidate suffers from.
    scene_filter reference_scenes = nullptr;
    expectation expected = expectation::less;
    double band = equivalence_band;  // of no difference: 0.05 for 1/1.05 to 1.05, 1 for 1/2 to 2
};

struct statement {
    std::string id, source, says;
    std::vector<stated_ratio> ratios;
};

// The labels of the compositions and engines.
const std::string columns = "bucket + columns + simd";  // also for box pruning: both sort and sweep anew per frame
const std::string verlet_list = "neighbour_list:margin=0.1 + bucket + columns + simd";
const std::string incremental = "insertion + incremental";
const std::string subdivided = "insertion + subdivided";
const std::string one_axis = "insertion + one_axis";
const std::string simd_sweep = "insertion + simd";
const std::string two_axis = "insertion + two_axis";
const std::string uniform_grid = "std + uniform_grid + simd";
const std::string kd_tree = "radix + kd_tree + simd";
const std::string hierarchical_grid = "ode_hash";
const std::string dynamic_tree = "bullet_dbvt";
const std::string bullet_sap = "bullet_sap";

/// Matches the scenes of the map with these values of parameters. All boxes move, unless a value says otherwise.
scene_filter map_with(std::map<std::string_view, double> values) {
    values.try_emplace("moving", 1);
    return [values = std::move(values)](const atlas_scene& s) {
        return s.scene.kind == "cloud" &&
               std::ranges::all_of(values, [&](const auto& v) { return s.number(v.first) == v.second; });
    };
}

/// Matches the scenes of the map in which all boxes move by this displacement per frame.
scene_filter moved(double objects, double displacement) {
    return map_with({{"objects", objects}, {"displacement", displacement}});
}

scene_filter boxes(double objects) {
    return map_with({{"objects", objects}});
}

scene_filter sizes_to(double ratio, double objects) {
    return map_with({{"objects", objects}, {"ratio", ratio}});
}

/// Matches the scenes of the map in which only a share of the boxes moves.
scene_filter partly_moving(double objects, double moving) {
    return map_with({{"objects", objects}, {"moving", moving}});
}

scene_filter kind_is(std::string kind) {
    return [kind = std::move(kind)](const atlas_scene& s) { return s.scene.kind == kind; };
}

/// The ratio of a candidate to a baseline for each pair of number of boxes and displacement.
std::vector<stated_ratio> by_motion(const std::string& candidate, const std::string& baseline,
                                    std::initializer_list<std::pair<double, double>> cases) {
    std::vector<stated_ratio> ratios;
    for (const auto& [objects, displacement] : cases)
        ratios.push_back({fmt::format("{} boxes, by {:g}", grouped(static_cast<std::uint64_t>(objects)), displacement),
                          candidate, baseline, moved(objects, displacement)});
    return ratios;
}

/// The ratio of a candidate to a baseline for each number of boxes.
std::vector<stated_ratio> by_count(const std::string& candidate, const std::string& baseline,
                                   std::initializer_list<double> sizes, expectation expected = expectation::less,
                                   double band = equivalence_band) {
    std::vector<stated_ratio> ratios;
    for (const double objects : sizes)
        ratios.push_back({grouped(static_cast<std::uint64_t>(objects)) + " boxes", candidate, baseline, boxes(objects),
                          /*reference_scenes=*/nullptr, expected, band});
    return ratios;
}

/// Published statements on broad phases, each with its source and the ratios of times that decide it. A ratio is that
/// of the candidate expected to be faster over another, in the scenes of a filter, such as `moved(objects,
/// displacement)`. With two filters, the ratio in the first scenes is divided by that in the second.
const std::vector<statement>& statements() {
    static const std::vector<statement> published{
        {"B1",
         "Bullet's manual and wiki, \"Broadphase\"",
         "Sweep and prune is fastest if most objects rest, the dynamic tree if many move.",
         {{"10,000 boxes, a hundredth move", bullet_sap, dynamic_tree, partly_moving(10000, 0.01)},
          {"10,000 boxes, a tenth moves", bullet_sap, dynamic_tree, partly_moving(10000, 0.1)},
          {"1,000 boxes, all move by 1", dynamic_tree, bullet_sap, moved(1000, 1)},
          {"10,000 boxes, all move by 1", dynamic_tree, bullet_sap, moved(10000, 1)}}},
        {"B2",
         "P. Terdiman, PhysX issue 96, and PhysX's manual, PxBroadPhaseType",
         "If everything is at rest, nothing beats incremental sweep and prune; if everything moves, box pruning is "
         "much faster.",
         {{"1,000 boxes at rest", incremental, columns, partly_moving(1000, 0)},
          {"10,000 boxes at rest", incremental, columns, partly_moving(10000, 0)},
          {"10,000 boxes at rest", incremental, verlet_list, partly_moving(10000, 0)},
          {"1,000 boxes, all move by 1", columns, incremental, moved(1000, 1)},
          {"10,000 boxes, all move by 1", columns, incremental, moved(10000, 1)}}},
        {"B3", "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract",
         "Subdivided sweep and prune is faster than earlier sweep and prune.",
         by_motion(subdivided, incremental,
                   {{1000, 0.001}, {10000, 0.001}, {1000, 0.1}, {10000, 0.1}, {1000, 1}, {10000, 1}})},
        {"B4",
         "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract (of octrees)",
         "With coherence, subdivided sweep and prune beats hierarchies.",
         {{"1,000 boxes, by 0.01", subdivided, dynamic_tree, moved(1000, 0.01)},
          {"10,000 boxes, by 0.01", subdivided, dynamic_tree, moved(10000, 0.01)},
          {"10,000 boxes, by 0.01", subdivided, "embree_refit", moved(10000, 0.01)},
          {"10,000 boxes, a hundredth moves", subdivided, dynamic_tree, partly_moving(10000, 0.01)}}},
        {"B5",
         "C. Ericson, Real-Time Collision Detection, 7.1 and 7.2",
         "A uniform grid suits boxes of similar size but not boxes of very different sizes, which a hierarchy of "
         "grids suits.",
         {{"10,000 boxes of one size", uniform_grid, hierarchical_grid, sizes_to(1, 10000)},
          {"10,000 boxes, sizes 1 to 100", hierarchical_grid, uniform_grid, sizes_to(100, 10000)},
          {"the lead of the hierarchy, sizes 1 to 100 over one size", hierarchical_grid, uniform_grid,
           sizes_to(100, 10000), sizes_to(1, 10000)}}},
        {"B6",
         "C. Ericson, Real-Time Collision Detection, 7.5; the manual of BEPUphysics",
         "Sweep and prune suffers from clustered boxes; a hierarchy does not.",
         {{"1,000 boxes, 20 clouds over one", dynamic_tree, one_axis, map_with({{"objects", 1000}, {"clouds", 20}}),
           map_with({{"objects", 1000}, {"clouds", 1}})},
          {"10,000 boxes, 20 clouds over one", dynamic_tree, one_axis, map_with({{"objects", 10000}, {"clouds", 20}}),
           map_with({{"objects", 10000}, {"clouds", 1}})}}},
        {"B7",
         "Benchmark of BEPUphysics 0.16, 2011",
         "A sweep along one axis is the fastest of all with 100 boxes; with many, a grid over two axes with a sweep "
         "along the third beats a dynamic hierarchy.",
         {{"100 boxes", simd_sweep, dynamic_tree, boxes(100)},
          {"100 boxes", simd_sweep, columns, boxes(100)},
          {"10,000 boxes", columns, dynamic_tree, boxes(10000)},
          {"30,000 boxes", columns, dynamic_tree, boxes(30000)}}},
        {"B8",
         "The manual of Nape; comments of Box2D 2.0, b2BroadPhase",
         "Sweep and prune is poor at fast motion and with many sizes; a dynamic tree suffers from neither.",
         {{"1,000 boxes, by 1 over by 0.001", dynamic_tree, incremental, moved(1000, 1), moved(1000, 0.001)},
          {"10,000 boxes, by 1 over by 0.001", dynamic_tree, incremental, moved(10000, 1), moved(10000, 0.001)},
          {"10,000 boxes, sizes 1 to 100 over one size", dynamic_tree, incremental, sizes_to(100, 10000),
           sizes_to(1, 10000)}}},
        {"B9", "F. Chitalu, C. Dubach, T. Komura, Computer Graphics Forum 2020, abstract (of a tree on a GPU)",
         "Rebuilding a hierarchy in every frame is faster than refitting it.",
         by_motion("embree", "embree_refit",
                   {{1000, 0.001}, {1000, 0.1}, {1000, 1}, {10000, 0.001}, {10000, 0.1}, {10000, 1}})},
        {"B10", "The manual of dyn4j",
         "A sweep along one axis and a dynamic tree take about the same time: the slower one, the tree, takes at "
         "most twice as long.",
         by_count(dynamic_tree, one_axis, {100, 1000, 10000}, expectation::not_more, /*band=*/1.0)},
        {"B11",
         "The manual of Unity, Physics, broadphase type",
         "In large flat worlds sweep and prune finds many false overlaps, and a grid over it helps.",
         {{"flat", columns, simd_sweep, kind_is("flat")},
          {"flat over cubic", columns, simd_sweep, kind_is("flat"), /*in a cube*/ kind_is("brownian")}}},
        {"B12",
         "Y. Serpa, M. Rodrigues, Computer Graphics Forum 38, 2019, title",
         "A kd-tree that exploits temporal coherence is fast and scales.",
         {{"10,000 boxes", kd_tree, simd_sweep, boxes(10000)},
          {"10,000 boxes", kd_tree, uniform_grid, boxes(10000)},
          {"10,000 boxes", kd_tree, dynamic_tree, boxes(10000)},
          {"its lead over a sweep, 10,000 boxes over 1,000", kd_tree, simd_sweep, boxes(10000), boxes(1000)}}},
        {"B13", "README of Broadmark (Y. Serpa, M. Rodrigues), \"Best variants\" (which are parallel, too)",
         "The best sweep is the vectorised one.", by_count(simd_sweep, one_axis, {100, 1000, 10000})},
        {"B14",
         "G. Capannini, T. Larsson, SCCG 2016 and IEEE TVCG 2018, titles (the latter on several threads)",
         "A sweep of two axes is efficient, also in massive scenes.",
         {{"1,000 boxes", two_axis, one_axis, boxes(1000)},
          {"30,000 boxes", two_axis, one_axis, boxes(30000)},
          {"30,000 boxes over 1,000", two_axis, one_axis, boxes(30000), boxes(1000)}}},
        {"B15",
         "G. Capannini, T. Larsson, SIGRAD 2016, abstract (of a variant for boxes of one size only)",
         "A sweep of two axes gains if all boxes have one size.",
         {{"1,000 boxes, one size over sizes 1 to 100", two_axis, one_axis, sizes_to(1, 1000), sizes_to(100, 1000)},
          {"10,000 boxes, one size over sizes 1 to 100", two_axis, one_axis, sizes_to(1, 10000),
           sizes_to(100, 10000)}}},
        {"B16",
         "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract",
         "Subdivided sweep and prune suits large environments in which few objects move at a time.",
         {{"10,000 boxes, a hundredth moves", subdivided, incremental, partly_moving(10000, 0.01)},
          {"10,000 boxes, a tenth moves", subdivided, incremental, partly_moving(10000, 0.1)},
          {"10,000 boxes, a hundredth moves", subdivided, one_axis, partly_moving(10000, 0.01)},
          {"its lead, 10,000 boxes over 1,000, a tenth moves", subdivided, incremental, partly_moving(10000, 0.1),
           partly_moving(1000, 0.1)}}},
        {"B17", "README of Broadmark (Y. Serpa, M. Rodrigues), \"Best variants\" (which are parallel, too)",
         "Among grids with a sweep in their cells, one over three axes is better than one over two.",
         by_count(uniform_grid, columns, {1000, 10000, 30000})}};
    return published;
}

struct measured_ratio {
    std::size_t scenes = 0;
    estimate log{std::nan(""), 0, 1};
};

/// The ratio of two candidates' times, a geometric mean over matching scenes, which count as independent.
measured_ratio ratio_in(const std::vector<atlas_scene>& atlas, const stated_ratio& r, const scene_filter& matches) {
    std::vector<estimate> logs;
    for (const atlas_scene& scene : atlas) {
        if (!matches(scene)) continue;
        const atlas_candidate* candidate = scene.find(r.candidate);
        const atlas_candidate* baseline = scene.find(r.baseline);
        if (!candidate || !baseline) continue;
        if (const estimate log = log_ratio_in(scene, *candidate, *baseline); log.is_known()) logs.push_back(log);
    }
    return logs.empty() ? measured_ratio() : measured_ratio{logs.size(), mean_of(logs)};
}

/// The ratio that a statement speaks of, divided by that in the reference scenes; of no scenes if one is unknown.
measured_ratio measure(const std::vector<atlas_scene>& atlas, const stated_ratio& r) {
    measured_ratio ratio = ratio_in(atlas, r, r.scenes);
    if (!r.reference_scenes || ratio.scenes == 0) return ratio;
    const measured_ratio reference = ratio_in(atlas, r, r.reference_scenes);
    if (reference.scenes == 0) return {};
    return {ratio.scenes + reference.scenes, difference_of(ratio.log, reference.log)};
}

}  // namespace

/// The verdicts on all statements: Holm's correction for multiple tests needs all ratios before any is decided.
std::vector<judged_statement> judged_statements(const std::vector<atlas_scene>& atlas) {
    std::vector<judged_statement> verdicts;
    std::vector<tested> evidence;
    for (const statement& s : statements()) {
        judged_statement& entry = verdicts.emplace_back(s.id, s.source, s.says);
        for (const stated_ratio& r : s.ratios) {
            const measured_ratio ratio = measure(atlas, r);
            if (ratio.scenes == 0 || !ratio.log.is_known()) continue;
            const interval range = ratio.log.range();
            entry.ratios.push_back({r.where, r.candidate + " over " + r.baseline, ratio.scenes,
                                    std::exp(ratio.log.value), interval{std::exp(range.low), std::exp(range.high)}});
            evidence.push_back({r.expected, tails_of(ratio.log, r.band)});
        }
    }
    const std::vector<double> levels = levels_together(evidence);
    std::size_t i = 0;  // over the ratios of all statements
    for (judged_statement& s : verdicts) {
        std::vector<support> endpoints;
        for (judged_ratio& r : s.ratios) {
            r.verdict = support_of(evidence[i].expected, evidence[i].p, levels[i]);
            endpoints.push_back(r.verdict);
            ++i;
        }
        s.verdict = verdict_of(endpoints);
    }
    return verdicts;
}

/// One row per published statement: its verdict and the ratios that decide it.
table statements_table(const std::vector<judged_statement>& judged) {
    table t = empty_table({"statement", "says", "source", "verdict", "ratios"});
    for (const judged_statement& s : judged) {
        std::string ratios;
        for (const judged_ratio& r : s.ratios) ratios += (ratios.empty() ? "" : ", ") + fmt::format("{:.3g}", r.ratio);
        t.rows.push_back({s.id, s.says, s.source, text_of(s.verdict), ratios});
    }
    return t;
}

/// One row per ratio on which the verdict on a statement depends.
table ratios_table(const std::vector<judged_statement>& judged) {
    table t = empty_table({"statement", "where", "time of a frame"}, {"scenes", "ratio", "95 %"}, {"found"});
    for (const judged_statement& s : judged)
        for (const judged_ratio& r : s.ratios)
            t.rows.push_back({s.id, r.where, r.candidates, grouped(r.scenes), fmt::format("{:.3g}", r.ratio),
                              fmt::format("{:.3g}-{:.3g}", r.range.low, r.range.high), text_of(r.verdict)});
    return t;
}

/// The labels of all candidates that the statements compare, each once: a test checks that the atlas times them.
std::vector<std::string> labels_in_statements() {
    std::vector<std::string> labels;
    for (const statement& s : statements())
        for (const stated_ratio& r : s.ratios)
            for (const std::string& label : {r.candidate, r.baseline})
                if (std::ranges::find(labels, label) == labels.end()) labels.push_back(label);
    return labels;
}

}  // namespace aabblab
